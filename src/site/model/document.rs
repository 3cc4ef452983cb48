//! The JSON → the structure of what casts. Textures, cameras and animations are not even parsed.
//!
//! `gltf::json` reads meshes, accessors, views and buffers. Nodes are our own, since it keeps transforms in `f32`, which
//! far from the origin, at map coordinates, is steps of 25 cm; scenes and materials are, since it refuses scenes
//! without nodes and broken textures.

use super::Fault;
use gltf::json::{Accessor, Buffer, Mesh, buffer::View};
use serde::Deserialize;
use std::collections::BTreeMap;

/// Bytes in a name; every component carries the names of its node, mesh and material.
const MAX_NAME_BYTES: usize = 1000;

/// Extensions about how surfaces look, sound or are described: whatever they say, the triangles stay the same.
const HARMLESS: [&str; 17] = [
    "KHR_materials_",
    "EXT_materials_",
    "ADOBE_materials_",
    "KHR_texture_",
    "EXT_texture_",
    "MSFT_texture_",
    "MSFT_packing_",
    "KHR_techniques_webgl",
    "KHR_lights_",
    "EXT_lights_",
    "KHR_animation_",
    "KHR_audio",
    "KHR_xmp",
    "EXT_mesh_features",
    "EXT_instance_features",
    "EXT_structural_metadata",
    "EXT_feature_metadata",
];

/// Extensions about geometry that are read.
const READ: [&str; 2] = ["KHR_mesh_quantization", "EXT_mesh_gpu_instancing"];

/// Extensions that compress geometry.
const COMPRESSING: [&str; 3] = ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"];

/// What a glTF file says about geometry. No index in it is checked yet.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Document {
    #[serde(default)]
    extensions_required: Vec<String>,
    /// The default scene.
    pub scene: Option<usize>,
    #[serde(default)]
    pub scenes: Vec<Scene>,
    #[serde(default)]
    pub nodes: Vec<Node>,
    #[serde(default)]
    pub meshes: Vec<Mesh>,
    #[serde(default)]
    pub materials: Vec<Material>,
    #[serde(default)]
    pub accessors: Vec<Accessor>,
    #[serde(default)]
    pub buffer_views: Vec<View>,
    #[serde(default)]
    pub buffers: Vec<Buffer>,
}

/// What every version of glTF says; the rest of glTF 1.0 has another shape.
#[derive(Deserialize)]
struct Head {
    asset: Asset,
}

#[derive(Deserialize)]
struct Asset {
    version: String,
}

#[derive(Deserialize)]
pub(super) struct Scene {
    #[serde(default)]
    pub nodes: Vec<usize>,
}

#[derive(Deserialize)]
pub(super) struct Material {
    name: Option<String>,
}

#[derive(Deserialize)]
pub(super) struct Node {
    name: Option<String>,
    pub mesh: Option<usize>,
    #[serde(default)]
    pub children: Vec<usize>,
    /// Column by column.
    pub matrix: Option<Box<[f64; 16]>>,
    pub translation: Option<[f64; 3]>,
    /// x, y, z, w.
    pub rotation: Option<[f64; 4]>,
    pub scale: Option<[f64; 3]>,
    #[serde(default)]
    pub extensions: NodeExtensions,
}

#[derive(Default, Deserialize)]
pub(super) struct NodeExtensions {
    #[serde(rename = "EXT_mesh_gpu_instancing")]
    pub instancing: Option<Instancing>,
}

/// Where copies of a node's mesh stand.
#[derive(Deserialize)]
pub(super) struct Instancing {
    /// Accessors by name.
    pub attributes: BTreeMap<String, usize>,
}

impl Document {
    /// Parses the JSON of a file, and checks that its version and extensions can be read.
    pub(super) fn parse(json: &[u8]) -> Result<Self, Fault> {
        let head: Head = serde_json::from_slice(json).map_err(Fault::Json)?;
        let version = &head.asset.version;
        if version.split('.').next() != Some("2") {
            return Err(Fault::Version(version.chars().take(20).collect()));
        }
        let document: Self = serde_json::from_slice(json).map_err(Fault::Json)?;
        document.check_extensions()?;
        document.check_names()?;
        Ok(document)
    }

    fn check_extensions(&self) -> Result<(), Fault> {
        for name in &self.extensions_required {
            if let Some(extension) = COMPRESSING.iter().find(|known| *known == name) {
                return Err(Fault::Compressed { what: "its geometry is".into(), extension: (*extension).into() });
            }
            let harmless = HARMLESS.iter().any(|prefix| name.starts_with(prefix));
            if !harmless && !READ.contains(&name.as_str()) {
                return Err(Fault::Extension(name.clone()));
            }
        }
        Ok(())
    }

    fn check_names(&self) -> Result<(), Fault> {
        let nodes = self.nodes.iter().map(|node| &node.name);
        let meshes = self.meshes.iter().map(|mesh| &mesh.name);
        let materials = self.materials.iter().map(|material| &material.name);
        check_names("node", nodes)?;
        check_names("mesh", meshes)?;
        check_names("material", materials)
    }

    /// A node's name, else its mesh's, else its number.
    pub(super) fn node_name(&self, node: usize) -> String {
        let of_mesh = || self.mesh_name(self.nodes.get(node)?.mesh?);
        let own = self.nodes.get(node).and_then(|node| given(&node.name));
        own.or_else(of_mesh).map_or_else(|| format!("node {node}"), str::to_owned)
    }

    /// A mesh's name, where it has one.
    pub(super) fn mesh_name(&self, mesh: usize) -> Option<&str> {
        given(&self.meshes.get(mesh)?.name)
    }

    /// A material's name, else its number; `default` where a primitive names none.
    pub(super) fn material_name(&self, material: Option<usize>) -> String {
        let Some(index) = material else {
            return "default".into();
        };
        let own = self.materials.get(index).and_then(|material| given(&material.name));
        own.map_or_else(|| format!("material {index}"), str::to_owned)
    }
}

/// An empty name is none.
fn given(name: &Option<String>) -> Option<&str> {
    name.as_deref().filter(|name| !name.trim().is_empty())
}

fn check_names<'a>(what: &str, names: impl Iterator<Item = &'a Option<String>>) -> Result<(), Fault> {
    for (index, name) in names.enumerate() {
        let bytes = name.as_ref().map_or(0, String::len);
        if bytes > MAX_NAME_BYTES {
            return Err(Fault::LongName { what: format!("{what} {index}"), bytes });
        }
    }
    Ok(())
}
