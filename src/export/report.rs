//! The result in words and numbers: `profile.json`, the JSON of `gnomon shadow` and `gnomon sun`, and the table of
//! `gnomon sun`.
//! Other programs rely on keys and their order: keys may be added, but never changed.

use super::patches::PatchContext;
use super::{ExportError, figure};
use crate::choice::{Filter, Finder, Receivers, Settings, SinglySearched, Subject};
use crate::message::{Message, Words};
use crate::profile::{Profile, Provenance, Statistics, Timings};
use crate::site::{Ground, GroundKind};
use crate::sun::{Air, Day, Instant, Place, Polar, SunTrack, Zone};
use crate::sunlight::Exposure;
use crate::view::{Grid, View};
use chrono::{DateTime, Offset, SecondsFormat};
use serde::Serialize;
use serde::ser::{SerializeMap, Serializer};
use std::fmt::Write;

#[derive(Serialize)]
pub(super) struct DrawnReport<'a> {
    gnomon: &'static str,
    place: PlaceReport<'a>,
    tz_version: String,
    #[serde(flatten)]
    view: ViewReport<'a>,
    receivers: &'static str,
    #[serde(flatten)]
    ground: GroundReport,
    technique: &'static str,
    silhouette: Option<&'static str>,
    engine: &'static str,
    adapter: Option<&'a str>,
    #[serde(flatten)]
    settings: SettingsReport,
    resolution_secs: u32,
    between_instants: Option<String>,
    refraction: bool,
    refraction_celsius: Option<f64>,
    refraction_millibar: Option<f64>,
    algorithm: &'static str,
    delta_t_secs: f64,
    delta_t_source: &'static str,
    instants: Vec<InstantReport>,
    days: Vec<DayReport>,
    notes: Vec<String>,
    #[serde(serialize_with = "in_order")]
    timings_secs: &'a Timings,
    #[serde(skip_serializing_if = "Option::is_none")]
    statistics: Option<StatisticsReport>,
}

/// The settings of the computation, named as the command's options.
#[derive(Serialize)]
pub(super) struct SettingsReport {
    map_size: Option<u32>,
    pcf: Option<&'static str>,
    smoothie_width: Option<f64>,
    sun_samples: Option<u32>,
}

#[derive(Serialize)]
pub(super) struct GroundReport {
    ground: f64,
    ground_from: &'static str,
    models_below_ground_m: f64,
}

#[derive(Serialize)]
struct StatisticsReport {
    cells: u64,
    silhouette_cells: Option<u64>,
    fragments: u64,
    fragments_without_mask: u64,
}

#[derive(Serialize)]
#[serde(untagged)]
enum ViewReport<'a> {
    Plan {
        region: [f64; 4],
        cell: f64,
        width: u32,
        height: u32,
    },
    Camera {
        camera: CameraReport,
        width: u32,
        height: u32,
    },
    Elevation {
        target: [f64; 3],
        to_viewer: [f64; 3],
        cell: f64,
        width: u32,
        height: u32,
    },
    Patches {
        patch_cell: f64,
        patch_cell_asked: f64,
        texels: usize,
        doubled_m2: f64,
        touching_m2: f64,
        components: Vec<ExposureReport<'a>>,
    },
}

#[derive(Serialize)]
struct ExposureReport<'a> {
    component: &'a str,
    patches: usize,
    area_m2: f64,
    hours_mean: f64,
    hours_min: f64,
    hours_max: f64,
    share_1h: f64,
    share_2h: f64,
    share_3h: f64,
    share_4h: f64,
}

#[derive(Serialize)]
struct CameraReport {
    eye: [f64; 3],
    target: [f64; 3],
    up: [f64; 3],
    fov: f64,
}

#[derive(Serialize)]
struct SunReport<'a> {
    place: PlaceReport<'a>,
    tz_version: String,
    instants: Vec<InstantReport>,
    days: Vec<DayReport>,
    notes: Vec<String>,
}

#[derive(Serialize)]
pub(super) struct PlaceReport<'a> {
    name: &'a str,
    latitude: f64,
    longitude: f64,
    elevation: f64,
    time_zone: &'static str,
}

#[derive(Serialize)]
pub(crate) struct InstantReport {
    time: String,
    azimuth_deg: f64,
    altitude_deg: f64,
    weight_secs: u32,
    night: bool,
}

#[derive(Serialize)]
struct DayReport {
    date: String,
    sunrise: Option<String>,
    noon: Option<String>,
    sunset: Option<String>,
}

/// What a report says besides the instants.
#[derive(Clone, Copy, Debug)]
pub struct ReportContext<'a> {
    /// What was judged.
    pub receivers: Receivers,
    /// The ground plane.
    pub ground: Ground,
    /// How the result was computed.
    pub drawn: &'a Provenance,
    /// How long the computation took.
    pub timings: &'a Timings,
    /// The statistics of counting, if they were requested.
    pub statistics: Option<&'a Statistics>,
    /// Notes from reading the models.
    pub notes: &'a [Message],
    /// The face's words.
    pub words: &'a dyn Words,
}

/// `profile.json`, including the sources of refraction and ΔT.
///
/// # Errors
/// [`ExportError::Encode`] if the encoder fails.
pub fn profile_json<S>(
    profile: &Profile<S>,
    place: &Place,
    track: &SunTrack,
    told: &ReportContext<'_>,
) -> Result<String, ExportError> {
    shadow_json(&View::Plan(profile.grid), place, track, told)
}

/// The JSON of `gnomon shadow`: as [`profile_json`]; instead of a plan's region and cell, a camera view has the camera
/// as in a site file.
///
/// # Errors
/// [`ExportError::Encode`] if the encoder fails.
pub(crate) fn shadow_json(
    view: &View,
    place: &Place,
    track: &SunTrack,
    told: &ReportContext<'_>,
) -> Result<String, ExportError> {
    drawn_json(view_report(view), place, track, told)
}

/// `profile.json` of patches: as [`profile_json`], but with cell, texels and components instead of region and cell.
///
/// # Errors
/// [`ExportError::Encode`] if the encoder fails.
pub(crate) fn patches_json(found: &PatchContext<'_>, told: &ReportContext<'_>) -> Result<String, ExportError> {
    let component = |(component, patches, exposure): (_, &[_], Exposure)| {
        let [share_1h, share_2h, share_3h, share_4h] = exposure.shares;
        let Exposure { area_m2, hours_mean, hours_min, hours_max, .. } = exposure;
        let patches = patches.len();
        ExposureReport {
            component,
            patches,
            area_m2,
            hours_mean,
            hours_min,
            hours_max,
            share_1h,
            share_2h,
            share_3h,
            share_4h,
        }
    };
    let view = ViewReport::Patches {
        patch_cell: found.patches.cell,
        patch_cell_asked: found.patches.asked_cell,
        texels: found.patches.texels.len(),
        doubled_m2: found.patches.left_out.doubled_m2,
        touching_m2: found.patches.left_out.touching_m2,
        components: found.components().map(component).collect(),
    };
    drawn_json(view, found.place, found.track, told)
}

fn drawn_json(
    view: ViewReport<'_>,
    place: &Place,
    track: &SunTrack,
    told: &ReportContext<'_>,
) -> Result<String, ExportError> {
    json(&drawn_report(view, place, track, told))
}

/// The part of `profile.json` that other reports contain, too.
pub(super) fn plan_report<'a>(
    grid: &Grid,
    place: &'a Place,
    track: &SunTrack,
    told: &ReportContext<'a>,
) -> DrawnReport<'a> {
    drawn_report(view_report(&View::Plan(*grid)), place, track, told)
}

/// How hours were found between a study's instants, without a stop; none where no study is, and where instants are as near
/// together as times of change would be found.
pub fn between_instants(
    drawn: &Provenance,
    (receivers, ground): (Receivers, &Ground),
    track: &SunTrack,
) -> Option<String> {
    let step = figure::duration(track.step_secs);
    let subject = match (receivers, ground.kind) {
        (Receivers::Top, _) => Subject::Top,
        (Receivers::Ground, GroundKind::Plane) => Subject::Ground,
        (Receivers::Ground, GroundKind::Terrain) => Subject::Terrain,
        (Receivers::Patches, _) => Subject::Patches,
    };
    if track.instants.len() < 2 {
        return None;
    }
    match drawn.resolution_secs {
        0 => Some(format!("counted at instants {step} apart, and not between them")),
        secs if secs >= track.step_secs => None,
        secs => {
            let found = figure::duration(secs);
            let missed = match drawn.technique.row().searches_singly(drawn.engine, subject) {
                SinglySearched::Nothing => format!("light or shade shorter than {found} may be missed"),
                SinglySearched::AboveGround => {
                    format!("above the ground light or shade shorter than {step} may be missed")
                }
                SinglySearched::Everything => format!("light or shade shorter than {step} may be missed"),
            };
            Some(format!("changes found to {found}; {missed}"))
        }
    }
}

pub(super) fn settings_report(settings: &Settings) -> SettingsReport {
    let Settings { map_size, filter, smoothie_width_m, sun_samples } = *settings;
    SettingsReport { map_size, pcf: filter.map(Filter::word), smoothie_width: smoothie_width_m, sun_samples }
}

fn drawn_report<'a>(
    view: ViewReport<'a>,
    place: &'a Place,
    track: &SunTrack,
    told: &ReportContext<'a>,
) -> DrawnReport<'a> {
    let ReportContext { receivers, ground, drawn, timings, statistics, notes, words } = *told;
    let air = Air::standard(place.elevation_m);
    let refracted = |value| track.refraction.then_some(value);
    DrawnReport {
        gnomon: env!("CARGO_PKG_VERSION"),
        place: place_report(place),
        tz_version: tz_version(place),
        view,
        receivers: receivers.word(),
        ground: ground_report(&ground),
        technique: drawn.technique.word(),
        silhouette: drawn.finder.map(Finder::word),
        engine: drawn.engine.word(),
        adapter: drawn.adapter.as_deref(),
        settings: settings_report(&drawn.settings),
        resolution_secs: drawn.resolution_secs,
        between_instants: between_instants(drawn, (receivers, &ground), track),
        refraction: track.refraction,
        refraction_celsius: refracted(air.temperature_c),
        refraction_millibar: refracted(air.pressure_hpa),
        algorithm: "NREL SPA",
        delta_t_secs: track.delta_t_secs,
        delta_t_source: "Espenak and Meeus",
        instants: track.instants.iter().map(instant_report).collect(),
        days: track.days.iter().map(day_report).collect(),
        notes: said(notes, words),
        timings_secs: timings,
        statistics: statistics.map(|it| StatisticsReport {
            cells: it.cells,
            silhouette_cells: it.silhouette_cells,
            fragments: it.fragments,
            fragments_without_mask: it.fragments_without_mask,
        }),
    }
}

fn view_report(view: &View) -> ViewReport<'static> {
    let (width, height) = view.size();
    match view {
        View::Plan(grid) => ViewReport::Plan { region: grid.region(), cell: grid.cell, width, height },
        View::Camera(camera) => ViewReport::Camera {
            camera: CameraReport {
                eye: camera.eye.to_array(),
                target: camera.target.to_array(),
                up: camera.up.to_array(),
                fov: camera.fov_rad.to_degrees(),
            },
            width,
            height,
        },
        View::Elevation(side) => ViewReport::Elevation {
            target: side.target.to_array(),
            to_viewer: side.to_viewer.to_array(),
            cell: side.cell,
            width,
            height,
        },
    }
}

/// Notes as a report shows them.
pub(super) fn said(notes: &[Message], words: &dyn Words) -> Vec<String> {
    notes.iter().map(|note| note.in_words(words)).collect()
}

/// The JSON of `gnomon sun`: place, instants, days and notes as in [`profile_json`].
///
/// # Errors
/// [`ExportError::Encode`] if the encoder fails.
pub fn sun_json(place: &Place, track: &SunTrack, notes: &[Message], words: &dyn Words) -> Result<String, ExportError> {
    json(&SunReport {
        place: place_report(place),
        tz_version: tz_version(place),
        instants: track.instants.iter().map(instant_report).collect(),
        days: track.days.iter().map(day_report).collect(),
        notes: said(notes, words),
    })
}

/// The table of `gnomon sun`: one line per instant, then one line per day; ends with a line break.
/// For a day without sunrise and sunset it says whether the sun stays up or down.
pub fn sun_table(place: &Place, track: &SunTrack) -> String {
    let mut table = String::new();
    // Writing to a String cannot fail.
    let zone = format!("{}, tz {}", place.time_zone, place.time_zone.version());
    let width = zone.len().max(25);
    let _ = writeln!(table, "{zone:<width$}  {:>9}  {:>9}  {:>8}", "azimuth°", "altitude°", "weight s");
    for instant in &track.instants {
        let _ = writeln!(
            table,
            "{:<width$}  {:>9.4}  {:>9.4}  {:>8}{}",
            stamp(&instant.time),
            instant.azimuth_rad.to_degrees(),
            instant.altitude_rad.to_degrees(),
            instant.weight_secs,
            if instant.night { "  night" } else { "" },
        );
    }
    let _ = writeln!(table, "\n{:<10}  {:>8}  {:>8}  {:>8}", "day", "sunrise", "noon", "sunset");
    for day in &track.days {
        let _ = writeln!(
            table,
            "{:<10}  {:>8}  {:>8}  {:>8}{}",
            day.date.to_string(),
            clock(day.sunrise.as_ref()),
            clock(day.noon.as_ref()),
            clock(day.sunset.as_ref()),
            match day.polar {
                Some(Polar::Day) => "  the sun stays up",
                Some(Polar::Night) => "  the sun stays down",
                None => "",
            },
        );
    }
    table
}

pub(super) fn place_report(place: &Place) -> PlaceReport<'_> {
    PlaceReport {
        name: &place.name,
        latitude: place.latitude_deg,
        longitude: place.longitude_deg,
        elevation: place.elevation_m,
        time_zone: place.time_zone.name(),
    }
}

/// The tz version of the clock's rules: `2026f`.
pub(super) fn tz_version(place: &Place) -> String {
    place.time_zone.version().to_string()
}

pub(super) fn ground_report(ground: &Ground) -> GroundReport {
    GroundReport { ground: ground.level, ground_from: ground.word(), models_below_ground_m: ground.models_below_m() }
}

// Angles are not rounded: the sign of the altitude and `night` then always agree.
pub(crate) fn instant_report(instant: &Instant) -> InstantReport {
    InstantReport {
        time: stamp(&instant.time),
        azimuth_deg: instant.azimuth_rad.to_degrees(),
        altitude_deg: instant.altitude_rad.to_degrees(),
        weight_secs: instant.weight_secs,
        night: instant.night,
    }
}

fn day_report(day: &Day) -> DayReport {
    DayReport {
        date: day.date.to_string(),
        sunrise: day.sunrise.as_ref().map(stamp),
        noon: day.noon.as_ref().map(stamp),
        sunset: day.sunset.as_ref().map(stamp),
    }
}

/// RFC 3339 with the place's offset, in whole seconds. Offsets may have seconds, too, as before time zones were
/// introduced.
pub(super) fn stamp(time: &DateTime<Zone>) -> String {
    let offset = time.offset().fix();
    if offset.local_minus_utc() % 60 != 0 {
        return format!("{}{offset}", time.format("%Y-%m-%dT%H:%M:%S"));
    }
    time.to_rfc3339_opts(SecondsFormat::Secs, false)
}

fn clock(time: Option<&DateTime<Zone>>) -> String {
    time.map_or_else(|| "-".to_owned(), |time| time.format("%H:%M:%S").to_string())
}

fn in_order<S: Serializer>(timings: &&Timings, serializer: S) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(Some(timings.0.len()))?;
    for (stage, secs) in &timings.0 {
        map.serialize_entry(stage, secs)?;
    }
    map.end()
}

pub(super) fn json(report: &impl Serialize) -> Result<String, ExportError> {
    let mut text = serde_json::to_string_pretty(report).map_err(|error| ExportError::encode("JSON report", error))?;
    text.push('\n');
    Ok(text)
}
