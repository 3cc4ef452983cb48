//! GeoJSON: one document, or several in sequence.

use super::tags::FootprintTags;
use super::{Footprints, NO_AREA, RingPolygon};
use crate::formats::crs::named_system;
use crate::formats::left_out::label;
use crate::formats::whole::{whole_file, without_mark};
use crate::formats::{Coordinates, Format, Model, ModelFault, ReadOptions, json_head};
use crate::message::{Message, message};
use glam::DVec3;
use serde::de::{Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, de};
use serde_json::Value;
use std::borrow::Cow;
use std::fmt;
use std::path::Path;

/// Types of GeoJSON's objects by which a file is known.
const KINDS: [&str; 5] = ["FeatureCollection", "Feature", "GeometryCollection", "Polygon", "MultiPolygon"];

/// GeoJSON, `.geojson` and `.json`.
pub(in crate::formats) struct GeoJson;

impl Format for GeoJson {
    fn name(&self) -> &'static str {
        "GeoJSON"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["geojson", "json", "geojsonl"]
    }

    fn keys(&self) -> &'static [&'static str] {
        &["default_height"]
    }

    fn begins(&self, head: &[u8]) -> bool {
        json_head::has_member(head, "type", |kind| KINDS.contains(&kind))
            && ["features", "coordinates", "geometry", "geometries"].iter().any(|key| json_head::has_key(head, key))
    }

    fn read(&self, path: &Path, options: &ReadOptions) -> Result<Model, ModelFault> {
        let bytes = whole_file(path)?;
        let mut footprints = Footprints::default();
        let crs = read(without_mark(&bytes), &mut footprints)?;
        let coordinates = coordinates_of(crs.as_ref(), &mut footprints);
        footprints.finish(coordinates, options.default_height_m)
    }
}

/// An object of GeoJSON, whatever it is: a collection, a feature or a geometry.
#[derive(Deserialize)]
struct GeoObject {
    #[serde(rename = "type", default)]
    kind: Option<String>,
    #[serde(default)]
    features: Option<Vec<GeoObject>>,
    #[serde(default)]
    geometry: Option<Box<GeoObject>>,
    #[serde(default)]
    geometries: Option<Vec<GeoObject>>,
    #[serde(default)]
    coordinates: Option<Positions>,
    #[serde(default)]
    properties: Option<FootprintTags>,
    #[serde(default)]
    id: Option<Value>,
    /// Of a layer; GDAL writes it.
    #[serde(default)]
    name: Option<Value>,
    #[serde(default)]
    crs: Option<Value>,
}

/// Positions in lists of lists.
enum Positions {
    Point(DVec3),
    Lists(Vec<Positions>),
}

/// Reads all objects, and gives the reference system that the first of them names.
pub(super) fn read(bytes: &[u8], footprints: &mut Footprints) -> Result<Option<Value>, Message> {
    let mut crs = None;
    let objects = serde_json::Deserializer::from_slice(bytes).into_iter::<GeoObject>();
    for object in objects {
        let mut object = object.map_err(|error| match error.classify() {
            serde_json::error::Category::Eof => message![format!("is cut off ({error})"); "export it again"],
            _ => message![format!("is not JSON as GeoJSON has it ({error})"); "export it again"],
        })?;
        crs = crs.or(object.crs.take());
        if let Some(Value::String(name)) = object.name.take() {
            footprints.layer.get_or_insert_with(|| label(&name));
        }
        match object.features.take() {
            Some(features) => features.into_iter().for_each(|feature| add(feature, footprints)),
            None => add(object, footprints),
        }
    }
    Ok(crs)
}

/// Adds a feature, or a geometry that is one without properties.
fn add(feature: GeoObject, footprints: &mut Footprints) {
    let mut tags = feature.properties.unwrap_or_default();
    match feature.id {
        Some(Value::String(id)) => tags.set("id", &id),
        Some(Value::Number(id)) => tags.set("id", &id.to_string()),
        _ => {}
    }
    let mut polygons = Vec::new();
    let is_feature = feature.kind.as_deref() == Some("Feature");
    match feature.geometry {
        Some(geometry) => polygons_of(*geometry, &mut polygons, footprints),
        None if is_feature => footprints.tally.add("features", "no geometry"),
        None => polygons_of(
            GeoObject {
                kind: feature.kind,
                coordinates: feature.coordinates,
                geometries: feature.geometries,
                features: None,
                geometry: None,
                properties: None,
                id: None,
                name: None,
                crs: None,
            },
            &mut polygons,
            footprints,
        ),
    }
    footprints.add(polygons, tags);
}

/// The polygons of a geometry. The JSON's own depth is bounded, and so is this.
fn polygons_of(geometry: GeoObject, polygons: &mut Vec<RingPolygon>, footprints: &mut Footprints) {
    let kind = geometry.kind.as_deref().unwrap_or_default();
    let lists = match geometry.coordinates {
        Some(Positions::Lists(lists)) => lists,
        _ => Vec::new(),
    };
    match kind {
        "Polygon" => add_polygon(lists, polygons, footprints),
        "MultiPolygon" => lists.into_iter().for_each(|polygon| match polygon {
            Positions::Lists(rings) => add_polygon(rings, polygons, footprints),
            Positions::Point(_) => footprints.tally.add("polygons", "rings that are no lists of positions"),
        }),
        "GeometryCollection" => {
            let all = geometry.geometries.into_iter().flatten();
            all.for_each(|geometry| polygons_of(geometry, polygons, footprints));
        }
        other => footprints.tally.add(other, NO_AREA),
    }
}

fn add_polygon(rings: Vec<Positions>, polygons: &mut Vec<RingPolygon>, footprints: &mut Footprints) {
    let mut polygon = RingPolygon::default();
    for ring in rings {
        let points = match ring {
            Positions::Lists(points) => points,
            Positions::Point(_) => Vec::new(),
        };
        for point in points {
            let Positions::Point(point) = point else {
                footprints.tally.add("polygons", "rings that are no lists of positions");
                return;
            };
            polygon.points.push(point);
        }
        polygon.ends.push(polygon.points.len());
    }
    polygons.push(polygon);
}

/// What the coordinates are: longitudes and latitudes, unless an older `crs` member says otherwise.
pub(super) fn coordinates_of(crs: Option<&Value>, footprints: &mut Footprints) -> Coordinates {
    let name = crs.and_then(|crs| crs.get("properties")?.get("name")?.as_str());
    if let Some(system) = name.and_then(named_system) {
        // the easting or longitude is first, whatever the name would have elsewhere
        return Coordinates::Map(system.crs);
    }
    if footprints.may_be_degrees() {
        return Coordinates::Map("EPSG:4326".into());
    }
    footprints.notes.push(message!["has coordinates that are no longitudes and latitudes, and does not say of which map they are: they are taken as metres";
        "name their reference system as crs, or export GeoJSON in WGS 84"]);
    Coordinates::Local
}

impl<'de> Deserialize<'de> for FootprintTags {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_any(TagsVisitor)
    }
}

struct TagsVisitor;

/// A key, borrowed where it has no escapes.
#[derive(Deserialize)]
struct TagKey<'a>(#[serde(borrow)] Cow<'a, str>);

impl<'de> Visitor<'de> for TagsVisitor {
    type Value = FootprintTags;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("properties")
    }

    fn visit_unit<E: de::Error>(self) -> Result<FootprintTags, E> {
        Ok(FootprintTags::default())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<FootprintTags, A::Error> {
        let mut tags = FootprintTags::default();
        while let Some(TagKey(key)) = map.next_key()? {
            if !FootprintTags::wants(&key) {
                map.next_value::<IgnoredAny>()?;
                continue;
            }
            match map.next_value::<Value>()? {
                Value::String(text) => tags.set(&key, &text),
                Value::Number(number) => tags.set(&key, &number.to_string()),
                Value::Bool(is) => tags.set(&key, if is { "yes" } else { "no" }),
                _ => {}
            }
        }
        Ok(tags)
    }
}

/// What begins a list of positions.
enum FirstPosition {
    Number(f64),
    List(Positions),
}

impl<'de> Deserialize<'de> for FirstPosition {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_any(FirstPositionVisitor)
    }
}

struct FirstPositionVisitor;

impl<'de> Visitor<'de> for FirstPositionVisitor {
    type Value = FirstPosition;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a coordinate or a list of positions")
    }

    fn visit_f64<E: de::Error>(self, number: f64) -> Result<FirstPosition, E> {
        Ok(FirstPosition::Number(number))
    }

    fn visit_u64<E: de::Error>(self, number: u64) -> Result<FirstPosition, E> {
        Ok(FirstPosition::Number(number as f64))
    }

    fn visit_i64<E: de::Error>(self, number: i64) -> Result<FirstPosition, E> {
        Ok(FirstPosition::Number(number as f64))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<FirstPosition, A::Error> {
        PositionsVisitor.visit_seq(list).map(FirstPosition::List)
    }
}

impl<'de> Deserialize<'de> for Positions {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_seq(PositionsVisitor)
    }
}

struct PositionsVisitor;

impl<'de> Visitor<'de> for PositionsVisitor {
    type Value = Positions;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("positions")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Positions, A::Error> {
        Ok(match list.next_element()? {
            None => Positions::Lists(Vec::new()),
            Some(FirstPosition::Number(x)) => {
                let y = list.next_element()?.ok_or_else(|| de::Error::custom("a position has one coordinate"))?;
                let z = list.next_element()?.unwrap_or(0.0);
                while list.next_element::<IgnoredAny>()?.is_some() {}
                Positions::Point(DVec3::new(x, y, z))
            }
            Some(FirstPosition::List(first)) => {
                let mut lists = vec![first];
                while let Some(next) = list.next_element()? {
                    lists.push(next);
                }
                Positions::Lists(lists)
            }
        })
    }
}
