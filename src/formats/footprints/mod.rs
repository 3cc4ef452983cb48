//! Reads outlines of buildings with heights as blocks with flat roofs: GeoJSON, FlatGeobuf and shapefiles.
//!
//! Outlines keep the coordinates of their file, degrees or map coordinates; `site` converts every corner. The files of
//! this folder, in the order of the flow: `geojson`, `flatgeobuf` with `flatbuffer`, and `shapefile` with `dbase` read
//! outlines; `tags` reads their attributes, and lengths as people write them; `footprint` names them; `overlap` finds
//! outlines that their parts replace; `extrude` makes blocks. `outlines` reads the polygons of areas that are judged, which
//! are no buildings.

use super::face_cutter::FaceCutter;
use super::left_out::{LeftOutTally, counted, listed};
use super::{Coordinates, MAX_TRIANGLES, Model, ModelFault, Up};
use crate::crs::{Crs, CrsKind};
use crate::mesh::Part;
use crate::message::{Field, Message, MessagePart, few, message, pieces, setting};
use extrude::FootprintOutline;
pub(super) use flatgeobuf::FlatGeobuf;
use footprint::{Footprint, NO_AREA, RingPolygon, names_of};
pub(super) use geojson::GeoJson;
use glam::DVec3;
pub(crate) use outlines::{NamedOutline, OutlineFile, read_outlines};
pub(super) use shapefile::Shapefile;
use tags::{FootprintTags, HeightSource, Rise};

mod dbase;
mod extrude;
mod flatbuffer;
mod flatgeobuf;
mod footprint;
mod geojson;
mod outlines;
mod overlap;
mod shapefile;
mod tags;

/// Features in degrees, of which a ring lies on both sides of 180°, in degrees that go on there: all of them, so that parts
/// still lie in their outlines.
fn together(mut features: Vec<Footprint>, coordinates: &Coordinates) -> Vec<Footprint> {
    let Coordinates::Map(crs) = coordinates else { return features };
    let mut polygons = features.iter().flat_map(|feature| &feature.polygons);
    let is_cut = polygons.any(RingPolygon::crosses_180);
    if is_cut && Crs::read(crs).is_ok_and(|crs| crs.kind() == CrsKind::Geographic) {
        for polygon in features.iter_mut().flat_map(|feature| &mut feature.polygons) {
            *polygon = std::mem::take(polygon).eastward();
        }
    }
    features
}

/// The features of a file.
#[derive(Default)]
struct Footprints {
    features: Vec<Footprint>,
    /// Bodies that are used as they are, without extrusion.
    bodies: Vec<Part>,
    tally: LeftOutTally,
    notes: Vec<Message>,
    /// The layer's name, if the file has one.
    layer: Option<String>,
    number: u64,
}

impl Footprints {
    /// Adds a feature with its polygons.
    fn add(&mut self, polygons: Vec<RingPolygon>, tags: FootprintTags) {
        self.number += 1;
        if !polygons.is_empty() {
            self.features.push(Footprint { polygons, tags, number: self.number });
        }
    }

    /// The least and the greatest coordinates of all outlines and bodies.
    fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let points = self.features.iter().flat_map(|feature| &feature.polygons).flat_map(|polygon| &polygon.points);
        let points = points.chain(self.bodies.iter().flat_map(|body| &body.positions));
        points.filter(|point| point.is_finite()).fold(None, |bounds, &point| {
            let (low, high) = bounds.unwrap_or((point, point));
            Some((low.min(point), high.max(point)))
        })
    }

    /// Whether all coordinates are in the range of degrees.
    fn may_be_degrees(&self) -> bool {
        self.bounds().is_none_or(|(low, high)| low.x >= -180.0 && high.x <= 180.0 && low.y >= -90.0 && high.y <= 90.0)
    }

    /// Makes blocks of the buildings. Heights are metres with z up; in plan `coordinates` applies.
    fn finish(mut self, coordinates: Coordinates, default_height_m: Option<f64>) -> Result<Model, ModelFault> {
        let features = together(std::mem::take(&mut self.features), &coordinates);
        let buildings = self.buildings(features);
        let mut cutter = FaceCutter::new();
        let mut outlines = self.outlines(buildings, &mut cutter, default_height_m)?;
        let replaced = overlap::replaced_by_parts(&outlines);
        let why = "its parts are used instead";
        self.tally.add_many("outlines", why, replaced.whole.len() as u64);
        if replaced.partly > 0 {
            self.notes.push(message![format!(
                "has {} that building:part covers only in part: both are used, the outline with its own height",
                counted(replaced.partly as u64, "outline")
            )]);
        }
        let mut at = 0;
        outlines.retain(|_| {
            at += 1;
            !replaced.whole.contains(&(at - 1))
        });
        let mut parts = std::mem::take(&mut self.bodies);
        // features with heights of their own say nothing about the others
        let of_outlines = outlines.iter().map(FootprintOutline::is_at_zero);
        let from_ground: Vec<bool> = parts.iter().map(|_| false).chain(of_outlines).collect();
        parts.extend(outlines.iter().map(|outline| outline.part(self.layer.as_deref())));
        if parts.is_empty() {
            let what = format!("has no footprints of buildings ({})", listed(&self.tally.into_left_out()));
            return Err(message![what; "export a layer of polygons with heights"].into());
        }
        Ok(Model {
            parts,
            up: Up::Z,
            up_is_said: true,
            unit_m: Some(1.0),
            coordinates,
            from_ground: if from_ground.contains(&true) { from_ground } else { Vec::new() },
            left_out: self.tally.into_left_out(),
            notes: self.notes,
            ..Model::default()
        })
    }

    /// Selects buildings. If some features of a file are marked as buildings, those that are not and have no height are
    /// roads, parks or lakes.
    fn buildings(&mut self, features: Vec<Footprint>) -> Vec<Footprint> {
        let is_told = features.iter().any(|feature| feature.tags.is_building() || feature.tags.is_part());
        features
            .into_iter()
            .filter(|feature| {
                let tags = &feature.tags;
                let why = if tags.is_underground() {
                    Some("underground")
                } else if tags.is_no_building() {
                    Some("marked as not a building")
                } else if is_told && !tags.is_building() && !tags.is_part() && tags.height_m().is_none() {
                    Some("not marked as a building, and without a height")
                } else {
                    None
                };
                why.into_iter().for_each(|why| self.tally.add("features", why));
                why.is_none()
            })
            .collect()
    }

    /// The outlines that have a height and an area, cut into triangles.
    fn outlines(
        &mut self,
        buildings: Vec<Footprint>,
        cutter: &mut FaceCutter,
        default_height_m: Option<f64>,
    ) -> Result<Vec<FootprintOutline>, ModelFault> {
        let mut outlines = Vec::new();
        let mut told = HeightCounts::default();
        for building in buildings {
            let Some(rise) = self.rise_of(&building, default_height_m, &mut told) else { continue };
            let outline = FootprintOutline::cut(building, rise, cutter, &mut self.tally);
            if outline.is_empty() {
                continue;
            }
            let name = || outline.name(self.layer.as_deref());
            told.by_levels.add_if(rise.from == HeightSource::Levels || rise.bottom_is_guessed, name);
            told.by_default += u64::from(rise.from == HeightSource::Default);
            told.crossing.add_if(outline.crosses, name);
            told.triangles += outline.triangle_count();
            if told.triangles > MAX_TRIANGLES {
                let what = format!("has more than {MAX_TRIANGLES} triangles, which is the most that a model may have");
                return Err(message![what; "export a smaller region"].into());
            }
            outlines.push(outline);
        }
        if told.without.count > 0 && outlines.is_empty() && self.bodies.is_empty() {
            let what = format!("has {}, but no height of any of them", told.without.told("footprint"));
            let hint = " for this one, or export them with their heights in metres as \"height\"";
            return Err(message![what; "set ", for_all(), own_height(), hint].into());
        }
        self.tally.add_many("footprints", "they have no height", told.without.count);
        self.note(&told, default_height_m);
        Ok(outlines)
    }

    /// The vertical extent of a footprint; if there is none, that is counted.
    fn rise_of(
        &mut self,
        footprint: &Footprint,
        default_height_m: Option<f64>,
        told: &mut HeightCounts,
    ) -> Option<Rise> {
        let tags = &footprint.tags;
        let name = || names_of(tags, footprint.number, self.layer.as_deref()).0;
        told.unread.add_if(tags.has_unread_height(), name);
        told.unread_bottom.add_if(tags.has_unread_bottom(), name);
        // a part with a guessed height would replace an outline whose height is known
        let default_height_m = default_height_m.filter(|_| !tags.is_part());
        match tags.rise(default_height_m) {
            Some(rise) if rise.bottom_m < rise.top_m => return Some(rise),
            Some(_) => self.tally.add("footprints", "their bottom is not below their top"),
            None if tags.is_part() => {
                self.tally.add("building:part", "they have no height, and the outline is used instead");
            }
            None => told.without.add_if(true, name),
        }
        None
    }

    /// Adds notes on heights that are guessed or missing.
    fn note(&mut self, told: &HeightCounts, default_height_m: Option<f64>) {
        let HeightCounts { without, unread, unread_bottom, by_levels, by_default, crossing, .. } = told;
        if by_levels.count > 0 {
            let what = format!(
                "gives storeys but no height of {}: a storey is assumed to be {} m high",
                by_levels.told("footprint"),
                tags::STOREY_M
            );
            self.notes.push(message![what; "write heights in metres as \"height\" where that matters"]);
        }
        if let Some(metres) = default_height_m.filter(|_| *by_default > 0) {
            let (footprints, are) =
                (counted(*by_default, "footprint"), if *by_default == 1 { "it is" } else { "each is" });
            let what =
                format!("gives no height of {footprints}: {are} taken as {metres} m high, as requested for this model");
            self.notes.push(message![what]);
        }
        if without.count > 0 {
            let what = format!("has {} without a height, left out", without.told("footprint"));
            self.notes.push(message![what; "set ", for_all(), own_height(), " for this one"]);
        }
        if unread.count > 0 {
            let what = format!(
                "has {} written otherwise than \"12 m\" or \"40'\" are, or with a comma that may stand between thousands",
                unread.told("height")
            );
            self.notes.push(message![what; "write heights in metres, with a point, and storeys as one number"]);
        }
        self.notes.extend(unread_bottom_note(unread_bottom));
        if crossing.count > 0 {
            let what = match crossing.count {
                1 => "whose outline crosses itself, so that its block may cover too much or too little",
                _ => "whose outlines cross themselves, so that their blocks may cover too much or too little",
            };
            self.notes.push(message![format!("has {} {what}", crossing.told("footprint"))]);
        }
    }
}

/// A note if there are bottoms that cannot be read.
fn unread_bottom_note(unread: &NamedFootprints) -> Option<Message> {
    let stand = if unread.count == 1 { "its block stands" } else { "their blocks stand" };
    let what = format!(
        "has {} that cannot be read in min_height or building:min_level, so that {stand} on the ground",
        unread.told("bottom")
    );
    (unread.count > 0).then(|| message![what; "write them in metres above the ground, with a point"])
}

/// The field for the heights of all models, for faces that have it; of a model alone, it is what its own height is.
fn for_all() -> MessagePart {
    MessagePart::Where(Field::DefaultHeight, pieces![Field::DefaultHeight, " for all models, or "])
}

/// The key for the height of one model's footprints.
fn own_height() -> MessagePart {
    setting("[[model]]", "default_height", "`default_height` under [[model]]")
}

/// Footprints with something in common: their number, and the names of the first few.
#[derive(Default)]
struct NamedFootprints {
    count: u64,
    first: Vec<String>,
}

impl NamedFootprints {
    /// The most names in a note; the rest are counted.
    const NAMED: usize = 4;

    fn add_if(&mut self, is_one: bool, name: impl Fn() -> String) {
        if is_one {
            self.count += 1;
            self.first.extend((self.first.len() < Self::NAMED).then(name));
        }
    }

    /// How many there are, and the names.
    fn told(&self, thing: &str) -> String {
        let mut names = self.first.clone();
        match self.count.saturating_sub(names.len() as u64) {
            0 => {}
            more => names.push(format!("{more} more")),
        }
        let of = if thing == "footprint" { "" } else { "of " };
        format!("{} ({of}{})", counted(self.count, thing), few(names))
    }
}

/// The counts of the notes on heights and outlines.
#[derive(Default)]
struct HeightCounts {
    /// Without a height.
    without: NamedFootprints,
    /// With a height that cannot be read.
    unread: NamedFootprints,
    /// With a bottom that cannot be read.
    unread_bottom: NamedFootprints,
    /// With a height guessed from storeys.
    by_levels: NamedFootprints,
    /// With the height that the user gave for all.
    by_default: u64,
    /// With an outline that crosses itself.
    crossing: NamedFootprints,
    triangles: u64,
}
