//! Drawings: a picture of the result on a sheet that says what it shows, ready for print or a slide.
//!
//! The picture is made cell by cell in Rust; all lines and text are one SVG, which resvg draws over it.

mod components;
mod context;
mod counted;
mod difference;
mod fonts;
mod lines;
mod overlay;
mod page;
mod panel;
mod paper;
mod patches;
mod perspective;
mod picture;
mod plan;
pub mod scale;
mod screen;
mod strips;
mod svg;
mod text;
mod words;

pub use components::of_all as component_colours;
pub use context::FigureContext;
pub use counted::{Colours, Diagram};
pub use difference::{ChangeBands, ChangeColours, difference};
#[cfg(feature = "desktop")]
pub use fonts::face_with;
pub use fonts::{runs, without_face};
pub use lines::{LineDrawing, MOST_OUTLINES, Outline, heights, iso_hours, outlines};
pub use lines::{SkyContext, card_picture, sky_card, sky_colours, sky_pictures, sky_sheet};
pub use panel::ScaleBar;
pub use paper::{HEIGHT, WIDTH};
pub use patches::{legend as patches_legend, patches};
pub use screen::{Screen, bare, instant_on_screen};
#[cfg(feature = "test-hooks")]
pub use screen::{bare_hours, bare_patches};
pub use strips::strips;
pub use text::without_middle;
pub(crate) use words::duration;

use super::{ExportError, check_size, report};
use crate::choice::Receivers;
use crate::look::LOOK;
use crate::profile::{Profile, ShadedCells};
use crate::sun::{Air, Instant, Place, SunTrack, position};
use crate::view::{FragmentCounts, Grid, Mask, Overlay, Surface, SurfaceRows, View};
use components::Components;
use page::Sheet;
use panel::Panel;
use scale::{Bands, NO_SHADOW, mix};

/// What a camera's picture shows besides sun and shadow.
#[derive(Clone, Copy, Debug, Default)]
pub struct PictureExtras<'a> {
    /// Shadow volumes and silhouette, drawn over the picture.
    pub overlay: Option<&'a Overlay>,
    /// Colours each component of [`FigureContext::mesh`] differently; the slice says which ones cast.
    pub casts: Option<&'a [bool]>,
    /// Shows the work of counting instead of sun and shadow; also possible for a plan.
    pub counted: Option<(&'a FragmentCounts, Diagram)>,
}

/// `profile.png`: the hours of shadow on the plan, in bands of whole steps.
///
/// # Errors
/// [`ExportError::Size`] if surface and profile do not fill the grid; [`ExportError::Encode`] from the encoder.
pub fn profile<S: SurfaceRows, C: ShadedCells>(
    scene: &FigureContext<S>,
    profile: &Profile<C>,
) -> Result<Vec<u8>, ExportError> {
    let grid = &profile.grid;
    check_size("profile", profile.shaded.cells(), grid.width, grid.height)?;
    check_size("surface", scene.surface.cells(), grid.width, grid.height)?;
    let bands = Bands::new(scene.track.step_secs, profile.day_secs);
    let panel = profile_panel(scene, profile, "Shadow profile");
    let size = (grid.width, grid.height);
    page::page(&panel, size, Some(grid.cell), |fit| plan::profile(scene, profile, &bands, fit), page::png)
}

/// The panel that all drawings of hours of shadow share.
fn profile_panel<S, C>(scene: &FigureContext<S>, profile: &Profile<C>, kicker: &str) -> Panel {
    let grid = &profile.grid;
    let mut panel = panel(scene, kicker);
    let all = words::long_duration(profile.day_secs);
    panel.facts.push(("Cells", cells(grid.width, grid.height, grid.cell)));
    if profile.night_secs > 0 {
        let night = words::long_duration(profile.night_secs);
        panel.facts.push(("Night", format!("{night} of the window, not counted")));
    }
    panel.legend_head =
        if profile.day_secs > 0 { format!("Hours of shadow out of {all}") } else { "No sun in this window".to_owned() };
    panel.legend = legend(&Bands::new(scene.track.step_secs, profile.day_secs));
    if scene.is_ground_alone() {
        panel.legend.push((plan::ROOF_UNJUDGED, UNJUDGED.to_owned()));
    }
    panel
}

/// The most memory that [`profile`] needs for what grows with the plan, bytes.
pub(crate) fn profile_bytes(grid: &Grid) -> u64 {
    // the sheet may be higher or wider than its picture, never lower or narrower
    let fit = picture::Fit::within((grid.width, grid.height), (f64::from(WIDTH) / 2.0, f64::from(HEIGHT) / 2.0));
    picture::task_bytes(&fit) * page::tasks() as u64
}

/// One instant, the first of the track, on the plan or in the camera's picture. `shown` is drawn over the camera's
/// picture.
///
/// # Errors
/// [`ExportError::Size`] if surface and mask do not fill the view, or an overlay's rasters do not fill the overlay;
/// [`ExportError::Encode`] from the encoder, or if the track has no instant.
pub fn instant(scene: &FigureContext, view: &View, mask: &Mask, shown: &PictureExtras) -> Result<Vec<u8>, ExportError> {
    instant_as(scene, view, mask, shown, page::png)
}

/// The sheet of [`instant`], which `finish` turns into the result.
fn instant_as<T>(
    scene: &FigureContext,
    view: &View,
    mask: &Mask,
    shown: &PictureExtras,
    finish: impl FnOnce(&Sheet) -> Result<T, ExportError>,
) -> Result<T, ExportError> {
    let size = view.size();
    check_instant(scene.surface, size, mask, shown)?;
    let now = scene.track.instants.first();
    let now = now.ok_or_else(|| ExportError::encode("drawing", "it has no instant"))?;

    let tones = match view {
        View::Plan(_) => [LOOK.plan_ground_sun, LOOK.plan_ground_shade],
        View::Camera(_) | View::Elevation(_) => perspective::ground_tones(now.to_sun),
    };
    let colours = shown.counted.and_then(|(counted, diagram)| Colours::of(counted, diagram));
    let mut panel = instant_panel(scene, view, now, shown);
    panel.legend = instant_legend(scene, now, mask, tones);
    if let Some(colours) = &colours {
        panel.legend_head.clone_from(&colours.legend_head);
        panel.legend.clone_from(&colours.legend);
    }
    let of_cells = colours.as_ref().map(|colours| &colours.of_cells[..]);
    match view {
        View::Plan(grid) => {
            panel.facts.push(("Cells", cells(grid.width, grid.height, grid.cell)));
            match of_cells {
                Some(of_cells) => page::page(&panel, size, Some(grid.cell), |fit| plan::painted(of_cells, fit), finish),
                None => {
                    page::page(&panel, size, Some(grid.cell), |fit| plan::instant(scene, grid.cell, mask, fit), finish)
                }
            }
        }
        View::Camera(_) | View::Elevation(_) => {
            let (lens, cell) = lens(view, &mut panel)?;
            panel.facts.push(("Picture", format!("{} × {}", size.0, size.1)));
            let components = shown.casts.map(|casts| Components::new(scene.mesh, scene.surface, casts));
            show(&mut panel, shown, tones[0], components.as_ref());
            let painted = perspective::OwnColours { components: components.as_ref(), of_cells };
            let draw = |fit| {
                let mut picture = perspective::instant(scene, &lens, mask, now.to_sun, painted, fit);
                if let Some(overlay) = shown.overlay {
                    overlay::lay(&mut picture, overlay);
                }
                picture
            };
            page::page(&panel, size, cell, draw, finish)
        }
    }
}

/// Returns an error if the rasters of one picture differ in size.
fn check_instant(surface: &Surface, size: (u32, u32), mask: &Mask, shown: &PictureExtras) -> Result<(), ExportError> {
    check_size("mask", mask.share.len(), size.0, size.1)?;
    check_surface(surface, size)?;
    if let Some(overlay) = shown.overlay {
        for values in [&overlay.layers, &overlay.silhouette].into_iter().flatten() {
            check_size("overlay", values.len(), overlay.width, overlay.height)?;
        }
    }
    match shown.counted {
        Some((counted, _)) => check_size("count", counted.reached.len(), size.0, size.1),
        None => Ok(()),
    }
}

/// The panel beside the picture of an instant, without a legend.
fn instant_panel(scene: &FigureContext, view: &View, now: &Instant, shown: &PictureExtras) -> Panel {
    let kicker = match shown.counted {
        _ if now.night => "Night",
        Some((_, diagram)) => diagram.title(),
        None => "Shadow",
    };
    let mut panel = panel_of_instants(scene, kicker);
    let seen = match view {
        View::Camera(_) => Some("what the camera sees"),
        // but not the earth that is cut
        View::Elevation(side) if side.is_level() => Some("what is seen above the ground"),
        View::Elevation(_) => Some("what the sun sees"),
        View::Plan(_) => None,
    };
    if let (Some(seen), Receivers::Top) = (seen, scene.receivers) {
        let judged = panel.facts.iter_mut().filter(|(label, _)| *label == JUDGED);
        judged.for_each(|(_, said)| *said = seen.to_owned());
    }
    if now.night {
        let below = words::degrees(-now.altitude_rad);
        panel.facts.push(("Night", format!("the sun is {below} below the horizon")));
    }
    panel.legend_head = "What sees the sun".to_owned();
    panel
}

/// The legend of sun and shadow; `tones` are the colours of level ground in the sun and in the shade.
fn instant_legend(
    scene: &FigureContext,
    now: &Instant,
    mask: &Mask,
    tones: [scale::Rgb; 2],
) -> Vec<(scale::Rgb, String)> {
    let mut legend = vec![(tones[0], "sun".to_owned()), (tones[1], "shadow".to_owned())];
    if now.night {
        legend = vec![(tones[1], "no sun".to_owned())];
    } else if mask.share.iter().any(|share| !matches!(share, 0 | 255)) {
        legend.insert(1, (mix(tones[1], tones[0], 0.5), "part of the sun".to_owned()));
    }
    if scene.is_ground_alone() {
        legend.push((plan::ROOF_UNJUDGED, UNJUDGED.to_owned()));
    }
    legend
}

/// The camera or side of a picture, and the side of a pixel in metres if the picture is true to scale. A side and the sun are named in
/// is named
/// in the panel.
fn lens(view: &View, panel: &mut Panel) -> Result<(perspective::PixelRays, Option<f64>), ExportError> {
    match view {
        View::Plan(_) => Err(ExportError::encode("drawing", "a plan has no lens")),
        View::Camera(camera) => Ok((perspective::PixelRays::new(camera), None)),
        View::Elevation(side) => {
            panel.facts.push(("Seen", words::side(side)));
            panel.north_up = false;
            // across the sun's rays alone lengths are true
            let cell = side.is_level().then_some(side.cell);
            Ok((perspective::PixelRays::of_side(side), cell))
        }
    }
}

/// The colours of level ground in the sun and in the shade, as a camera sees them.
#[cfg(feature = "test-hooks")]
pub fn ground_tones(to_sun: glam::DVec3) -> [scale::Rgb; 2] {
    perspective::ground_tones(to_sun)
}

/// The legend of what a picture shows besides sun and shadow.
fn show(panel: &mut Panel, shown: &PictureExtras, ground: scale::Rgb, components: Option<&Components>) {
    let mut more = Vec::new();
    if shown.overlay.is_some_and(|overlay| overlay.layers.is_some()) {
        more.push((overlay::volume_tone(ground), "shadow volume".to_owned()));
    }
    if shown.overlay.is_some_and(|overlay| overlay.silhouette.is_some()) {
        more.push((LOOK.silhouette, "silhouette".to_owned()));
    }
    more.extend(components.into_iter().flat_map(|components| components.legend.iter().cloned()));
    if !more.is_empty() {
        panel.legend_head = "What is shown".to_owned();
        panel.legend.extend(more);
    }
}

/// The legend's entry for buildings if only the ground is judged.
const UNJUDGED: &str = "not judged";

/// The label of the fact that a camera's view replaces.
const JUDGED: &str = "Judged";

/// The label of the fact behind which drawings of hours say what is between the instants.
const STEP: &str = "Step";

fn check_surface(surface: &Surface, (width, height): (u32, u32)) -> Result<(), ExportError> {
    check_size("surface", surface.face.len(), width, height)?;
    check_size("surface's heights", surface.height_m.len(), width, height)
}

/// The panel of drawings of hours, without a legend: with what is between the instants.
fn panel<S>(scene: &FigureContext<S>, kicker: &str) -> Panel {
    let mut panel = panel_of_instants(scene, kicker);
    let between = report::between_instants(scene.drawn, (scene.receivers, &scene.ground), scene.track);
    if let Some(said) = between {
        let after = panel.facts.iter().position(|(label, _)| *label == STEP).map_or(0, |at| at + 1);
        panel.facts.insert(after, ("Between", said));
    }
    panel
}

/// The panel that all drawings share, without a legend.
fn panel_of_instants<S>(scene: &FigureContext<S>, kicker: &str) -> Panel {
    let (place, track) = (scene.place, scene.track);
    let name = text::clean(&place.name);
    let nameless = name.is_empty();
    let title = if nameless { words::coordinates(place) } else { name };
    let mut facts = Vec::new();
    // A place without a name has its coordinates as the title.
    if !nameless {
        facts.push(("Place", words::coordinates(place)));
    }
    facts.push(("Elevation", words::metres(place.elevation_m)));
    facts.push(("Ground", words::ground(&scene.ground)));
    if track.instants.len() > 1 {
        let (step, count) = (words::duration(track.step_secs), track.instants.len());
        facts.push((STEP, format!("{step}, {count} instants")));
    }
    if track.each_day.is_some() {
        let day = track.instants.iter().filter(|instant| !instant.night);
        let secs = day.map(|instant| instant.weight_secs).sum();
        facts.push(("Daylight", format!("{} on {} days", words::long_duration(secs), track.days.len())));
    } else if let Some(day) = track.days.first() {
        facts.push(("Daylight", words::day(day)));
    }
    facts.push((JUDGED, words::receivers(scene.receivers).to_owned()));
    facts.push(("Technique", words::technique(scene.drawn)));
    facts.push(("Refraction", words::refraction(track.refraction, place)));
    let mut lead = Vec::new();
    if let (Some(first), Some(last)) = (track.instants.first(), track.instants.last()) {
        lead.push(words::dates(track, first, last));
        lead.push(words::window(track, place));
    }
    Panel {
        kicker: kicker.to_owned(),
        title,
        lead,
        facts,
        sun: sun_rows(place, track),
        legend_head: String::new(),
        legend: Vec::new(),
        keys: Vec::new(),
        tz: report::tz_version(place),
        north_up: true,
    }
}

fn cells(width: u32, height: u32, cell_m: f64) -> String {
    format!("{width} × {height} of {}", words::metres(cell_m))
}

/// The sun at the start, at noon if the window contains it, and at the end.
fn sun_rows(place: &Place, track: &SunTrack) -> Vec<[String; 4]> {
    let row = |what: &str, time: String, azimuth_rad: f64, altitude_rad: f64| {
        [what.to_owned(), time, words::degrees(azimuth_rad), words::degrees(altitude_rad)]
    };
    let at =
        |what, instant: &Instant| row(what, words::clock(&instant.time), instant.azimuth_rad, instant.altitude_rad);
    let (first, last) = match track.instants.as_slice() {
        [] => return Vec::new(),
        [now] => return vec![at("shown", now)],
        [first, .., last] => (first, last),
    };
    let air = track.refraction.then(|| Air::standard(place.elevation_m));
    if track.each_day.is_some() {
        return highest_rows(track, row);
    }
    let noons = track.days.iter().filter_map(|day| day.noon).filter(|noon| first.time < *noon && *noon < last.time);
    let noon = noons.take(1).filter_map(|noon| {
        let sun = position(place, noon.to_utc(), track.delta_t_secs, air).ok()?;
        Some(row("noon", words::almanac(&noon), sun.azimuth_deg.to_radians(), sun.altitude_deg.to_radians()))
    });
    std::iter::once(at("start", first)).chain(noon).chain([at("end", last)]).collect()
}

/// For several days: the sun's greatest altitude at any of the instants, on the day on which it is highest and on the
/// day on which it is lowest.
fn highest_rows(track: &SunTrack, row: impl Fn(&str, String, f64, f64) -> [String; 4]) -> Vec<[String; 4]> {
    let mut highest: Vec<&Instant> = Vec::new();
    for instant in &track.instants {
        match highest.last_mut() {
            Some(last) if last.time.date_naive() == instant.time.date_naive() => {
                if instant.altitude_rad > last.altitude_rad {
                    *last = instant;
                }
            }
            _ => highest.push(instant),
        }
    }
    // the last instant of a window may be midnight of the next day
    highest.retain(|instant| track.days.iter().any(|day| day.date == instant.time.date_naive()));
    let low_to_high = |a: &&&Instant, b: &&&Instant| a.altitude_rad.total_cmp(&b.altitude_rad);
    let told = [("highest", highest.iter().max_by(low_to_high)), ("lowest", highest.iter().min_by(low_to_high))];
    let day = |instant: &Instant| instant.time.format("%-d %b %H:%M").to_string();
    let rows = told.into_iter().filter_map(|(what, instant)| Some((what, instant?)));
    rows.map(|(what, instant)| row(what, day(instant), instant.azimuth_rad, instant.altitude_rad)).collect()
}

fn legend(bands: &Bands) -> Vec<(scale::Rgb, String)> {
    let with_secs = !bands.band_secs.is_multiple_of(60);
    let mut legend = vec![(NO_SHADOW, "none".to_owned())];
    for (band, colour) in bands.colours.iter().enumerate() {
        let (from, to) = bands.bounds(band);
        let label = if bands.band_secs >= words::MANY_HOURS_SECS {
            let [from, to] = [from, to].map(|secs| (f64::from(secs) / 3600.0).round());
            format!("{from} – {to} h")
        } else {
            let [from, to] = [from, to].map(|secs| words::hours(secs, with_secs));
            format!("{from} – {to}")
        };
        legend.push((*colour, label));
    }
    legend
}
