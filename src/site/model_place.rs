//! The place that models' files propose, and what `gnomon check` says of each.

use super::anchored_zero::true_north;
use super::error::SiteError;
use super::file::{ElevationSource, PlaceSource, PlaceTable};
use super::georeference::{Georeference, Reference, StandFault};
use super::metres;
use super::overrides::refuse;
use super::place_doubts::{self, degrees};
use super::placement::Placement;
use super::stand::{FAR_M, ProposedPoint, SiteFrame, map_middle, proposal};
use super::stand::{ONE_MERIDIAN_RAD, StandingModel};
use super::written::WrittenSite;
use crate::crs::{Crs, CrsKind, GeodeticPoint, LocalFrame};
use crate::formats::{Anchor, AnchorPoint, Coordinates, Model, ModelError, Up};
use crate::message::{Field, Message, Piece, message, pieces, place_setting, set_to, setting};
use glam::DVec3;
use std::path::Path;

/// What a model's file, and the site file, say of its coordinates.
#[derive(Clone, Debug)]
pub struct ModelReference {
    /// As the site file names it.
    pub name: String,
    /// Metres a unit, and whether somebody says so.
    pub unit_m: f64,
    /// Whether the file or the site file says the unit.
    pub unit_is_said: bool,
    /// The axis that is up.
    pub up: Up,
    /// Whether the file, its format or the site file says the axis.
    pub up_is_said: bool,
    /// The reference system of its coordinates, or of the anchor by which it is said to stand.
    pub crs: Option<String>,
    /// Who says so: the file in its own term, or `crs`.
    pub said_by: Option<String>,
    /// Where that has its zero, or its middle where its coordinates are of a map.
    pub said: Option<EarthPoint>,
    /// Where these stand; none where nobody knows a place.
    pub stands: Option<EarthPoint>,
    /// What says that: as `said_by`, where it stands as it is said, else `position` or the site's place.
    pub stands_by: String,
    /// All that its file says.
    pub anchors: Vec<Anchor>,
    /// Degrees clockwise from its north to true north at the place: by this it is turned.
    pub north_deg: f64,
    /// Degrees clockwise from true north at the place to true north where it stands; none where both are one.
    pub meridian_deg: Option<f64>,
    /// Degrees clockwise from true north to the map's, there.
    pub convergence_deg: Option<f64>,
    /// How its map's datum is shifted to WGS 84; none where it stands on no map.
    pub(super) shift: Option<String>,
    /// Its map, and its point there.
    on_map: Option<(Crs, DVec3)>,
}

/// A point of the Earth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EarthPoint {
    /// Longitude, latitude, height above the sea.
    pub at: GeodeticPoint,
    /// Whether somebody says the height.
    pub has_height: bool,
}

impl ModelReference {
    pub(super) fn of(name: &str, model: &Model, placement: &Placement, said: &Georeference) -> ModelReference {
        let point = proposal(model, said);
        let (crs, on_map) = match &said.reference {
            Reference::Placement => (None, None),
            Reference::Map { crs, map_from_model, .. } => {
                (Some(&**crs), map_middle(model, crs, *map_from_model).map(|at| (Crs::clone(crs), at)))
            }
            Reference::Anchor(zero) => (zero.on_map.as_ref().map(|(crs, _)| crs), zero.on_map.clone()),
        };
        let convergence = on_map.as_ref().and_then(|(crs, at)| crs.convergence_rad(at.x, at.y));
        let by_anchor = match &said.reference {
            Reference::Placement => None,
            Reference::Map { .. } => convergence.map(|convergence| -convergence),
            Reference::Anchor(zero) => true_north(zero),
        };
        // of what is drawn in a map's coordinates the unit is that on the ground
        let unit_m = match &said.reference {
            Reference::Map { crs, unit_m, .. } if crs.kind() != CrsKind::Geographic => *unit_m,
            _ => placement.unit_m(model),
        };
        let is_map = matches!(model.coordinates, Coordinates::Map(_));
        let north_rad = placement.north_rad.or(by_anchor).unwrap_or_default();
        ModelReference {
            name: name.to_owned(),
            unit_m,
            unit_is_said: placement.scale.is_some() || model.unit_m.is_some() || is_map,
            up: placement.up.unwrap_or(model.up),
            up_is_said: placement.up.is_some() || model.up_is_said,
            crs: crs.map(|crs| crs.name().to_owned()),
            shift: crs.map(|crs| crs.shift().to_owned()),
            said_by: Some(said.said_by.clone()).filter(|by| !by.is_empty()),
            said: point.map(|point| EarthPoint { at: point.at, has_height: point.has_elevation }),
            stands: None,
            stands_by: String::new(),
            anchors: model.anchors.clone(),
            // −0 is 0
            north_deg: north_rad.to_degrees() + 0.0,
            convergence_deg: convergence.map(f64::to_degrees),
            meridian_deg: None,
            on_map,
        }
    }

    /// Adds where the model stands in the site's frame.
    pub(super) fn place_in(&mut self, frame: &SiteFrame, placement: &Placement, stands: &StandingModel) {
        let turned_rad = match &self.on_map {
            Some((crs, at)) if stands.is_of_map => frame.local.map_north_rad(crs, *at).map(|north| -north),
            _ => Some(stands.north_rad),
        };
        if let Some(north_rad) = turned_rad {
            self.north_deg = north_rad.to_degrees() + 0.0;
        }
        let elevation_m = frame.local.elevation_m();
        let said = self.said.filter(|_| stands.is_where_said).map(|said| {
            match said.has_height || stands.model.stands_on_ground() {
                true => said,
                // without a height it stands as high as the place
                false => EarthPoint {
                    at: GeodeticPoint { height_m: elevation_m, ..said.at },
                    has_height: frame.has_elevation,
                },
            }
        });
        self.stands = said.or_else(|| {
            let zero = match self.said.filter(|_| stands.is_of_map) {
                Some(said) => frame.local.point(said.at)? + stands.position,
                None => stands.position,
            };
            Some(EarthPoint { at: frame.local.on_earth(zero)?, has_height: frame.has_elevation })
        });
        self.stands_by = match (&self.said_by, placement.position) {
            (Some(said_by), _) if said.is_some() => said_by.clone(),
            (_, Some(_)) => "position".to_owned(),
            _ => "the site's place".to_owned(),
        };
        let meridian = self.stands.and_then(|stands| frame.local.true_north_rad(stands.at));
        self.meridian_deg = meridian.filter(|meridian| meridian.abs() >= ONE_MERIDIAN_RAD).map(f64::to_degrees);
    }
}

/// That models are on maps of two datums, which are matched by a few parameters alone.
pub(super) fn of_shifts(models: &[ModelReference]) -> Option<Message> {
    let on_maps = || models.iter().filter_map(|model| Some((model, model.shift.as_deref()?, model.crs.as_deref()?)));
    let (one, shift, crs) = on_maps().next()?;
    let (other, _, other_crs) = on_maps().find(|(_, other, _)| *other != shift)?;
    let what = format!(
        "{} is in {crs}, and {} in {other_crs}: their datums differ, and are matched by a few parameters, which hold to some \
         metres",
        one.name, other.name
    );
    Some(message![what; "export both in one system to have them meet to the centimetre"])
}

/// A model, as the site file names it, and what is said of it.
pub(super) type SaidModel<'a> = (&'a str, &'a Model, &'a Placement, &'a Georeference);

/// Where the models stand.
#[derive(Default)]
pub(super) struct ModelsFrame {
    /// None where nobody says a place.
    pub(super) frame: Option<SiteFrame>,
    /// The place, where a file says it.
    pub(super) proposed: Option<PlaceTable>,
    /// The place's elevation, where the site file says the place without one.
    pub(super) elevation: Option<ModelElevation>,
}

/// The place's elevation, as a model's file says it.
#[derive(Clone, Debug)]
pub(super) struct ModelElevation {
    /// Which of the models, from 0.
    pub(super) model: usize,
    /// The file, and what in it.
    said_by: String,
    pub(super) height_m: f64,
}

impl ModelElevation {
    /// As a place says it.
    pub(super) fn proposed(&self) -> PlaceTable {
        let source = ElevationSource { said: self.said_by.clone(), elevation: self.height_m };
        PlaceTable { elevation: Some(self.height_m), elevation_source: Some(source), ..PlaceTable::default() }
    }
}

/// The frame around a place that the site file says. Where it says no elevation, that of the first model is, whose file says
/// one and that stands nearby: the models stand at 0, as those do whose files say none.
fn written_frame<'a>(
    table: &PlaceTable,
    [latitude_deg, longitude_deg]: [f64; 2],
    models: impl Iterator<Item = SaidModel<'a>>,
) -> ModelsFrame {
    let at = GeodeticPoint { latitude_deg, longitude_deg, height_m: table.elevation.unwrap_or_default() };
    let Some(local) = LocalFrame::around(at) else { return ModelsFrame::default() };
    let said = |(model_index, (name, model, placement, said)): (usize, SaidModel)| {
        let point = proposal(model, said).filter(|point| point.has_elevation && placement.position.is_none())?;
        let is_near = local.point(point.at).is_some_and(|there| there.truncate().length() <= FAR_M);
        let said_by = format!("{}, {}", file_name(name), said.said_by);
        is_near.then_some(ModelElevation { model: model_index, said_by, height_m: point.at.height_m })
    };
    let elevation = if table.elevation.is_none() { models.enumerate().find_map(said) } else { None };
    let around = elevation.as_ref().and_then(|of| LocalFrame::around(GeodeticPoint { height_m: of.height_m, ..at }));
    let has_elevation = table.elevation.is_some() || around.is_some();
    let frame = Some(SiteFrame { local: around.unwrap_or(local), has_elevation, is_of: None });
    ModelsFrame { frame, proposed: None, elevation }
}

/// That a model's file says the place's elevation, with the model for its subject.
pub(super) fn elevation_note(height_m: f64) -> Message {
    let key = set_to("[place]", "elevation", height_m.to_string(), "`elevation` in [place]".to_owned());
    message![
        format!("says the elevation of the place, {}, as nobody wrote one", metres(height_m));
        key, " changes it"
    ]
}

/// The place of the models: the site file's, else the first that a file proposes; one that is a program's own only where
/// there is no other. What else the site file says of the place goes before the file.
///
/// # Errors
/// A latitude without a longitude, and the other way round.
pub(super) fn frame<'a>(
    written: &WrittenSite,
    models: impl Iterator<Item = SaidModel<'a>>,
) -> Result<ModelsFrame, SiteError> {
    let table = written.site.place.clone().unwrap_or_default();
    if let Some(point) = written.point()? {
        return Ok(written_frame(&table, point, models));
    }
    let proposed: Vec<(ProposedPoint, &str, &Georeference)> =
        models.filter_map(|(name, model, _, said)| Some((proposal(model, said)?, file_name(name), said))).collect();
    let is_sure = |(point, _, said): &&(ProposedPoint, &str, &Georeference)| {
        place_doubts::of(Some(point.at), &said.said_by).is_none()
    };
    let sure = proposed.iter().find(is_sure).or(proposed.first());
    let Some((ProposedPoint { at, has_elevation }, name, said)) = sure else { return Ok(ModelsFrame::default()) };
    // where the first says no elevation, another may
    let around = LocalFrame::around(*at);
    let is_near = |point: &ProposedPoint| {
        let there = around.as_ref().and_then(|around| around.point(point.at));
        there.is_some_and(|there| there.truncate().length() <= FAR_M)
    };
    let other = proposed.iter().find(|(point, ..)| point.has_elevation && is_near(point));
    let other = other.filter(|_| !has_elevation && table.elevation.is_none()).map(|(point, name, said)| {
        ElevationSource { said: format!("{name}, {}", said.said_by), elevation: point.at.height_m }
    });
    let of_files = || has_elevation.then_some(at.height_m).or(other.as_ref().map(|other| other.elevation));
    let elevation = table.elevation.or_else(of_files);
    let height_m = elevation.unwrap_or_default();
    let table = PlaceTable {
        latitude: Some(at.latitude_deg),
        longitude: Some(at.longitude_deg),
        elevation,
        source: Some(PlaceSource {
            said: format!("{name}, {}", said.said_by),
            at: [at.latitude_deg, at.longitude_deg],
        }),
        elevation_source: other,
        ..table
    };
    let point = if matches!(said.reference, Reference::Map { .. }) { "middle" } else { "zero" };
    let is_of = Some(format!("the {point} of {name}"));
    let local = LocalFrame::around(GeodeticPoint { height_m, ..*at });
    let frame = local.map(|local| SiteFrame { local, has_elevation: elevation.is_some(), is_of });
    Ok(ModelsFrame { frame, proposed: Some(table), elevation: None })
}

fn file_name(path: &str) -> &str {
    Path::new(path).file_name().and_then(|name| name.to_str()).unwrap_or(path)
}

impl WrittenSite {
    /// Whether it is a model without a site file.
    pub fn is_bare_model(&self) -> bool {
        self.text.is_empty() && !self.site.model.is_empty()
    }

    /// A note, which names no keys of a site file where there is none.
    pub(super) fn worded(&self, note: Message) -> Message {
        if self.is_bare_model() { note.of_bare_model() } else { note }
    }

    /// That its place is a file's, where nobody has changed it since; a sentence without its stop.
    pub(super) fn place_note(&self) -> Option<Message> {
        let table = self.site.place.as_ref()?;
        let said = table.said_by()?;
        let at = GeodeticPoint {
            latitude_deg: table.latitude?,
            longitude_deg: table.longitude?,
            height_m: table.elevation.unwrap_or_default(),
        };
        let by = table.elevation_said_by().map(|by| format!(", as {by} says")).unwrap_or_default();
        let height =
            table.elevation.map(|height| format!(", {} above the sea{by}", metres(height))).unwrap_or_default();
        let what = format!("place from {said}: {}{height}", degrees(at));
        if self.is_bare_model() {
            return Some(message![what; "change it with ", place_setting("latitude and longitude in [place]")]);
        }
        Some(message![
            what;
            setting("[place]", "latitude", "latitude"), ", ",
            setting("[place]", "longitude", "longitude"), " and ",
            setting("[place]", "elevation", "elevation in [place]"), " change it",
            Piece::Where(Field::Place, pieces![", or ", (Field::Place, "LAT,LON")])
        ])
    }

    /// That a place that a file says may be one that nobody has set.
    pub(super) fn place_doubt(&self) -> Option<Message> {
        let source = self.site.place.as_ref()?.source.as_ref()?;
        let (name, said_by) = source.said.rsplit_once(", ")?;
        let [latitude_deg, longitude_deg] = source.at;
        let doubt = place_doubts::of(Some(GeodeticPoint { latitude_deg, longitude_deg, height_m: 0.0 }), said_by)?;
        Some(doubt.about(name))
    }

    /// Why one of the models cannot stand where it is said.
    pub(super) fn model_fault(&self, index: usize, fault: StandFault) -> SiteError {
        match fault {
            StandFault::Key(key, message) if !self.is_bare_model() => refuse(self.model_key(index, key), message),
            // without a site file there is no key, and the model is at fault
            StandFault::Key(_, message) | StandFault::File(message) => {
                let message = self.worded(message);
                let path = self.site.model.get(index).and_then(|table| table.path.as_deref()).unwrap_or_default();
                ModelError { file: self.folder.join(path), fault: message.into() }.into()
            }
        }
    }
}

impl PlaceTable {
    /// Takes from another what it does not say itself: a point with its clock, and an elevation.
    pub fn complete_with(&mut self, other: &PlaceTable) {
        if self.latitude.is_none() && self.longitude.is_none() {
            (self.latitude, self.longitude) = (other.latitude, other.longitude);
            self.source.clone_from(&other.source);
            self.time_zone = self.time_zone.take().or_else(|| other.time_zone.clone());
        }
        if self.elevation.is_none() {
            self.elevation = other.elevation;
            self.elevation_source.clone_from(&other.elevation_source);
        }
    }

    /// Which file said the elevation alone, where it is still what that says.
    pub fn elevation_said_by(&self) -> Option<&str> {
        let source = self.elevation_source.as_ref()?;
        (self.elevation == Some(source.elevation)).then_some(source.said.as_str())
    }

    /// Which file said it, and by what, where it is still what that says.
    pub fn said_by(&self) -> Option<&str> {
        let source = self.source.as_ref()?;
        let is_its = self.latitude == Some(source.at[0]) && self.longitude == Some(source.at[1]);
        is_its.then_some(source.said.as_str())
    }
}

/// The point of an anchor, in words: `EPSG:25832 458874.49, 5438769.71`.
pub fn anchor_text(at: &AnchorPoint) -> String {
    match at {
        AnchorPoint::Nowhere => String::new(),
        AnchorPoint::Geographic { latitude_deg, longitude_deg, elevation_m } => {
            let at = GeodeticPoint {
                latitude_deg: *latitude_deg,
                longitude_deg: *longitude_deg,
                height_m: elevation_m.unwrap_or_default(),
            };
            let height = elevation_m.map(|height| format!(", {}", metres(height))).unwrap_or_default();
            format!("{}{height}", degrees(at))
        }
        AnchorPoint::Map { crs, easting, northing, height, .. } => {
            let crs = if crs.is_empty() { "an unnamed map" } else { crs };
            let height = height.map(|height| format!(", {}", metres(height))).unwrap_or_default();
            format!("{easting}, {northing} in {crs}{height}")
        }
    }
}
