//! The place that models' files propose, and what `gnomon check` says of each.

use super::anchored_zero::{AnchoredZero, true_north};
use super::error::SiteError;
use super::file::{PlaceSource, PlaceTable};
use super::georeference::{Georeference, Reference};
use super::metres;
use super::overrides::refuse;
use super::place_doubts::{self, degrees};
use super::placement::Placement;
use super::stand::{FAR_M, ProposedPoint, SiteFrame, map_middle, proposal};
use super::written::WrittenSite;
use crate::crs::{GeodeticPoint, LocalFrame};
use crate::formats::{Anchor, AnchorPoint, Model, Up};
use crate::message::{Field, Message, Piece, message, pieces, set_to, setting};
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
    /// The reference system of its coordinates, or of the anchor by which it stands.
    pub crs: Option<String>,
    /// Who says where it stands.
    pub said_by: Option<String>,
    /// Where its zero stands, or its middle where its coordinates are of a map.
    pub place: Option<GeodeticPoint>,
    /// Whether the height of that is said.
    pub has_height: bool,
    /// All that its file says.
    pub anchors: Vec<Anchor>,
    /// Degrees clockwise from its north to true north, as the site file says, else its anchor.
    pub north_deg: f64,
    /// Degrees clockwise from true north to the map's, there.
    pub convergence_deg: Option<f64>,
    /// How its map's datum is shifted to WGS 84; none where it stands on no map.
    pub(super) shift: Option<String>,
}

impl ModelReference {
    pub(super) fn of(name: &str, model: &Model, placement: &Placement, said: &Georeference) -> ModelReference {
        let point = proposal(model, said);
        let (crs, convergence, by_anchor) = match &said.reference {
            Reference::Placement => (None, None, None),
            Reference::Map { crs, map_from_model, .. } => {
                let convergence = map_middle(model, *map_from_model).and_then(|at| crs.convergence_rad(at.x, at.y));
                (Some(&**crs), convergence, convergence.map(|convergence| -convergence))
            }
            Reference::Anchor(zero) => {
                let AnchoredZero { on_map, .. } = &**zero;
                let convergence = on_map.as_ref().and_then(|(crs, at)| crs.convergence_rad(at.x, at.y));
                (on_map.as_ref().map(|(crs, _)| crs), convergence, true_north(zero))
            }
        };
        let north_rad = placement.north_rad.or(by_anchor).unwrap_or_default();
        ModelReference {
            name: name.to_owned(),
            unit_m: placement.unit_m(model),
            unit_is_said: placement.scale.is_some() || model.unit_m.is_some(),
            up: placement.up.unwrap_or(model.up),
            up_is_said: placement.up.is_some() || model.up_is_said,
            crs: crs.map(|crs| crs.name().to_owned()),
            shift: crs.map(|crs| crs.shift().to_owned()),
            said_by: Some(said.said_by.clone()).filter(|by| !by.is_empty()),
            place: point.map(|point| point.at),
            has_height: point.is_some_and(|point| point.has_elevation),
            anchors: model.anchors.clone(),
            // −0 is 0
            north_deg: north_rad.to_degrees() + 0.0,
            convergence_deg: convergence.map(f64::to_degrees),
        }
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
    /// The place's elevation, where the site file says the place without one, and the model whose file says it.
    pub(super) elevation: Option<(usize, f64)>,
}

/// The frame around a place that the site file says. Where it says no elevation, that of the first model is, whose file says
/// one and that stands nearby: the models stand at 0, as those do whose files say none.
fn written_frame<'a>(table: &PlaceTable, models: impl Iterator<Item = SaidModel<'a>>) -> ModelsFrame {
    let Some((latitude_deg, longitude_deg)) = table.latitude.zip(table.longitude) else {
        return ModelsFrame::default();
    };
    let at = GeodeticPoint { latitude_deg, longitude_deg, height_m: table.elevation.unwrap_or_default() };
    let Some(local) = LocalFrame::around(at) else { return ModelsFrame::default() };
    let said = |(index, (_, model, placement, said)): (usize, SaidModel)| {
        let point = proposal(model, said).filter(|point| point.has_elevation && placement.position.is_none())?;
        let is_near = local.point(point.at).is_some_and(|there| there.truncate().length() <= FAR_M);
        is_near.then_some((index, point.at.height_m))
    };
    let elevation = if table.elevation.is_none() { models.enumerate().find_map(said) } else { None };
    let around = elevation.and_then(|(_, height_m)| LocalFrame::around(GeodeticPoint { height_m, ..at }));
    let has_elevation = table.elevation.is_some() || around.is_some();
    let frame = Some(SiteFrame { local: around.unwrap_or(local), has_elevation });
    ModelsFrame { frame, proposed: None, elevation }
}

/// That a model's file says the place's elevation, with the model for its subject.
pub(super) fn elevation_note(height_m: f64) -> Message {
    let key = set_to("[place]", "elevation", height_m.to_string(), "`elevation`".to_owned());
    message![
        format!("says the elevation of the place, {}, as nobody wrote one", metres(height_m));
        key, " in [place] changes it"
    ]
}

/// The place of the models: the site file's, else the first that a file proposes; one that is a program's own only where
/// there is no other.
pub(super) fn frame<'a>(written: &WrittenSite, models: impl Iterator<Item = SaidModel<'a>>) -> ModelsFrame {
    if let Some(table) = &written.site.place {
        return written_frame(table, models);
    }
    let mut proposed: Vec<(ProposedPoint, String, bool)> = Vec::new();
    for (name, model, _, said) in models {
        if let Some(point) = proposal(model, said) {
            let is_doubted = place_doubts::of(Some(point.at), &said.said_by).is_some();
            proposed.push((point, format!("{}, {}", file_name(name), said.said_by), is_doubted));
        }
    }
    let sure = proposed.iter().find(|(.., is_doubted)| !is_doubted).or(proposed.first());
    let Some((ProposedPoint { at, has_elevation }, said, _)) = sure else { return ModelsFrame::default() };
    // where the first says no elevation, another may
    let with_elevation =
        || proposed.iter().find(|(point, ..)| point.has_elevation).map(|(point, ..)| point.at.height_m);
    let elevation = has_elevation.then_some(at.height_m).or_else(with_elevation);
    let height_m = elevation.unwrap_or_default();
    let table = PlaceTable {
        latitude: Some(at.latitude_deg),
        longitude: Some(at.longitude_deg),
        elevation,
        source: Some(PlaceSource { said: said.clone(), at: [at.latitude_deg, at.longitude_deg] }),
        ..PlaceTable::default()
    };
    let local = LocalFrame::around(GeodeticPoint { height_m, ..*at });
    let frame = local.map(|local| SiteFrame { local, has_elevation: elevation.is_some() });
    ModelsFrame { frame, proposed: Some(table), elevation: None }
}

fn file_name(path: &str) -> &str {
    Path::new(path).file_name().and_then(|name| name.to_str()).unwrap_or(path)
}

impl WrittenSite {
    /// Whether it is a model without a site file.
    pub fn is_bare_model(&self) -> bool {
        self.text.is_empty() && !self.site.model.is_empty()
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
        let height = table.elevation.map(|height| format!(", {} above the sea", metres(height))).unwrap_or_default();
        Some(message![
            format!("place from {said}: {}{height}", degrees(at));
            setting("[place]", "latitude", "latitude"), ", ",
            setting("[place]", "longitude", "longitude"), " and ",
            setting("[place]", "elevation", "elevation in [place]"), " change it",
            Piece::Where(Field::Place, pieces![", or ", (Field::Place, "LAT,LON")])
        ])
    }

    /// A fault of a model's key.
    pub(super) fn model_fault(&self, index: usize, (key, fault): (&str, Message)) -> SiteError {
        refuse(self.model_key(index, key), fault)
    }
}

impl PlaceTable {
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
