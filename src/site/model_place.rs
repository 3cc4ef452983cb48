//! The place that models' files propose, and what `gnomon check` reports about each.

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
use crate::message::{Field, Message, MessagePart, message, pieces, place_setting, set_to, setting};
use glam::DVec3;
use std::path::Path;

/// What a model's file and the site file say about its coordinates.
#[derive(Clone, Debug)]
pub struct ModelReference {
    /// The file as the site file names it.
    pub name: String,
    /// The length of a unit, metres.
    pub unit_m: f64,
    /// Whether the file or the site file gives the unit.
    pub unit_is_said: bool,
    /// The up axis.
    pub up: Up,
    /// Whether the file, its format or the site file gives the axis.
    pub up_is_said: bool,
    /// The reference system of its coordinates, or of the anchor that places it.
    pub crs: Option<String>,
    /// The source of that: the file's own term, or `crs`.
    pub said_by: Option<String>,
    /// Where the source puts its origin, or its middle if its coordinates are in a map.
    pub said: Option<EarthPoint>,
    /// Where that stands in the site; `None` without a place.
    pub stands: Option<EarthPoint>,
    /// What determines that: `said_by` if it stands where that says, otherwise `position` or the site's place.
    pub stands_by: String,
    /// Everything that its file says.
    pub anchors: Vec<Anchor>,
    /// The angle by which it is turned: degrees clockwise from its north to true north at the place.
    pub north_deg: f64,
    /// Degrees clockwise from true north at the place to true north where the model stands; `None` if they are equal.
    pub meridian_deg: Option<f64>,
    /// Degrees clockwise from true north to the map's north, where the model stands.
    pub convergence_deg: Option<f64>,
    /// How its map's datum is shifted to WGS 84; `None` if it is not in a map.
    pub(super) shift: Option<String>,
    /// Its map, and its point in it.
    on_map: Option<(Crs, DVec3)>,
}

/// A point of the Earth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EarthPoint {
    /// Longitude, latitude, and height above the sea.
    pub at: GeodeticPoint,
    /// Whether the height is given.
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
        // the unit of what is drawn in a map's coordinates is the horizontal one
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
            // turns −0 into 0
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
                // without a height it stands at the place's elevation
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

/// A note if models are in maps of two datums that are related only by a transformation of a few parameters.
pub(super) fn of_shifts(models: &[ModelReference]) -> Option<Message> {
    let on_maps = || models.iter().filter_map(|model| Some((model, model.shift.as_deref()?, model.crs.as_deref()?)));
    let (one, shift, crs) = on_maps().next()?;
    let (other, _, other_crs) = on_maps().find(|(_, other, _)| *other != shift)?;
    let what = format!(
        "{} is in {crs}, and {} in {other_crs}: their datums differ, and are related by a few parameters, which hold to some \
         metres",
        one.name, other.name
    );
    Some(message![what; "export both in one system to have them meet to the centimetre"])
}

/// A model, its name in the site file, and what is said about its place.
pub(super) type SaidModel<'a> = (&'a str, &'a Model, &'a Placement, &'a Georeference);

/// The frame in which the models stand.
#[derive(Default)]
pub(super) struct ModelsFrame {
    /// `None` if nothing gives a place.
    pub(super) frame: Option<SiteFrame>,
    /// The place, if a file gives it.
    pub(super) proposed: Option<PlaceTable>,
    /// The place's elevation, if a file gives it and the site file does not.
    pub(super) elevation: Option<ModelElevation>,
}

/// The place's elevation as a model's file gives it.
#[derive(Clone, Debug)]
pub(super) struct ModelElevation {
    /// The index of the model, from 0.
    pub(super) model: usize,
    /// The file and the item in it.
    said_by: String,
    pub(super) height_m: f64,
}

impl ModelElevation {
    /// As the table of a place.
    pub(super) fn proposed(&self) -> PlaceTable {
        let source = ElevationSource { said: self.said_by.clone(), elevation: self.height_m };
        PlaceTable { elevation: Some(self.height_m), elevation_source: Some(source), ..PlaceTable::default() }
    }
}

/// The frame around a place that the site file gives. If that has no elevation, it is taken from the first model whose
/// file gives one and that stands nearby. The models then stand at height 0, as do those whose files give no elevation.
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

/// A note that a model's file gave the place's elevation, with the model as the subject.
pub(super) fn elevation_note(height_m: f64) -> Message {
    let key = set_to("[place]", "elevation", height_m.to_string(), "`elevation` in [place]".to_owned());
    message![
        format!("gives the elevation of the place, {}, since the site has none", metres(height_m));
        key, " changes it"
    ]
}

/// The place of the models: the site file's, otherwise the first that a file proposes. A program's default place is
/// used only if there is no other. Other keys under `[place]` have priority over the file.
///
/// # Errors
/// A latitude without a longitude, or a longitude without a latitude.
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
    // if the first has no elevation, another file may have one
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

    /// A note that its place comes from a file, unless it was changed since.
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
            MessagePart::Where(Field::Place, pieces![", or ", (Field::Place, "LAT,LON")])
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

    /// The error for a model that cannot stand where it is said to stand.
    pub(super) fn model_fault(&self, index: usize, fault: StandFault) -> SiteError {
        match fault {
            StandFault::Key(key, message) if !self.is_bare_model() => refuse(self.model_key(index, key), message),
            // without a site file there is no key, so the model is at fault
            StandFault::Key(_, message) | StandFault::File(message) => {
                let message = self.worded(message);
                let path = self.site.model.get(index).and_then(|table| table.path.as_deref()).unwrap_or_default();
                ModelError { file: self.folder.join(path), fault: message.into() }.into()
            }
        }
    }
}

impl PlaceTable {
    /// Takes from another table what this one lacks: a point with its time zone, and an elevation.
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

    /// The file that gave only the elevation, if the elevation is still that value.
    pub fn elevation_said_by(&self) -> Option<&str> {
        let source = self.elevation_source.as_ref()?;
        (self.elevation == Some(source.elevation)).then_some(source.said.as_str())
    }

    /// The file that gave the place, and the item in it, if the place is still that.
    pub fn said_by(&self) -> Option<&str> {
        let source = self.source.as_ref()?;
        let is_its = self.latitude == Some(source.at[0]) && self.longitude == Some(source.at[1]);
        is_its.then_some(source.said.as_str())
    }
}

/// An anchor's point in words: `EPSG:25832 458874.49, 5438769.71`.
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
