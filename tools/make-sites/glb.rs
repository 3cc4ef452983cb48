//! Writes a model as a .glb, structured as exporters do: materials, meshes with a primitive per material, a tree of
//! nodes.
//!
//! Everything here is in the world frame (x east, y north, z up, in grid steps); glTF is x east, y up, z south.

use super::solids::{STEPS, Solid, on_grid};
use glam::DVec3;
use serde_json::{Value, json};

/// What one .glb holds.
pub(crate) struct Model {
    materials: Vec<Value>,
    meshes: Vec<Mesh>,
    /// The roots of the scene.
    pub(crate) nodes: Vec<Node>,
}

/// Handle of a material in its [`Model`].
#[derive(Clone, Copy)]
pub(crate) struct Material(usize);

/// Handle of a mesh in its [`Model`].
#[derive(Clone, Copy)]
pub(crate) struct MeshId(usize);

struct Mesh {
    name: String,
    primitives: Vec<(Material, Vec<Solid>)>,
}

/// A place in the tree. Turns are quarters and moves are whole grid steps, so that what lies on the grid stays there.
pub(crate) struct Node {
    name: String,
    mesh: Option<MeshId>,
    position: DVec3,
    quarter_turns: u32,
    mirrored: bool,
    children: Vec<Node>,
}

impl Node {
    /// A node without a mesh, for its children.
    pub(crate) fn group(name: &str, children: Vec<Node>) -> Self {
        Self { name: name.to_owned(), mesh: None, position: DVec3::ZERO, quarter_turns: 0, mirrored: false, children }
    }

    /// A node that shows a mesh.
    pub(crate) fn showing(name: &str, mesh: MeshId) -> Self {
        Self { mesh: Some(mesh), ..Self::group(name, Vec::new()) }
    }

    /// Moved by metres east, north, up.
    pub(crate) fn at(mut self, east: f64, north: f64, up: f64) -> Self {
        self.position = DVec3::new(east, north, up);
        self
    }

    /// Turned counter-clockwise seen from above, before it is moved.
    pub(crate) fn turned(mut self, quarter_turns: u32) -> Self {
        self.quarter_turns = quarter_turns;
        self
    }

    /// East and west exchanged, before it is turned.
    pub(crate) fn mirrored(mut self) -> Self {
        self.mirrored = true;
        self
    }

    /// Translation, rotation and scale where they say it exactly. The quaternion of a quarter turn holds √½, which no
    /// float does; such a node gets a matrix.
    fn transform(&self, node: &mut Value) {
        let [x, y, z] = in_gltf(on_grid(self.position));
        let flip = if self.mirrored { -1.0 } else { 1.0 };
        if self.quarter_turns % 2 == 1 {
            let sin = if self.quarter_turns % 4 == 1 { 1.0 } else { -1.0 };
            let columns = [[0.0, 0.0, -sin * flip, 0.0], [0.0, 1.0, 0.0, 0.0], [sin, 0.0, 0.0, 0.0], [x, y, z, 1.0]];
            node["matrix"] = json!(columns.concat());
            return;
        }
        if self.position != DVec3::ZERO {
            node["translation"] = json!([x, y, z]);
        }
        if self.quarter_turns % 4 == 2 {
            node["rotation"] = json!([0.0, 1.0, 0.0, 0.0]);
        }
        if self.mirrored {
            node["scale"] = json!([-1.0, 1.0, 1.0]);
        }
    }
}

impl Model {
    pub(crate) fn new() -> Self {
        Self { materials: Vec::new(), meshes: Vec::new(), nodes: Vec::new() }
    }

    /// A matt material of one colour: linear red, green, blue, alpha.
    pub(crate) fn material(&mut self, name: &str, colour: [f64; 4]) -> Material {
        let mut material = json!({
            "name": name,
            "pbrMetallicRoughness": {"baseColorFactor": colour, "metallicFactor": 0.0, "roughnessFactor": 0.9},
        });
        if colour[3] < 1.0 {
            material["alphaMode"] = json!("BLEND");
        }
        self.materials.push(material);
        Material(self.materials.len() - 1)
    }

    /// A mesh with one primitive for each material.
    pub(crate) fn mesh(&mut self, name: &str, primitives: Vec<(Material, Vec<Solid>)>) -> MeshId {
        let name = name.to_owned();
        self.meshes.push(Mesh { name, primitives });
        MeshId(self.meshes.len() - 1)
    }

    /// The file.
    pub(crate) fn to_glb(&self) -> Vec<u8> {
        let mut data = Data::default();
        let meshes: Vec<Value> = self.meshes.iter().map(|mesh| data.mesh(mesh)).collect();
        let mut nodes = Vec::new();
        let roots: Vec<usize> = self.nodes.iter().map(|root| add_node(root, &mut nodes)).collect();
        let json = json!({
            "asset": {"version": "2.0", "generator": "gnomon make-sites"},
            "scene": 0,
            "scenes": [{"nodes": roots}],
            "nodes": nodes,
            "meshes": meshes,
            "materials": self.materials,
            "accessors": data.accessors,
            "bufferViews": data.views,
            "buffers": [{"byteLength": data.bytes.len()}],
        });
        let json = pad(json.to_string().into_bytes(), b' ');
        let bytes = pad(data.bytes, 0);
        let total = 12 + 8 + json.len() + 8 + bytes.len();
        let word = |value: usize| (value as u32).to_le_bytes();
        [
            b"glTF".as_slice(),
            &word(2),
            &word(total),
            &word(json.len()),
            b"JSON",
            &json,
            &word(bytes.len()),
            b"BIN\0",
            &bytes,
        ]
        .concat()
    }
}

/// Adds a node behind its children and gives its index.
fn add_node(node: &Node, nodes: &mut Vec<Value>) -> usize {
    let children: Vec<usize> = node.children.iter().map(|child| add_node(child, nodes)).collect();
    let mut value = json!({"name": node.name});
    if let Some(MeshId(mesh)) = node.mesh {
        value["mesh"] = json!(mesh);
    }
    if !children.is_empty() {
        value["children"] = json!(children);
    }
    node.transform(&mut value);
    nodes.push(value);
    nodes.len() - 1
}

/// The binary chunk and what the JSON says of it.
#[derive(Default)]
struct Data {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Data {
    fn mesh(&mut self, mesh: &Mesh) -> Value {
        let primitives: Vec<Value> = mesh
            .primitives
            .iter()
            .map(|(Material(material), solids)| {
                let positions = self.positions(solids);
                let indices = self.indices(solids);
                json!({"attributes": {"POSITION": positions}, "indices": indices, "material": material})
            })
            .collect();
        json!({"name": mesh.name, "primitives": primitives})
    }

    fn positions(&mut self, solids: &[Solid]) -> usize {
        let points: Vec<[f32; 3]> =
            solids.iter().flat_map(|solid| &solid.points).map(|&point| in_gltf(point)).collect();
        let bound = |pick: fn(f32, f32) -> f32| -> [f32; 3] {
            let join = |a: [f32; 3], b: [f32; 3]| std::array::from_fn(|axis| pick(a[axis], b[axis]));
            points.iter().copied().reduce(join).expect("a primitive has points")
        };
        let accessor = json!({
            "componentType": 5126, "type": "VEC3", "count": points.len(), "min": bound(f32::min), "max": bound(f32::max),
        });
        let bytes = points.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
        self.accessor(accessor, bytes, 34962)
    }

    fn indices(&mut self, solids: &[Solid]) -> usize {
        let mut indices = Vec::new();
        let mut first = 0;
        for solid in solids {
            indices.extend(solid.triangles.iter().flatten().map(|corner| corner + first));
            first += solid.points.len() as u32;
        }
        // 65535 itself is the restart index, which glTF does not allow.
        let is_short = first <= 65535;
        let bytes = if is_short {
            indices.iter().flat_map(|&index| (index as u16).to_le_bytes()).collect()
        } else {
            indices.iter().flat_map(|index| index.to_le_bytes()).collect()
        };
        let component = if is_short { 5123 } else { 5125 };
        let accessor = json!({"componentType": component, "type": "SCALAR", "count": indices.len()});
        self.accessor(accessor, bytes, 34963)
    }

    /// An accessor with a buffer view of its own.
    fn accessor(&mut self, mut accessor: Value, bytes: Vec<u8>, target: u32) -> usize {
        self.views.push(json!({
            "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len(), "target": target,
        }));
        accessor["bufferView"] = json!(self.views.len() - 1);
        self.accessors.push(accessor);
        self.bytes.extend(pad(bytes, 0));
        self.accessors.len() - 1
    }
}

/// Grid steps to metres in glTF's axes.
fn in_gltf([x, y, z]: [i32; 3]) -> [f32; 3] {
    // An integer has no −0, which would print as one.
    [x, z, -y].map(|steps| steps as f32 / STEPS as f32)
}

/// Fills up to a multiple of four bytes.
fn pad(mut bytes: Vec<u8>, with: u8) -> Vec<u8> {
    bytes.resize(bytes.len().next_multiple_of(4), with);
    bytes
}
