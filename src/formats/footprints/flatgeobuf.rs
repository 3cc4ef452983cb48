//! Reads FlatGeobuf: a header, an index that is skipped, and features, each a FlatBuffer with its length before it.

use super::flatbuffer::{FlatTable, bytes_at};
use super::tags::FootprintTags;
use super::{Footprints, RingPolygon};
use crate::formats::crs::named_system;
use crate::formats::left_out::label;
use crate::formats::whole::whole_file;
use crate::formats::{Coordinates, Format, Model, ModelFault, ReadOptions};
use crate::message::{Message, message};
use glam::DVec3;
use std::path::Path;

/// The first bytes of version 3; the eighth byte is a patch number.
const MAGIC: &[u8] = b"fgb\x03fgb";

/// The bytes of a box in the index.
const NODE_BYTES: u64 = 40;

/// How deeply collections of geometries may be nested.
const MOST_DEEP: usize = 8;

/// FlatGeobuf, `.fgb`.
pub(in crate::formats) struct FlatGeobuf;

impl Format for FlatGeobuf {
    fn name(&self) -> &'static str {
        "FlatGeobuf"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["fgb"]
    }

    fn keys(&self) -> &'static [&'static str] {
        &["default_height"]
    }

    fn begins(&self, head: &[u8]) -> bool {
        head.starts_with(MAGIC)
    }

    fn read(&self, path: &Path, options: &ReadOptions) -> Result<Model, ModelFault> {
        let bytes = whole_file(path)?;
        let mut footprints = Footprints::default();
        let coordinates = read(&bytes, &mut footprints)?;
        footprints.finish(coordinates, options.default_height_m)
    }
}

fn cut_off() -> Message {
    message!["is cut off or damaged"; "copy or export it again"]
}

/// A column of attributes.
struct AttributeColumn {
    name: String,
    kind: u8,
    is_wanted: bool,
}

fn read(bytes: &[u8], footprints: &mut Footprints) -> Result<Coordinates, Message> {
    if !bytes.starts_with(MAGIC) {
        return Err(message!["is not FlatGeobuf 3"; "export it as FlatGeobuf again"]);
    }
    let (header, mut at) = sized(bytes, 8).ok_or_else(cut_off)?;
    let header = FlatTable::root(header).ok_or_else(cut_off)?;
    at = at.checked_add(index_bytes(&header).ok_or_else(cut_off)?).ok_or_else(cut_off)?;
    let columns = columns_in(&header, 7);
    footprints.layer = header.text(0).map(label);
    let kind = header.u8(2).unwrap_or(0);
    if at > bytes.len() {
        return Err(cut_off());
    }
    while at < bytes.len() {
        let (feature, next) = sized(bytes, at).ok_or_else(cut_off)?;
        at = next;
        let feature = FlatTable::root(feature).ok_or_else(cut_off)?;
        let own = columns_in(&feature, 2);
        let tags = tags_of(feature.bytes(1).unwrap_or_default(), if own.is_empty() { &columns } else { &own });
        let mut polygons = Vec::new();
        match feature.table(0) {
            Some(geometry) => polygons_of(&geometry, kind, MOST_DEEP, &mut polygons, footprints),
            None => footprints.tally.add("features", "no geometry"),
        }
        footprints.add(polygons, tags);
    }
    Ok(coordinates_of(&header))
}

/// A buffer with its length before it, and the offset after it.
fn sized(bytes: &[u8], at: usize) -> Option<(&[u8], usize)> {
    let first = at.checked_add(4)?;
    let end = first.checked_add(u32::from_le_bytes(bytes_at(bytes, at)?) as usize)?;
    Some((bytes.get(first..end)?, end))
}

/// The size of the index: a tree of boxes, with those of the features as leaves.
fn index_bytes(header: &FlatTable<'_>) -> Option<usize> {
    let features = header.u64(8).unwrap_or(0);
    let size = u64::from(header.u16(9).unwrap_or(16));
    if size == 0 || features == 0 {
        return Some(0);
    }
    let (mut level, mut nodes) = (features, features);
    while level > 1 {
        level = level.div_ceil(size.max(2));
        nodes = nodes.checked_add(level)?;
    }
    usize::try_from(nodes.checked_mul(NODE_BYTES)?).ok()
}

fn columns_in(table: &FlatTable<'_>, number: usize) -> Vec<AttributeColumn> {
    let column = |column: FlatTable<'_>| {
        let name = column.text(0).unwrap_or_default().to_owned();
        AttributeColumn { is_wanted: FootprintTags::wants(&name), name, kind: column.u8(1).unwrap_or(0) }
    };
    table.tables(number).map(column).collect()
}

/// Reads the attributes of a feature: pairs of a column index and a value.
fn tags_of(mut bytes: &[u8], columns: &[AttributeColumn]) -> FootprintTags {
    let mut tags = FootprintTags::default();
    while let Some((number, rest)) = bytes.split_first_chunk::<2>() {
        let Some(column) = columns.get(usize::from(u16::from_le_bytes(*number))) else { break };
        let Some((value, rest)) = value_of(column.kind, rest) else { break };
        bytes = rest;
        if column.is_wanted {
            tags.set(&column.name, &value);
        }
    }
    tags
}

/// A value as text, and the bytes after it.
fn value_of(kind: u8, bytes: &[u8]) -> Option<(String, &[u8])> {
    macro_rules! number {
        ($number:ty) => {{
            let (own, rest) = bytes.split_first_chunk::<{ size_of::<$number>() }>()?;
            (<$number>::from_le_bytes(*own).to_string(), rest)
        }};
    }
    Some(match kind {
        0 => number!(i8),
        1 => number!(u8),
        2 => {
            let (own, rest) = bytes.split_first()?;
            (if *own == 0 { "no" } else { "yes" }.to_owned(), rest)
        }
        3 => number!(i16),
        4 => number!(u16),
        5 => number!(i32),
        6 => number!(u32),
        7 => number!(i64),
        8 => number!(u64),
        9 => number!(f32),
        10 => number!(f64),
        // texts, JSON, times and bytes
        11..=14 => {
            let (own, end) = sized(bytes, 0)?;
            (String::from_utf8_lossy(own).into_owned(), bytes.get(end..)?)
        }
        _ => return None,
    })
}

/// Adds the polygons of a geometry, and counts everything else in it.
fn polygons_of(
    geometry: &FlatTable<'_>,
    kind: u8,
    deep: usize,
    polygons: &mut Vec<RingPolygon>,
    footprints: &mut Footprints,
) {
    let kind = geometry.u8(6).filter(|&own| own > 0).unwrap_or(kind);
    match kind {
        // Polygon, Triangle
        3 | 17 => polygons.extend(polygon_of(geometry)),
        // MultiPolygon, whose parts may omit their type
        6 if deep > 0 => geometry.tables(7).for_each(|part| polygons_of(&part, 3, deep - 1, polygons, footprints)),
        7 if deep > 0 => geometry.tables(7).for_each(|part| polygons_of(&part, 0, deep - 1, polygons, footprints)),
        1 | 4 => footprints.tally.add("Point", super::NO_AREA),
        2 | 5 => footprints.tally.add("LineString", super::NO_AREA),
        _ => footprints.tally.add("geometries", "neither polygons nor made of polygons"),
    }
}

fn polygon_of(geometry: &FlatTable<'_>) -> Option<RingPolygon> {
    let flat: Vec<f64> = geometry.f64s(1)?.collect();
    let mut heights = geometry.f64s(2).into_iter().flatten();
    let points = flat.chunks_exact(2).map(|xy| DVec3::new(xy[0], xy[1], heights.next().unwrap_or(0.0)));
    let points: Vec<DVec3> = points.collect();
    let mut ends: Vec<usize> = geometry.u32s(0).into_iter().flatten().collect();
    if ends.is_empty() {
        ends.push(points.len());
    }
    let is_sorted = ends.is_sorted() && ends.last() == Some(&points.len());
    is_sorted.then_some(RingPolygon { points, ends })
}

fn coordinates_of(header: &FlatTable<'_>) -> Coordinates {
    let Some(crs) = header.table(10) else { return Coordinates::Local };
    if let Some(code) = crs.i32(1).filter(|&code| code > 0) {
        let authority = crs.text(0).filter(|authority| !authority.is_empty()).unwrap_or("EPSG");
        return Coordinates::Map(format!("{}:{code}", authority.to_uppercase()));
    }
    let texts = [crs.text(5), crs.text(4), crs.text(2)];
    let text = texts.into_iter().flatten().find(|text| !text.is_empty());
    match text.and_then(named_system) {
        // WKT stays as text: its parts have codes of their own
        Some(_) if text.is_some_and(|text| text.contains('[')) => Coordinates::Map(text.unwrap_or_default().to_owned()),
        Some(system) => Coordinates::Map(system.crs),
        None => Coordinates::Local,
    }
}
