//! The features of tiles: each feature that a batch table or a property table names becomes a component.

use super::block::model_of;
use super::files::b3dm;
use gnomon::formats::Model;
use serde_json::{Value, json};

/// Two squares of two triangles each, at x = 0 and x = 10, and which feature each of their corners is of.
fn glb(attribute: &str, extras: Value, mesh_extension: Value, ids: [f32; 2], behind: &[u8]) -> Vec<u8> {
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let corners = |x: f32| square.map(|[dx, y]: [f32; 2]| [x + dx, y, 0.0]);
    let positions = [corners(0.0), corners(10.0)].concat();
    let mut binary: Vec<u8> = positions.as_flattened().iter().flat_map(|number| number.to_le_bytes()).collect();
    for id in ids {
        (0..6).for_each(|_| binary.extend(id.to_le_bytes()));
    }
    let data = binary.len();
    binary.extend(behind);
    binary.resize(binary.len().next_multiple_of(4), 0);
    let mut document = json!({
        "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"name": "batch", "mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, attribute: 1}, "extensions": mesh_extension}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 12, "type": "VEC3", "min": [0, 0, 0], "max": [11, 1, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 12, "type": "SCALAR"}
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 144}, {"buffer": 0, "byteOffset": 144, "byteLength": 48},
            {"buffer": 0, "byteOffset": data, "byteLength": 9}, {"buffer": 0, "byteOffset": data + 12, "byteLength": 3}
        ],
        "buffers": [{"byteLength": binary.len()}],
    });
    document["extensions"] = extras;
    let mut text = document.to_string();
    text.push_str(&" ".repeat(text.len().next_multiple_of(4) - text.len()));
    let mut file = b"glTF\x02\0\0\0".to_vec();
    file.extend((28 + text.len() as u32 + binary.len() as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", text.as_bytes()), (b"BIN\0", binary.as_slice())] {
        file.extend((chunk.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(chunk);
    }
    file
}

fn batched(ids: [f32; 2], table: &Value) -> Model {
    model_of("a.b3dm", batched_file(ids, table))
}

/// A batched model with the names of its features.
pub(super) fn batched_file(ids: [f32; 2], table: &Value) -> Vec<u8> {
    let gltf = glb("_BATCHID", json!({}), json!({}), ids, &[0; 16]);
    let (plain, table) = (b3dm(&gltf, ""), table.to_string());
    let mut file = plain[..28].to_vec();
    file[8..12].copy_from_slice(&((plain.len() + table.len()) as u32).to_le_bytes());
    file[20..24].copy_from_slice(&(table.len() as u32).to_le_bytes());
    file.extend(table.as_bytes());
    file.extend(&plain[28..]);
    file
}

/// What each component is called, and where its triangles lie: how many, and their least x.
fn told(model: &Model) -> Vec<(&str, usize, f64)> {
    let least = |part: &gnomon::mesh::Part| part.positions.iter().fold(f64::INFINITY, |least, at| least.min(at.x));
    model.parts.iter().map(|part| (part.name.as_str(), part.triangles.len(), least(part))).collect()
}

#[test]
fn a_batch_table_names_components() {
    let model = batched([1.0, 0.0], &json!({"height": [3, 4], "NAME": ["Town hall", "Church"]}));
    assert_eq!(told(&model), [("Town hall", 2, 10.0), ("Church", 2, 0.0)]);
    assert_eq!(model.parts[1].aliases, ["Church", "batch", "default"]);
    assert!(model.parts.iter().all(|part| part.positions.len() == 6), "each has its own corners alone");
    // numbers are names, too; without any, nothing is told apart
    assert_eq!(told(&batched([0.0, 1.0], &json!({"id": [17, "b"]}))), [("17", 2, 0.0), ("b", 2, 10.0)]);
    assert_eq!(told(&batched([0.0, 1.0], &json!({"height": [3, 4]}))), [("batch", 4, 0.0)]);
    // a feature that the table does not have, and one without a name
    assert_eq!(told(&batched([0.0, 7.0], &json!({"id": ["a"]}))), [("a", 2, 0.0), ("feature 7", 2, 10.0)]);
    assert_eq!(told(&batched([0.0, 1.0], &json!({"id": ["a", null]}))), [("a", 2, 0.0), ("feature 1", 2, 10.0)]);
    // what is no number of a feature
    assert_eq!(told(&batched([0.0, -1.0], &json!({"id": ["a", "b"]}))), [("batch", 2, 10.0), ("a", 2, 0.0)]);
    assert_eq!(told(&batched([f32::NAN, 0.0], &json!({"id": ["a", "b"]}))), [("batch", 2, 0.0), ("a", 2, 10.0)]);
}

#[test]
fn a_property_table_names_components() {
    let metadata = |offsets: usize| {
        json!({"EXT_structural_metadata": {
            "schema": {"classes": {"building": {"properties": {
                "roof": {"type": "STRING"}, "address": {"type": "STRING", "semantic": "NAME"}}}}},
            "propertyTables": [{"class": "building", "count": 2, "properties": {
                "address": {"values": 2, "stringOffsets": offsets, "stringOffsetType": "UINT8"}}}]}})
    };
    let of = json!({"EXT_mesh_features": {"featureIds": [{"featureCount": 2, "attribute": 0, "propertyTable": 0}]}});
    let texts = b"Elm 1Oak \0\0\0\0\x05\x09\0";
    let model = model_of("a.glb", glb("_FEATURE_ID_0", metadata(3), of.clone(), [0.0, 1.0], texts));
    assert_eq!(told(&model), [("Elm 1", 2, 0.0), ("Oak", 2, 10.0)]);
    assert!(model.notes.is_empty());
    // without the table's bytes nothing is told apart, and that is said
    let model = model_of("a.glb", glb("_FEATURE_ID_0", metadata(9), of.clone(), [0.0, 1.0], texts));
    assert_eq!(told(&model), [("batch", 4, 0.0)]);
    assert!(model.notes[0].to_string().contains("damaged table of names"), "{:?}", model.notes);
    let back = b"Elm 1Oak \0\0\0\x09\x05\x09\0";
    let model = model_of("a.glb", glb("_FEATURE_ID_0", metadata(3), of, [0.0, 1.0], back));
    assert_eq!(model.parts.len(), 1, "texts that overlap are none");
}
