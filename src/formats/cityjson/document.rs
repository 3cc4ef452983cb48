//! Parses the JSON of CityJSON. Indices are not checked yet.

use serde::de::{Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, de};
use serde_json::Value;
use std::borrow::Cow;
use std::fmt;

/// A CityJSON file, or one line of a sequence.
#[derive(Deserialize)]
pub(super) struct CityDocument<'a> {
    /// `CityJSON` or `CityJSONFeature`.
    #[serde(rename = "type", borrow)]
    pub kind: Cow<'a, str>,
    #[serde(default, deserialize_with = "text")]
    pub version: Option<String>,
    pub transform: Option<VertexTransform>,
    #[serde(rename = "CityObjects", borrow, default)]
    pub objects: CityObjects<'a>,
    #[serde(default)]
    pub vertices: Vec<[f64; 3]>,
    #[serde(rename = "geometry-templates", default)]
    pub templates: Option<GeometryTemplates>,
    #[serde(default)]
    pub metadata: Option<CityMetadata>,
}

/// The transform from vertices to coordinates.
#[derive(Clone, Copy, Deserialize)]
pub(super) struct VertexTransform {
    pub scale: [f64; 3],
    pub translate: [f64; 3],
}

impl Default for VertexTransform {
    fn default() -> Self {
        Self { scale: [1.0; 3], translate: [0.0; 3] }
    }
}

#[derive(Deserialize)]
pub(super) struct CityMetadata {
    #[serde(rename = "referenceSystem", default, deserialize_with = "text")]
    pub reference_system: Option<String>,
}

/// The shapes that objects are instances of.
#[derive(Default, Deserialize)]
pub(super) struct GeometryTemplates {
    #[serde(default)]
    pub templates: Vec<CityGeometry>,
    #[serde(rename = "vertices-templates", default)]
    pub vertices: Vec<[f64; 3]>,
}

/// In file order, each with its id.
#[derive(Default)]
pub(super) struct CityObjects<'a>(pub Vec<(Cow<'a, str>, CityObject<'a>)>);

#[derive(Deserialize)]
pub(super) struct CityObject<'a> {
    #[serde(rename = "type", borrow)]
    pub kind: Cow<'a, str>,
    #[serde(default)]
    pub geometry: Option<Vec<CityGeometry>>,
    #[serde(default)]
    pub parents: Option<Vec<String>>,
    #[serde(default)]
    pub attributes: Option<ObjectAttributes>,
}

/// An object's usual name.
#[derive(Default, Deserialize)]
#[serde(default)]
pub(super) struct ObjectAttributes {
    #[serde(deserialize_with = "text")]
    pub name: Option<String>,
}

#[derive(Deserialize)]
pub(super) struct CityGeometry {
    #[serde(rename = "type")]
    pub kind: String,
    #[serde(default, deserialize_with = "text")]
    pub lod: Option<String>,
    #[serde(default)]
    pub boundaries: Boundaries,
    #[serde(default)]
    pub semantics: Option<FaceSemantics>,
    /// The template of an instance.
    pub template: Option<usize>,
    /// The matrix of an instance, row by row.
    #[serde(rename = "transformationMatrix")]
    pub matrix: Option<[f64; 16]>,
}

/// Vertices in nested lists: a ring, or something made of rings.
pub(super) enum Boundaries {
    Ring(Vec<u32>),
    Lists(Vec<Boundaries>),
}

impl Default for Boundaries {
    fn default() -> Self {
        Boundaries::Lists(Vec::new())
    }
}

#[derive(Deserialize)]
pub(super) struct FaceSemantics {
    #[serde(default)]
    pub surfaces: Vec<SemanticSurface>,
    #[serde(default)]
    pub values: SurfaceNumbers,
}

#[derive(Deserialize)]
pub(super) struct SemanticSurface {
    #[serde(rename = "type")]
    pub kind: String,
}

/// The surface of each face, in lists that are nested as the boundaries are.
#[derive(Default)]
pub(super) enum SurfaceNumbers {
    #[default]
    None,
    Number(usize),
    Lists(Vec<SurfaceNumbers>),
}

/// Text, or a number as text: levels of detail are written as either.
fn text<'de, D: Deserializer<'de>>(from: D) -> Result<Option<String>, D::Error> {
    Ok(match Value::deserialize(from)? {
        Value::String(text) => Some(text),
        Value::Number(number) => Some(number.to_string()),
        _ => None,
    })
}

impl<'de: 'a, 'a> Deserialize<'de> for CityObjects<'a> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_map(ObjectsVisitor)
    }
}

struct ObjectsVisitor;

impl<'de> Visitor<'de> for ObjectsVisitor {
    type Value = CityObjects<'de>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("city objects by their ids")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut objects = Vec::new();
        while let Some(Key(id)) = map.next_key()? {
            objects.push((id, map.next_value()?));
        }
        Ok(CityObjects(objects))
    }
}

/// A key, borrowed if it has no escapes.
#[derive(Deserialize)]
struct Key<'a>(#[serde(borrow)] Cow<'a, str>);

/// The first element of a list of boundaries.
enum FirstBoundary {
    Vertex(u32),
    List(Boundaries),
}

impl<'de> Deserialize<'de> for FirstBoundary {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_any(FirstBoundaryVisitor)
    }
}

struct FirstBoundaryVisitor;

impl<'de> Visitor<'de> for FirstBoundaryVisitor {
    type Value = FirstBoundary;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a vertex's number or a list of boundaries")
    }

    fn visit_u64<E: de::Error>(self, vertex: u64) -> Result<FirstBoundary, E> {
        u32::try_from(vertex).map(FirstBoundary::Vertex).map_err(|_| E::custom(format!("there is no vertex {vertex}")))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<FirstBoundary, A::Error> {
        BoundariesVisitor.visit_seq(list).map(FirstBoundary::List)
    }
}

impl<'de> Deserialize<'de> for Boundaries {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_seq(BoundariesVisitor)
    }
}

struct BoundariesVisitor;

impl<'de> Visitor<'de> for BoundariesVisitor {
    type Value = Boundaries;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list of boundaries")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Boundaries, A::Error> {
        Ok(match list.next_element()? {
            None => Boundaries::default(),
            Some(FirstBoundary::Vertex(first)) => {
                let mut ring = vec![first];
                while let Some(vertex) = list.next_element()? {
                    ring.push(vertex);
                }
                Boundaries::Ring(ring)
            }
            Some(FirstBoundary::List(first)) => {
                let mut lists = vec![first];
                while let Some(next) = list.next_element()? {
                    lists.push(next);
                }
                Boundaries::Lists(lists)
            }
        })
    }
}

impl<'de> Deserialize<'de> for SurfaceNumbers {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_any(SurfaceNumbersVisitor)
    }
}

struct SurfaceNumbersVisitor;

impl<'de> Visitor<'de> for SurfaceNumbersVisitor {
    type Value = SurfaceNumbers;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("numbers of surfaces, in lists")
    }

    fn visit_unit<E: de::Error>(self) -> Result<SurfaceNumbers, E> {
        Ok(SurfaceNumbers::None)
    }

    fn visit_u64<E: de::Error>(self, number: u64) -> Result<SurfaceNumbers, E> {
        Ok(usize::try_from(number).map_or(SurfaceNumbers::None, SurfaceNumbers::Number))
    }

    // −1 means none
    fn visit_i64<E: de::Error>(self, _: i64) -> Result<SurfaceNumbers, E> {
        Ok(SurfaceNumbers::None)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<SurfaceNumbers, A::Error> {
        let mut lists = Vec::new();
        while let Some(next) = list.next_element()? {
            lists.push(next);
        }
        Ok(SurfaceNumbers::Lists(lists))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<SurfaceNumbers, A::Error> {
        while map.next_entry::<IgnoredAny, IgnoredAny>()?.is_some() {}
        Ok(SurfaceNumbers::None)
    }
}
