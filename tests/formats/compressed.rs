//! glTF with compressed geometry. The meshopt data is written here after the specification; the Draco data is the
//! triangle of its own encoder's simplest method.

use super::building::*;
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use glam::DVec3;
use serde_json::{Value, json};

/// One triangle whose positions and indices lie in views that meshopt compresses.
fn meshopt(extension: &str, attributes: &[u8], indices: &[u8], mode: &str, filter: &str, index_bytes: u64) -> Value {
    let bytes: Vec<u8> = attributes.iter().chain(indices).copied().collect();
    let compressed = |start: usize, length: usize, stride: u64, mode: &str, filter: &str| {
        json!({extension: {
            "buffer": 0, "byteOffset": start, "byteLength": length, "byteStride": stride, "count": 3, "mode": mode,
            "filter": filter,
        }})
    };
    json!({
        "asset": {"version": "2.0"},
        "extensionsRequired": [extension],
        "buffers": [
            {"byteLength": bytes.len(), "uri": format!("data:;base64,{}", BASE64_STANDARD.encode(&bytes))},
            {"byteLength": 48},
        ],
        "bufferViews": [
            {"buffer": 1, "byteLength": 36, "byteStride": 12,
                "extensions": compressed(0, attributes.len(), 12, "ATTRIBUTES", filter)},
            {"buffer": 1, "byteOffset": 36, "byteLength": 3 * index_bytes,
                "extensions": compressed(attributes.len(), indices.len(), index_bytes, mode, "NONE")},
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3},
            {"bufferView": 1, "componentType": if index_bytes == 2 { 5123 } else { 5125 }, "type": "SCALAR", "count": 3},
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "nodes": [{"mesh": 0}],
    })
}

/// Elements after version 0: every byte as a group of whole deltas from the element before.
fn stored(elements: &[[u8; 12]]) -> Vec<u8> {
    let mut bytes = vec![0xA0];
    for lane in 0..12 {
        // the first of four groups has its deltas as bytes
        bytes.push(3);
        let mut last = 0_u8;
        let mut group = [0; 16];
        for (element, delta) in elements.iter().zip(&mut group) {
            let difference = element[lane].wrapping_sub(last) as i8;
            *delta = ((difference << 1) ^ (difference >> 7)) as u8;
            last = element[lane];
        }
        bytes.extend(group);
    }
    // a tail of 32 bytes that ends with the baseline
    bytes.extend([0; 32]);
    bytes
}

fn floats(point: [f32; 3]) -> [u8; 12] {
    let bytes: Vec<u8> = point.iter().flat_map(|number| number.to_le_bytes()).collect();
    bytes.try_into().unwrap()
}

const TRIANGLE: [[f32; 3]; 3] = [[1.0, 2.0, -3.0], [4.5, 2.0, -3.0], [1.0, 7.0, -3.0]];

fn assert_is_triangle(json: &Value) {
    let model = read_bytes("m.gltf", json.to_string().as_bytes());
    let found: Vec<[DVec3; 3]> = triangles(&model).collect();
    // y up, as glTF has it: east, minus south, up
    let upright = |[x, y, z]: [f32; 3]| DVec3::new(x.into(), (-z).into(), y.into());
    assert_eq!(found, [TRIANGLE.map(upright)]);
}

/// Triangle codes: all three vertices are new, by the table's first entry.
const NEW: [u8; 18] = [0xE1, 0xF0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];

#[test]
fn meshopt_is_unpacked() {
    let elements = stored(&TRIANGLE.map(floats));
    // deltas of 0, 1 and 1 to the first baseline: zigzag, then the baseline's number
    let sequence = [0xD1, 0, 4, 4, 0, 0, 0, 0];
    for extension in ["EXT_meshopt_compression", "KHR_meshopt_compression"] {
        for bytes in [2, 4] {
            assert_is_triangle(&meshopt(extension, &elements, &NEW, "TRIANGLES", "NONE", bytes));
            assert_is_triangle(&meshopt(extension, &elements, &sequence, "INDICES", "NONE", bytes));
        }
    }
}

/// Version 1 of the attributes: bytes stored as they are, 16 bits at once, and 32 by exclusive or.
#[test]
fn all_channels_of_meshopt_are_unpacked() {
    let elements = TRIANGLE.map(floats);
    let mut bytes = vec![0xA1];
    // all bytes are stored as they are
    bytes.extend([0xFF; 3]);
    let zigzag = |difference: i16| ((difference << 1) ^ (difference >> 15)) as u16;
    let mut lanes = [[0_u8; 3]; 12];
    let mut last = [0_u8; 12];
    for (at, element) in elements.iter().enumerate() {
        for lane in 0..4 {
            let difference = element[lane].wrapping_sub(last[lane]) as i8;
            lanes[lane][at] = ((difference << 1) ^ (difference >> 7)) as u8;
        }
        for pair in [4, 6] {
            let short = |bytes: &[u8; 12]| i16::from_le_bytes([bytes[pair], bytes[pair + 1]]);
            let delta = zigzag(short(element).wrapping_sub(short(&last))).to_le_bytes();
            (lanes[pair][at], lanes[pair + 1][at]) = (delta[0], delta[1]);
        }
        let long = |bytes: &[u8; 12]| u32::from_le_bytes(bytes[8..].try_into().unwrap());
        let delta = (long(element) ^ long(&last)).rotate_left(5).to_le_bytes();
        (0..4).for_each(|byte| lanes[8 + byte][at] = delta[byte]);
        last = *element;
    }
    bytes.extend(lanes.concat());
    // a tail of 24 bytes: padding, the baseline, and the modes of the three channels
    bytes.extend([0; 24 - 3]);
    bytes.extend([0, 1, 2 | 5 << 4]);
    assert_is_triangle(&meshopt("KHR_meshopt_compression", &bytes, &NEW, "TRIANGLES", "NONE", 2));
}

#[test]
fn the_exponential_filter_is_undone() {
    // halves as mantissa: 2 × 2⁻¹ and so on
    let packed = |point: [f32; 3]| {
        let bytes: Vec<u8> =
            point.iter().flat_map(|number| ((((number * 2.0) as i32) & 0xFF_FFFF) | -1 << 24).to_le_bytes()).collect();
        <[u8; 12]>::try_from(bytes).unwrap()
    };
    let elements = stored(&TRIANGLE.map(packed));
    assert_is_triangle(&meshopt("EXT_meshopt_compression", &elements, &NEW, "TRIANGLES", "EXPONENTIAL", 2));
}

#[test]
fn damaged_meshopt_is_refused() {
    let elements = stored(&TRIANGLE.map(floats));
    let refused = |attributes: &[u8], indices: &[u8], mode: &str, filter: &str, words: &[&str]| {
        let json = meshopt("EXT_meshopt_compression", attributes, indices, mode, filter, 2);
        assert_refused("m.gltf", json.to_string().as_bytes(), words);
    };
    refused(&elements[1..], &NEW, "TRIANGLES", "NONE", &["buffer view 0", "cannot be unpacked", "meshopt"]);
    refused(&elements[..elements.len() - 1], &NEW, "TRIANGLES", "NONE", &["buffer view 0"]);
    refused(&elements, &NEW[..17], "TRIANGLES", "NONE", &["buffer view 1"]);
    refused(&elements, &NEW, "SQUARES", "NONE", &["buffer view 1"]);
    refused(&elements, &NEW, "TRIANGLES", "BLUR", &["an unknown filter"]);
    // an edge that was never written
    let mut code = NEW;
    code[1] = 0x20;
    refused(&elements, &code, "TRIANGLES", "NONE", &["buffer view 1"]);
    let mut json = meshopt("EXT_meshopt_compression", &elements, &NEW, "TRIANGLES", "NONE", 2);
    json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["count"] = json!(4_000_000_000_u64);
    assert_refused("m.gltf", json.to_string().as_bytes(), &["a different size than its elements"]);
}

/// Draco's sequential method (specification, chapters 3 to 5): plain indices, and positions as they are.
pub(super) fn draco() -> (Vec<u8>, Value) {
    let mut bytes = b"DRACO".to_vec();
    // version 2.2, a mesh, sequential, no flags
    bytes.extend([2, 2, 1, 0, 0, 0]);
    // one face, three points, plain indices of a byte
    bytes.extend([1, 3, 1, 0, 1, 2]);
    // one decoder with one attribute: a position of three floats, not normalised, of the number 7; stored as it is
    bytes.extend([1, 1, 0, 9, 3, 0, 7, 0]);
    bytes.extend(TRIANGLE.iter().flatten().flat_map(|number| number.to_le_bytes()));
    let json = json!({
        "asset": {"version": "2.0"},
        "extensionsRequired": ["KHR_draco_mesh_compression"],
        "buffers": [{"byteLength": bytes.len(), "uri": format!("data:;base64,{}", BASE64_STANDARD.encode(&bytes))}],
        "bufferViews": [{"buffer": 0, "byteLength": bytes.len()}],
        "accessors": [
            {"componentType": 5126, "type": "VEC3", "count": 3},
            {"componentType": 5123, "type": "SCALAR", "count": 3},
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "extensions": {
            "KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 7}},
        }}]}],
        "nodes": [{"mesh": 0}],
    });
    (bytes, json)
}

#[test]
fn draco_is_unpacked() {
    let (bytes, json) = draco();
    assert_is_triangle(&json);
    let refused = |change: &dyn Fn(&mut Value), words: &[&str]| {
        let mut json = json.clone();
        change(&mut json);
        assert_refused("m.gltf", json.to_string().as_bytes(), words);
    };
    refused(&|json| json["accessors"][0]["count"] = json!(4), &["unpacks to 3 vertices", "accessor 0"]);
    refused(&|json| json["accessors"][1]["count"] = json!(6), &["unpacks to 3 corners", "accessor 1"]);
    refused(&|json| json["meshes"][0]["primitives"][0]["mode"] = json!(5), &["not a list of triangles"]);
    refused(&|json| json["bufferViews"][0]["byteLength"] = json!(bytes.len() - 9), &["cannot be unpacked"]);
    refused(&|json| json["bufferViews"][0]["byteLength"] = json!(bytes.len() + 1), &["bytes 0–"]);
}

/// If a stream says how coarsely its positions were rounded, a note says so.
#[test]
fn the_rounding_of_draco_is_told() {
    let (mut bytes, mut json) = draco();
    let read = |json: &Value| read_bytes("m.gltf", json.to_string().as_bytes()).parts[0].coarse.clone();
    assert_eq!(read(&json), []);
    // the least number of each axis, the largest range, and in how many bits that is divided
    bytes.extend([1.0_f32, 2.0, -3.0, 5.0].iter().flat_map(|number| number.to_le_bytes()));
    bytes.push(4);
    json["buffers"][0] = json!({
        "byteLength": bytes.len(),
        "uri": format!("data:;base64,{}", BASE64_STANDARD.encode(&bytes)),
    });
    json["bufferViews"][0]["byteLength"] = json!(bytes.len());
    let coarse = read(&json);
    assert_eq!((coarse.len(), coarse[0].step_m, coarse[0].is_float), (1, 5.0 / 15.0, false));
}

/// Each byte of the compressed streams may be anything.
#[test]
fn every_changed_byte_is_survived() {
    let read = |json: &Value| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("m.gltf");
        std::fs::write(&path, json.to_string()).unwrap();
        gnomon::formats::read(&path, &Default::default()).is_ok()
    };
    let (bytes, json) = draco();
    let elements = stored(&TRIANGLE.map(floats));
    let (mut good, mut bad) = (0, 0);
    for at in 0..bytes.len().max(elements.len()) {
        for change in [1, 0x80, 0xFF] {
            let mut draco = bytes.clone();
            let mut meshopt_bytes = elements.clone();
            let (one, other) = (at % draco.len(), at % meshopt_bytes.len());
            draco[one] ^= change;
            meshopt_bytes[other] ^= change;
            let mut json = json.clone();
            json["buffers"][0]["uri"] = json!(format!("data:;base64,{}", BASE64_STANDARD.encode(&draco)));
            let packed = meshopt("EXT_meshopt_compression", &meshopt_bytes, &NEW, "TRIANGLES", "NONE", 2);
            for json in [json, packed] {
                if read(&json) { good += 1 } else { bad += 1 }
            }
        }
    }
    assert!(good > 0 && bad > 0, "{good} read, {bad} refused");
}
