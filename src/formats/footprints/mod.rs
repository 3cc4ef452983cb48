//! Outlines of buildings with their heights → blocks with flat roofs: GeoJSON, FlatGeobuf and shapefiles.
//!
//! Outlines keep the coordinates of their file, be they degrees or those of a map: only what does not depend on them is
//! found here, and `site` brings every corner to its place. The files of this folder, in the order of the flow: `geojson`,
//! `flatgeobuf` with `flatbuffer`, `shapefile` with `dbase` (bytes → outlines), `tags` (what is said of an outline, and
//! lengths as people write them), `overlap` (which outlines their parts replace), `extrude` (outlines → blocks).

use super::rings::FaceCutter;
use super::tally::{LeftOutTally, counted, label};
use super::{Coordinates, MAX_TRIANGLES, Model, ModelFault, Up};
use crate::mesh::Part;
use crate::message::{Field, Message, message};
use extrude::FootprintOutline;
pub(super) use flatgeobuf::FlatGeobuf;
pub(super) use geojson::GeoJson;
use glam::DVec3;
pub(super) use shapefile::Shapefile;
use tags::{FootprintTags, HeightSource};

mod dbase;
mod extrude;
mod flatbuffer;
mod flatgeobuf;
mod geojson;
mod overlap;
mod shapefile;
mod tags;

/// Why what is no polygon is left out.
const NO_AREA: &str = "they are no polygons";

/// A polygon as a file has it: its rings follow each other, the outer one first.
#[derive(Clone, Debug, Default)]
struct RingPolygon {
    points: Vec<DVec3>,
    ends: Vec<usize>,
}

/// One feature: a building, a part of one, or something else.
struct Footprint {
    polygons: Vec<RingPolygon>,
    tags: FootprintTags,
    /// From 1, in the file.
    number: u64,
}

/// Collects the features of a file.
#[derive(Default)]
struct Footprints {
    features: Vec<Footprint>,
    /// What stands there as the file has it, without being extruded.
    bodies: Vec<Part>,
    tally: LeftOutTally,
    notes: Vec<Message>,
    /// Of the layer, where the file names it.
    layer: Option<String>,
    number: u64,
}

impl Footprints {
    /// One more feature, with the polygons that it has.
    fn add(&mut self, polygons: Vec<RingPolygon>, tags: FootprintTags) {
        self.number += 1;
        if !polygons.is_empty() {
            self.features.push(Footprint { polygons, tags, number: self.number });
        }
    }

    /// The smallest and largest coordinates of all outlines and bodies.
    fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let points = self.features.iter().flat_map(|feature| &feature.polygons).flat_map(|polygon| &polygon.points);
        let points = points.chain(self.bodies.iter().flat_map(|body| &body.positions));
        points.filter(|point| point.is_finite()).fold(None, |bounds, &point| {
            let (low, high) = bounds.unwrap_or((point, point));
            Some((low.min(point), high.max(point)))
        })
    }

    /// Whether all coordinates may be degrees.
    fn may_be_degrees(&self) -> bool {
        self.bounds().is_none_or(|(low, high)| low.x >= -180.0 && high.x <= 180.0 && low.y >= -90.0 && high.y <= 90.0)
    }

    /// The buildings as blocks. Metres and z up in heights; in plan what `coordinates` say.
    fn finish(mut self, coordinates: Coordinates, default_height_m: Option<f64>) -> Result<Model, ModelFault> {
        let features = std::mem::take(&mut self.features);
        let buildings = self.buildings(features);
        let mut cutter = FaceCutter::new();
        let mut outlines = self.outlines(buildings, &mut cutter, default_height_m)?;
        let replaced = overlap::replaced_by_parts(&outlines);
        let why = "their parts stand instead";
        self.tally.add_many("outlines", why, replaced.whole.len() as u64);
        if replaced.partly > 0 {
            self.notes.push(message![format!(
                "has {} that building:part covers only in part: both stand there, the outline with its own height",
                counted(replaced.partly as u64, "outline")
            )]);
        }
        let mut at = 0;
        outlines.retain(|_| {
            at += 1;
            !replaced.whole.contains(&(at - 1))
        });
        let mut parts = std::mem::take(&mut self.bodies);
        parts.extend(outlines.iter().map(|outline| outline.part(self.layer.as_deref())));
        if parts.is_empty() {
            let left_out = self.tally.into_left_out();
            let left_out = left_out.iter().map(|one| format!("{} {}: {}", one.count, one.what, one.why)).collect();
            let what = format!("has no footprints of buildings ({})", crate::message::few(left_out));
            return Err(message![what; "export a layer of polygons with heights"].into());
        }
        Ok(Model {
            parts,
            up: Up::Z,
            up_is_said: true,
            unit_m: Some(1.0),
            coordinates,
            left_out: self.tally.into_left_out(),
            notes: self.notes,
            ..Model::default()
        })
    }

    /// The features that are buildings. Where some of a file are said to be, what is not, and has no height, is a road, a
    /// park or a lake.
    fn buildings(&mut self, features: Vec<Footprint>) -> Vec<Footprint> {
        let is_told = features.iter().any(|feature| feature.tags.is_building() || feature.tags.is_part());
        features
            .into_iter()
            .filter(|feature| {
                let tags = &feature.tags;
                let why = if tags.is_underground() {
                    Some("they lie underground")
                } else if tags.is_no_building() {
                    Some("they are said to be no buildings")
                } else if is_told && !tags.is_building() && !tags.is_part() && tags.height_m().is_none() {
                    Some("they are no buildings and have no height")
                } else {
                    None
                };
                why.into_iter().for_each(|why| self.tally.add("features", why));
                why.is_none()
            })
            .collect()
    }

    /// Those with a height and an area, cut into triangles.
    fn outlines(
        &mut self,
        buildings: Vec<Footprint>,
        cutter: &mut FaceCutter,
        default_height_m: Option<f64>,
    ) -> Result<Vec<FootprintOutline>, ModelFault> {
        let (mut outlines, mut triangles) = (Vec::new(), 0_u64);
        let (mut without, mut unread, mut crossing) = (0_u64, 0_u64, 0_u64);
        let (mut by_levels, mut by_default) = (0_u64, 0_u64);
        let all = buildings.len();
        for building in buildings {
            unread += u64::from(building.tags.has_unread_height());
            // a part of a guessed height would replace an outline whose height is known
            let is_part = building.tags.is_part();
            let Some(rise) = building.tags.rise(default_height_m.filter(|_| !is_part)) else {
                if is_part {
                    self.tally.add("building:part", "no height of theirs is said, and their outline stands instead");
                } else {
                    without += 1;
                }
                continue;
            };
            if rise.bottom_m >= rise.top_m {
                self.tally.add("footprints", "they begin no lower than they end");
                continue;
            }
            let outline = FootprintOutline::cut(building, rise, cutter, &mut self.tally);
            if outline.is_empty() {
                continue;
            }
            by_levels += u64::from(rise.from == HeightSource::Levels || rise.bottom_is_guessed);
            by_default += u64::from(rise.from == HeightSource::Default);
            crossing += u64::from(outline.crosses);
            triangles += outline.triangle_count();
            if triangles > MAX_TRIANGLES {
                let what = format!("has more than {MAX_TRIANGLES} triangles, which is the most that a model may have");
                return Err(message![what; "export a smaller region"].into());
            }
            outlines.push(outline);
        }
        if without > 0 && without == all as u64 && self.bodies.is_empty() {
            return Err(
                message![format!("has {}, and says the height of none of them", counted(without, "footprint"));
                "set ", Field::DefaultHeight, ", or export them with their heights in metres as \"height\""]
                .into(),
            );
        }
        self.tally.add_many("footprints", "no height of theirs is said", without);
        self.note_heights(
            without,
            unread,
            by_levels,
            default_height_m.filter(|_| by_default > 0).map(|m| (by_default, m)),
        );
        if crossing > 0 {
            self.notes.push(message![format!(
                "has {} whose outlines cross themselves, so that their blocks may cover too much or too little",
                counted(crossing, "footprint")
            )]);
        }
        Ok(outlines)
    }

    /// Which heights are guessed, and which are missing.
    fn note_heights(&mut self, without: u64, unread: u64, by_levels: u64, by_default: Option<(u64, f64)>) {
        if by_levels > 0 {
            self.notes.push(message![format!(
                "says storeys and no height of {}: they are guessed to be {} m a storey",
                counted(by_levels, "footprint"),
                tags::STOREY_M
            ); "write their heights in metres as \"height\" where that matters"]);
        }
        if let Some((count, metres)) = by_default {
            self.notes.push(message![
                format!("says no height of {}: they are {metres} m high, as ", counted(count, "footprint")),
                Field::DefaultHeight,
                " says"
            ]);
        }
        if without > 0 {
            self.notes.push(message![format!("has {} without a height, left out", counted(without, "footprint"));
                "set ", Field::DefaultHeight, " for them"]);
        }
        if unread > 0 {
            self.notes.push(
                message![format!("has {} written otherwise than \"12 m\" or \"40'\" are", counted(unread, "height"));
                "write heights in metres"],
            );
        }
    }
}

/// What a feature is called, and by what else it may be meant.
fn names_of(tags: &FootprintTags, number: u64, layer: Option<&str>) -> (String, Vec<String>) {
    let kind = tags.kind().unwrap_or("footprint");
    let address = tags.address();
    let numbered = || format!("{kind} {}", tags.id.clone().unwrap_or_else(|| number.to_string()));
    let name = tags.name.clone().or_else(|| address.clone()).unwrap_or_else(numbered);
    let aliases =
        [tags.name.clone(), address, tags.id.clone(), tags.kind().map(str::to_owned), layer.map(str::to_owned)];
    let part = tags.is_part().then(|| "building:part".to_owned());
    let mut aliases: Vec<String> = aliases.into_iter().chain([part]).flatten().map(|name| label(&name)).collect();
    aliases.retain(|alias| !alias.is_empty());
    (label(&name), aliases)
}
