//! The features of a city model: which feature a vertex belongs to, and the features' names. Read from `_BATCHID` with
//! the batch table of a tile, and from `EXT_mesh_features` with the property tables of `EXT_structural_metadata`.

use super::Fault;
use super::accessor::Accessors;
use super::buffers::Buffers;
use super::document::Document;
use super::feature_attributes::{BATCH_ID, FEATURE_ID};
use super::reader::Reader;
use crate::formats::left_out::label;
use crate::mesh::{CornerPrecision, Part};
use gltf::json::accessor::Type;
use gltf::json::mesh::{Primitive, Semantic};
use gltf::json::validation::Checked;
use serde_json::Value;
use std::collections::BTreeMap;

/// Properties that may name a feature, the likeliest first, in any case.
const NAMING: [&str; 8] = ["name", "gml:name", "gml:id", "gml_id", "gmlid", "id", "guid", "globalid"];

/// The names of the features of a file.
pub(super) struct Features {
    /// For each table, a name for each feature; empty if it has none. The first is the tile's batch table.
    tables: Vec<Vec<String>>,
    /// Whether a table should name features, but cannot be read.
    pub is_damaged: bool,
}

/// The features of a primitive's vertices.
#[derive(Clone, Copy)]
pub(super) struct PrimitiveFeatures<'a> {
    ids: Reader<'a>,
    table: usize,
}

/// A feature: its table, and its index there.
pub(super) type FeatureKey = (usize, u32);

impl Features {
    /// Reads the features of a file; `batch` are the names in a tile's batch table.
    pub(super) fn of(document: &Document, buffers: &Buffers, batch: &[String]) -> Self {
        let mut features = Self { tables: vec![batch.to_vec()], is_damaged: false };
        let Some(metadata) = document.extension("EXT_structural_metadata") else { return features };
        let tables = metadata.get("propertyTables").and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
        for table in tables {
            let names = naming_property(metadata, table).map(|property| texts(table, property, buffers));
            features.is_damaged |= matches!(names, Some(None));
            features.tables.push(names.flatten().unwrap_or_default());
        }
        features
    }

    /// The features of a primitive; `None` if they have no names.
    pub(super) fn of_primitive<'a>(
        &self,
        accessors: &mut Accessors<'a, '_>,
        (mesh, number): (usize, usize),
        primitive: &Primitive,
    ) -> Result<Option<PrimitiveFeatures<'a>>, Fault> {
        let said = primitive.extensions.as_ref().and_then(|found| found.others.get("EXT_mesh_features"));
        let sets = said.and_then(|said| said.get("featureIds")?.as_array()).map_or(&[][..], Vec::as_slice);
        let of_set = |set: &Value| {
            let whole = |key: &str| usize::try_from(set.get(key)?.as_u64()?).ok();
            Some((format!("{FEATURE_ID}{}", whole("attribute")?), whole("propertyTable")?.checked_add(1)?))
        };
        let candidates = sets.iter().filter_map(of_set).chain([(BATCH_ID.to_owned(), 0)]);
        for (attribute, table) in candidates.filter(|(_, table)| self.names(*table).iter().any(|name| !name.is_empty()))
        {
            let Some(ids) = primitive.attributes.get(&Checked::Valid(Semantic::Extras(attribute))) else { continue };
            let ids = accessors.get(ids.value(), || format!("features of primitive {number} of mesh {mesh}"))?;
            // without bytes, all vertices would belong to the first feature
            if ids.shape == Type::Scalar && ids.base.is_some() {
                return Ok(Some(PrimitiveFeatures { ids, table }));
            }
        }
        Ok(None)
    }

    fn names(&self, table: usize) -> &[String] {
        self.tables.get(table).map_or(&[], Vec::as_slice)
    }

    /// A feature's name.
    pub(super) fn name(&self, (table, number): FeatureKey) -> String {
        let name = self.names(table).get(number as usize).filter(|name| !name.is_empty());
        name.cloned().unwrap_or_else(|| format!("feature {number}"))
    }
}

impl PrimitiveFeatures<'_> {
    /// The feature of a vertex; `None` if it belongs to none.
    pub(super) fn of_vertex(&self, vertex: usize) -> Option<FeatureKey> {
        let [number] = self.ids.numbers::<1>(vertex);
        let is_whole = vertex < self.ids.count && number >= 0.0 && number < f64::from(u32::MAX);
        is_whole.then_some((self.table, number as u32))
    }
}

/// The property of a table that contains names: the one whose class says so, otherwise one with a suitable name.
fn naming_property<'a>(metadata: &'a Value, table: &'a Value) -> Option<&'a str> {
    let class = metadata.get("schema")?.get("classes")?.get(table.get("class")?.as_str()?)?;
    let said = class.get("properties")?.as_object()?;
    let is_text = |property: &Value| {
        property.get("type").and_then(Value::as_str) == Some("STRING")
            && property.get("array").and_then(Value::as_bool) != Some(true)
    };
    let own = table.get("properties")?.as_object()?;
    let texts = || said.iter().filter(|(name, property)| is_text(property) && own.contains_key(*name));
    let means = |wanted: &str| {
        let semantic = |property: &Value| property.get("semantic").and_then(Value::as_str) == Some(wanted);
        texts().find(|(_, property)| semantic(property)).map(|(name, _)| name.as_str())
    };
    let called = |wanted: &&str| texts().map(|(name, _)| name.as_str()).find(|name| name.eq_ignore_ascii_case(wanted));
    means("NAME").or_else(|| NAMING.iter().find_map(called)).or_else(|| means("ID"))
}

/// The texts of a table's property; `None` if its byte ranges are invalid.
fn texts(table: &Value, property: &str, buffers: &Buffers) -> Option<Vec<String>> {
    let said = table.get("properties")?.get(property)?;
    let view = |key: &str| {
        let index = usize::try_from(said.get(key)?.as_u64()?).ok();
        buffers.view_bytes(index, || format!("property {property}")).ok()
    };
    let (values, offsets) = (view("values")?, view("stringOffsets")?);
    let size = match said.get("stringOffsetType").and_then(Value::as_str) {
        Some("UINT8") => 1,
        Some("UINT16") => 2,
        None | Some("UINT32") => 4,
        Some("UINT64") => 8,
        Some(_) => return None,
    };
    let count = usize::try_from(table.get("count")?.as_u64()?).ok()?;
    let offsets = offsets.get(..count.checked_add(1)?.checked_mul(size)?)?;
    let offset = |bytes: &[u8]| {
        let number = bytes.iter().rev().fold(0_u64, |number, byte| number << 8 | u64::from(*byte));
        usize::try_from(number).unwrap_or(usize::MAX)
    };
    let offsets: Vec<usize> = offsets.chunks_exact(size).map(offset).collect();
    // each text begins at the end of the one before, so together they are no longer than the values
    offsets.windows(2).map(|pair| Some(label(&String::from_utf8_lossy(values.get(pair[0]..pair[1])?)))).collect()
}

/// The names of features in a batch table; empty if it has none.
pub(in crate::formats) fn batch_names(table: &[u8]) -> Vec<String> {
    let Ok(Value::Object(columns)) = serde_json::from_slice(table) else { return Vec::new() };
    let called = |wanted: &&str| columns.iter().find(|(name, _)| name.eq_ignore_ascii_case(wanted));
    let column = NAMING.iter().filter_map(called).find_map(|(_, column)| column.as_array());
    let text = |value: &Value| match value {
        Value::String(text) => label(text),
        Value::Number(number) => number.to_string(),
        _ => String::new(),
    };
    column.map(|column| column.iter().map(text).collect()).unwrap_or_default()
}

/// Splits a part's triangles by feature. `keys` has one entry for each corner of the part.
pub(super) fn split(part: Part, keys: &[Option<FeatureKey>]) -> Vec<(Option<FeatureKey>, Part)> {
    if keys.is_empty() {
        return if part.triangles.is_empty() { Vec::new() } else { vec![(None, part)] };
    }
    let mut by_feature = BTreeMap::<Option<FeatureKey>, Vec<[u32; 3]>>::new();
    for triangle in &part.triangles {
        let key = keys.get(triangle[0] as usize).copied().flatten();
        by_feature.entry(key).or_default().push(*triangle);
    }
    let mut numbers = vec![0; part.positions.len()];
    let each = by_feature.into_iter().map(|(key, triangles)| (key, share(&part, triangles, &mut numbers)));
    each.collect()
}

/// Copies some triangles of a part with the corners that they use. `numbers` has room for an index of each corner.
fn share(part: &Part, mut triangles: Vec<[u32; 3]>, numbers: &mut [u32]) -> Part {
    let mut used: Vec<u32> = triangles.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    for (number, &corner) in used.iter().enumerate() {
        if let Some(slot) = numbers.get_mut(corner as usize) {
            *slot = number as u32;
        }
    }
    for corner in triangles.iter_mut().flatten() {
        *corner = numbers.get(*corner as usize).copied().unwrap_or(0);
    }
    let positions = used.iter().filter_map(|&corner| part.positions.get(corner as usize).copied()).collect();
    Part { positions, triangles, coarse: coarse_share(&part.coarse, &used), ..Part::default() }
}

/// The runs of coarse corners among the used ones, which are in ascending order.
fn coarse_share(runs: &[CornerPrecision], used: &[u32]) -> Vec<CornerPrecision> {
    let mut shares: Vec<(usize, CornerPrecision)> = Vec::new();
    for (number, &corner) in used.iter().enumerate() {
        let number = number as u32;
        let at = runs.partition_point(|run| run.corners.end <= corner);
        let Some(run) = runs.get(at).filter(|run| run.corners.contains(&corner)) else { continue };
        match shares.last_mut().filter(|(last, share)| *last == at && share.corners.end == number) {
            Some((_, share)) => share.corners.end += 1,
            None => shares.push((at, CornerPrecision { corners: number..number + 1, ..run.clone() })),
        }
    }
    shares.into_iter().map(|(_, share)| share).collect()
}
