//! Reads shapefiles: polygons with the attributes and the reference system in accompanying files, and MultiPatch
//! bodies.

use super::dbase::AttributeTable;
use super::flatbuffer::bytes_at;
use super::tags::FootprintTags;
use super::{Footprints, NO_AREA, RingPolygon, names_of};
use crate::formats::face_cutter::{FaceCutter, ring_area};
use crate::formats::whole::{sibling, sidecar, whole_file};
use crate::formats::{Coordinates, Format, Model, ModelFault, ReadOptions};
use crate::mesh::Part;
use crate::message::{Message, message};
use glam::{DVec2, DVec3};
use std::path::{Path, PathBuf};

/// The first bytes of a shapefile, and the size of its header.
const MAGIC: [u8; 4] = 9994_u32.to_be_bytes();
const HEADER_BYTES: usize = 100;

/// The most pairs of holes and outlines of a shape that are tested.
const MOST_PAIRS: usize = 1_000_000;

/// The longest description of a reference system that is read.
const MOST_PRJ_BYTES: usize = 64 * 1024;

/// Shapefiles, `.shp` with `.dbf` and `.prj`.
pub(in crate::formats) struct Shapefile;

impl Format for Shapefile {
    fn name(&self) -> &'static str {
        "Shapefile"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["shp"]
    }

    fn keys(&self) -> &'static [&'static str] {
        &["default_height"]
    }

    fn begins(&self, head: &[u8]) -> bool {
        // the index has the same header
        head.starts_with(&MAGIC) && head.get(28..32) == Some(&1000_u32.to_le_bytes())
    }

    fn read(&self, path: &Path, options: &ReadOptions) -> Result<Model, ModelFault> {
        let bytes = whole_file(path)?;
        let attributes = sidecar(path, "dbf")?;
        let mut footprints = Footprints::default();
        if let Some(stem) = path.file_stem().and_then(|stem| stem.to_str()) {
            footprints.layer = Some(crate::formats::left_out::label(stem));
        }
        let table = attributes.as_deref().and_then(AttributeTable::of);
        if attributes.is_some() && table.is_none() {
            let what = "has a .dbf beside it that is not a dBASE table, so no attributes are read";
            footprints.notes.push(message![what; "export it again"]);
        }
        read(&bytes, table.as_ref(), &mut footprints)?;
        let coordinates = coordinates_of(path, &mut footprints)?;
        footprints.finish(coordinates, options.default_height_m)
    }

    fn named_by(&self, path: &Path) -> Vec<PathBuf> {
        ["dbf", "prj", "cpg", "shx"].iter().filter_map(|ending| sibling(path, ending)).collect()
    }
}

fn cut_off() -> Message {
    message!["is cut off or damaged"; "copy or export it again, with all files that belong to it"]
}

fn read(bytes: &[u8], table: Option<&AttributeTable<'_>>, footprints: &mut Footprints) -> Result<(), Message> {
    let mut cutter = FaceCutter::new();
    let mut at = HEADER_BYTES;
    let mut row = 0;
    while at < bytes.len() {
        let words = u32::from_be_bytes(bytes_at(bytes, at + 4).ok_or_else(cut_off)?) as usize;
        let first = at + 8;
        let end = words.checked_mul(2).and_then(|length| first.checked_add(length)).ok_or_else(cut_off)?;
        let record = bytes.get(first..end).ok_or_else(cut_off)?;
        let tags = table.and_then(|table| table.row(row)).unwrap_or_default();
        add(record, tags, &mut cutter, footprints)?;
        row += 1;
        at = end;
    }
    Ok(())
}

fn add(
    record: &[u8],
    tags: FootprintTags,
    cutter: &mut FaceCutter,
    footprints: &mut Footprints,
) -> Result<(), Message> {
    let kind = u32::from_le_bytes(bytes_at(record, 0).ok_or_else(cut_off)?);
    let mut polygons = Vec::new();
    match kind {
        5 | 15 | 25 => {
            let shape = ShapeRings::of(record, kind == 15, false).ok_or_else(cut_off)?;
            polygons = shape.polygons(&mut footprints.tally);
        }
        31 => {
            let shape = ShapeRings::of(record, true, true).ok_or_else(cut_off)?;
            footprints.add(Vec::new(), FootprintTags::default());
            let (name, aliases) = names_of(&tags, footprints.number, footprints.layer.as_deref());
            let part = shape.body(Part { name, aliases, ..Part::default() }, cutter, footprints);
            footprints.bodies.extend((!part.triangles.is_empty()).then_some(part));
            return Ok(());
        }
        0 => footprints.tally.add("features", "no geometry"),
        1 | 8 | 11 | 18 | 21 | 28 => footprints.tally.add("Point", NO_AREA),
        3 | 13 | 23 => footprints.tally.add("PolyLine", NO_AREA),
        _ => footprints.tally.add("shapes", "their type is unknown"),
    }
    footprints.add(polygons, tags);
    Ok(())
}

/// The rings of a shape, or its other parts.
struct ShapeRings {
    points: Vec<DVec3>,
    /// The range of points of each part.
    parts: Vec<std::ops::Range<usize>>,
    /// The kind of each part of a MultiPatch.
    kinds: Vec<u32>,
}

impl ShapeRings {
    /// Reads the parts of a record; `None` if it is shorter than its counts require.
    fn of(record: &[u8], has_z: bool, has_kinds: bool) -> Option<Self> {
        let count = |at: usize| bytes_at(record, at).map(|bytes| u32::from_le_bytes(bytes) as usize);
        let (parts, points) = (count(36)?, count(40)?);
        let numbers = |at: usize, many: usize| record.get(at..at.checked_add(many.checked_mul(4)?)?);
        let firsts = numbers(44, parts)?;
        let mut at = 44 + firsts.len();
        let kinds = if has_kinds { numbers(at, parts)? } else { &[] };
        at += kinds.len();
        let flat = record.get(at..at.checked_add(points.checked_mul(16)?)?)?;
        at += flat.len();
        // the range of heights comes first
        let heights = if has_z { record.get(at + 16..(at + 16).checked_add(points.checked_mul(8)?)?)? } else { &[] };
        let number = |bytes: &[u8]| bytes_at(bytes, 0).map_or(f64::NAN, f64::from_le_bytes);
        let mut heights = heights.chunks_exact(8).map(number);
        let points = flat.chunks_exact(16).map(|xy| {
            DVec3::new(number(&xy[..8]), number(&xy[8..]), if has_z { heights.next().unwrap_or(f64::NAN) } else { 0.0 })
        });
        let points: Vec<DVec3> = points.collect();
        let whole = |bytes: &[u8]| bytes_at(bytes, 0).map_or(u32::MAX, u32::from_le_bytes);
        let mut ends: Vec<usize> = firsts.chunks_exact(4).map(|bytes| whole(bytes) as usize).collect();
        ends.push(points.len());
        let are_in_order = ends.is_sorted();
        let parts = ends.windows(2).map(|pair| pair[0]..pair[1]).collect();
        are_in_order.then(|| Self { points, parts, kinds: kinds.chunks_exact(4).map(whole).collect() })
    }

    fn ring(&self, part: usize) -> &[DVec3] {
        self.parts.get(part).and_then(|part| self.points.get(part.clone())).unwrap_or_default()
    }

    /// The polygons: outlines are clockwise, holes counter-clockwise.
    fn polygons(&self, tally: &mut crate::formats::left_out::LeftOutTally) -> Vec<RingPolygon> {
        let flat = |ring: &[DVec3]| ring.iter().map(|point| [point.x, point.y]).collect::<Vec<_>>();
        let areas: Vec<f64> = (0..self.parts.len()).map(|part| ring_area(&flat(self.ring(part)))).collect();
        // some programs write them the other way round: the ring with the largest area is not a hole
        let largest = areas.iter().copied().reduce(|a, b| if b.abs() > a.abs() { b } else { a }).unwrap_or(0.0);
        let is_outer = |area: f64| area != 0.0 && (area < 0.0) == (largest < 0.0);
        let outer: Vec<usize> = (0..areas.len()).filter(|&part| is_outer(areas[part])).collect();
        let mut polygons: Vec<RingPolygon> =
            outer.iter().map(|&part| RingPolygon::from_ring(self.ring(part))).collect();
        let holes: Vec<usize> = (0..areas.len()).filter(|&part| areas[part] != 0.0 && !is_outer(areas[part])).collect();
        tally.add_many("rings", "no area", (areas.len() - outer.len() - holes.len()) as u64);
        let is_tried = outer.len() > 1 && outer.len().saturating_mul(holes.len()) <= MOST_PAIRS;
        for hole in holes {
            let ring = self.ring(hole);
            let before = outer.partition_point(|&part| part < hole).saturating_sub(1);
            let inside = |&at: &usize| ring.first().is_some_and(|&point| holds(self.ring(outer[at]), point));
            let around = if is_tried { (0..outer.len()).find(inside) } else { None };
            if let Some(polygon) = polygons.get_mut(around.unwrap_or(before)) {
                polygon.points.extend_from_slice(ring);
                polygon.ends.push(polygon.points.len());
            }
        }
        polygons
    }

    /// The body of a MultiPatch: strips, fans and rings.
    fn body(&self, mut part: Part, cutter: &mut FaceCutter, footprints: &mut Footprints) -> Part {
        let mut at = 0;
        while at < self.parts.len() {
            let ring = self.ring(at);
            let kind = self.kinds.get(at).copied().unwrap_or(u32::MAX);
            at += 1;
            let first = u32::try_from(part.positions.len()).unwrap_or(u32::MAX);
            let triangle = |corners: [usize; 3]| corners.map(|corner| first.saturating_add(corner as u32));
            if !ring.iter().all(|point| point.is_finite()) {
                footprints.tally.add("patches", "a coordinate is not a number");
                continue;
            }
            match kind {
                0 | 1 => {
                    part.positions.extend_from_slice(ring);
                    let many = ring.len().saturating_sub(2);
                    part.triangles.extend((0..many).map(|n| match (kind, n % 2) {
                        (0, 0) => triangle([n, n + 1, n + 2]),
                        (0, _) => triangle([n + 1, n, n + 2]),
                        _ => triangle([0, n + 1, n + 2]),
                    }));
                }
                // an outer ring with inner rings after it, or a first ring with rings of unknown kind
                2..=5 => {
                    let mut polygon = RingPolygon::from_ring(ring);
                    let holes = if kind == 2 { 3 } else { 5 };
                    while matches!(kind, 2 | 4) && self.kinds.get(at) == Some(&holes) {
                        polygon.points.extend_from_slice(self.ring(at));
                        polygon.ends.push(polygon.points.len());
                        at += 1;
                    }
                    match cutter.cut(&polygon.points, &polygon.ends) {
                        Ok(cut) => {
                            part.positions.extend_from_slice(&polygon.points);
                            let cut = cut.triangles.iter();
                            part.triangles.extend(cut.map(|corners| triangle(corners.map(|corner| corner as usize))));
                        }
                        Err(uncut) => footprints.tally.add("patches", uncut.why()),
                    }
                }
                _ => footprints.tally.add("patches", "their type is unknown"),
            }
        }
        part
    }
}

impl RingPolygon {
    fn from_ring(ring: &[DVec3]) -> Self {
        RingPolygon { points: ring.to_vec(), ends: vec![ring.len()] }
    }
}

/// Whether a point lies in a ring, in plan.
fn holds(ring: &[DVec3], point: DVec3) -> bool {
    let crosses = |pair: &[DVec3]| {
        let (a, b): (DVec2, DVec2) = (pair[0].truncate(), pair[1].truncate());
        (a.y > point.y) != (b.y > point.y) && point.x < a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x)
    };
    // a ring of a shapefile ends at its first point
    ring.windows(2).filter(|pair| crosses(pair)).count() % 2 == 1
}

/// Reads the reference system in the accompanying `.prj`.
fn coordinates_of(path: &Path, footprints: &mut Footprints) -> Result<Coordinates, ModelFault> {
    let bytes = sidecar(path, "prj")?.unwrap_or_default();
    let text = String::from_utf8_lossy(crate::formats::whole::without_mark(&bytes));
    if !text.trim().is_empty() && bytes.len() <= MOST_PRJ_BYTES {
        return Ok(Coordinates::Map(text.trim().to_owned()));
    }
    let what = if footprints.may_be_degrees() {
        "has no .prj beside it, so its coordinates are taken as metres, but they may be degrees"
    } else {
        "has no .prj beside it, so its coordinates are taken as metres"
    };
    footprints.notes.push(message![what; "copy all files of the shapefile, or name its reference system as crs"]);
    Ok(Coordinates::Local)
}
