//! Model files: what is read, names, and what is refused. The files are built here byte by byte.

mod hostile;
mod names;
pub(crate) mod poses;
mod reading;
mod refused;
mod seen;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use glam::DVec3;
use gnomon::formats::{self, ModelError};
use gnomon::mesh::Part;
use gnomon::site::Placement;
use serde_json::{Value, json};
use std::path::Path;

pub(crate) const I8: u32 = 5120;
pub(crate) const U8: u32 = 5121;
pub(crate) const I16: u32 = 5122;
pub(crate) const U16: u32 = 5123;
pub(crate) const U32: u32 = 5125;
pub(crate) const F32: u32 = 5126;

/// A glTF file in the making: its JSON, and the bytes of its one buffer.
pub(crate) struct Model {
    pub(crate) json: Value,
    pub(crate) bytes: Vec<u8>,
}

impl Model {
    pub(crate) fn new() -> Self {
        let json = json!({"asset": {"version": "2.0"}, "accessors": [], "bufferViews": []});
        Self { json, bytes: Vec::new() }
    }

    /// One node, one mesh, one triangle without indices; it lies on the ground and faces up.
    pub(crate) fn triangle() -> Self {
        let mut model = Self::new();
        let positions = model.f32s("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0]);
        model.json["meshes"] = json!([{"primitives": [{"attributes": {"POSITION": positions}}]}]);
        model.json["nodes"] = json!([{"mesh": 0}]);
        model
    }

    /// A view of bytes of its own.
    pub(crate) fn view(&mut self, bytes: &[u8]) -> usize {
        let view = json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()});
        self.bytes.extend(bytes);
        push(&mut self.json["bufferViews"], view)
    }

    /// An accessor of bytes of its own.
    pub(crate) fn accessor(&mut self, kind: &str, component: u32, count: usize, bytes: &[u8]) -> usize {
        let view = self.view(bytes);
        let accessor = json!({"bufferView": view, "componentType": component, "count": count, "type": kind});
        push(&mut self.json["accessors"], accessor)
    }

    /// An accessor of floats of its own.
    pub(crate) fn f32s(&mut self, kind: &str, numbers: &[f32]) -> usize {
        let lanes = match kind {
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 1,
        };
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        self.accessor(kind, F32, numbers.len() / lanes, &bytes)
    }

    /// The first primitive of the first mesh.
    pub(crate) fn primitive(&mut self) -> &mut Value {
        &mut self.json["meshes"][0]["primitives"][0]
    }

    /// As `.gltf`, with the buffer in the JSON.
    pub(crate) fn gltf(&self) -> Value {
        let mut json = self.json.clone();
        if json["buffers"].is_null() {
            let uri = format!("data:application/octet-stream;base64,{}", BASE64_STANDARD.encode(&self.bytes));
            json["buffers"] = json!([{"byteLength": self.bytes.len(), "uri": uri}]);
        }
        json
    }

    /// As `.glb`, with the buffer as its binary chunk.
    pub(crate) fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{"byteLength": self.bytes.len()}]);
        glb(json.to_string().as_bytes(), &self.bytes)
    }

    /// The parts, or the error's text.
    pub(crate) fn load(&self) -> Result<Vec<Part>, String> {
        load_bytes("model.gltf", self.gltf().to_string().as_bytes())
    }

    /// The only part.
    pub(crate) fn part(&self) -> Part {
        let mut parts = self.load().unwrap();
        assert_eq!(parts.len(), 1);
        parts.remove(0)
    }

    /// There must be an error, and it must say all of `words`.
    pub(crate) fn refused(&self, words: &[&str]) {
        assert_refused(self.load(), words);
    }
}

/// A binary container of two chunks.
pub(crate) fn glb(json: &[u8], binary: &[u8]) -> Vec<u8> {
    let mut chunks = Vec::new();
    for (kind, data, fill) in [(b"JSON", json, b' '), (b"BIN\0", binary, 0)] {
        let length = data.len().next_multiple_of(4);
        chunks.extend((length as u32).to_le_bytes());
        chunks.extend(kind);
        chunks.extend(data);
        chunks.resize(chunks.len() + length - data.len(), fill);
    }
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    bytes.extend((chunks.len() as u32 + 12).to_le_bytes());
    bytes.extend(chunks);
    bytes
}

pub(crate) fn push(list: &mut Value, value: Value) -> usize {
    let list = list.as_array_mut().unwrap();
    list.push(value);
    list.len() - 1
}

/// Loads bytes from a file of that name.
pub(crate) fn load_bytes(name: &str, bytes: &[u8]) -> Result<Vec<Part>, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    load_path(&path)
}

pub(crate) fn load_path(path: &Path) -> Result<Vec<Part>, String> {
    load(path, &Placement::default()).map(|model| model.parts).map_err(|error| error.to_string())
}

/// There must be an error, and it must say all of `words`.
pub(crate) fn assert_refused(loaded: Result<Vec<Part>, String>, words: &[&str]) {
    let text = loaded.expect_err("the file must be refused");
    for word in words {
        assert!(text.contains(word), "'{word}' is missing in: {text}");
    }
}

/// The corners of a part's triangles, rounded to a micrometre.
pub(crate) fn corners(part: &Part) -> Vec<[[f64; 3]; 3]> {
    let round = |value: f64| (value * 1e6).round() / 1e6 + 0.0;
    let corner = |vertex: u32| part.positions[vertex as usize].to_array().map(round);
    part.triangles.iter().map(|triangle| triangle.map(corner)).collect()
}

/// Twice the area of a part's triangles, as the sum of their outward normals.
pub(crate) fn normal(part: &Part) -> DVec3 {
    let of = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a);
    part.triangles.iter().map(|triangle| of(triangle.map(|vertex| part.positions[vertex as usize]))).sum()
}

/// Reads a model and places it.
fn load(path: &Path, placement: &Placement) -> Result<formats::Model, ModelError> {
    formats::read(path, &placement.read_options()).map(|model| placement.place(model))
}
