//! Parses the JSON into the structure of what casts. Textures, images, cameras and animations are not parsed.
//!
//! `gltf::json` reads meshes, accessors, views and buffers. Nodes are our own types, since it keeps transforms in
//! `f32`, whose steps are 25 cm at map coordinates far from the origin. Scenes and materials are our own types, since
//! it refuses scenes without nodes and broken textures.

use super::Fault;
use super::material::Material;
use super::own::{self, OwnExtras, OwnScene};
use crate::formats::composed;
use gltf::json::{Accessor, Buffer, Mesh, buffer::View};
use serde::{Deserialize, Deserializer};
use serde_json::Value;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// The longest name, bytes. Every component carries the names of its node, mesh and material.
const MAX_NAME_BYTES: usize = 1000;

/// Prefixes of extensions for looks, sounds, descriptions and interaction. Whatever they contain, the triangles stay
/// the same.
const HARMLESS: [&str; 25] = [
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
    "NV_materials_",
    "BENTLEY_materials_",
    "CESIUM_primitive_outline",
    "AGI_stk_metadata",
    "FB_geometry_metadata",
    "GODOT_single_root",
    "KHR_node_selectability",
    "KHR_node_hoverability",
];

/// Extensions about geometry that are read.
const READ: [&str; 6] = [
    "KHR_mesh_quantization",
    "EXT_mesh_gpu_instancing",
    "KHR_node_visibility",
    "KHR_draco_mesh_compression",
    "EXT_meshopt_compression",
    "KHR_meshopt_compression",
];

/// The geometry in a glTF file. Indices are not checked yet.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Document {
    #[serde(default)]
    extensions_required: Vec<String>,
    /// The default scene.
    pub scene: Option<usize>,
    #[serde(default)]
    pub scenes: Vec<DocumentScene>,
    #[serde(default)]
    pub nodes: Vec<Node>,
    #[serde(default)]
    pub meshes: Vec<Mesh>,
    #[serde(default)]
    pub skins: Vec<Skin>,
    #[serde(default)]
    pub materials: Vec<Material>,
    #[serde(default)]
    pub accessors: Vec<Accessor>,
    #[serde(default)]
    pub buffer_views: Vec<View>,
    #[serde(default)]
    pub buffers: Vec<Buffer>,
    /// The extensions of the whole file.
    #[serde(default)]
    extensions: Value,
}

/// The part that all versions of glTF share; the rest of glTF 1.0 has a different structure.
#[derive(Deserialize)]
struct Head {
    asset: Asset,
}

#[derive(Deserialize)]
struct Asset {
    version: String,
}

#[derive(Deserialize)]
pub(super) struct DocumentScene {
    #[serde(default, deserialize_with = "text")]
    name: Option<String>,
    #[serde(default)]
    pub nodes: Vec<usize>,
    #[serde(default, rename = "extras", deserialize_with = "own::read_scene")]
    pub own: OwnScene,
}

/// The nodes that move the vertices of a mesh.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Skin {
    #[serde(default)]
    pub joints: Vec<usize>,
    /// The index of an accessor.
    pub inverse_bind_matrices: Option<usize>,
}

#[derive(Deserialize)]
pub(super) struct Node {
    name: Option<String>,
    pub mesh: Option<usize>,
    pub skin: Option<usize>,
    weights: Option<Vec<f32>>,
    #[serde(default)]
    pub children: Vec<usize>,
    /// The matrix in column-major order.
    pub matrix: Option<Box<[f64; 16]>>,
    pub translation: Option<[f64; 3]>,
    /// The rotation as a quaternion x, y, z, w.
    pub rotation: Option<[f64; 4]>,
    pub scale: Option<[f64; 3]>,
    #[serde(default)]
    pub extensions: NodeExtensions,
    #[serde(default, rename = "extras", deserialize_with = "own::read")]
    pub own: OwnExtras,
}

#[derive(Default, Deserialize)]
pub(super) struct NodeExtensions {
    #[serde(rename = "EXT_mesh_gpu_instancing")]
    pub instancing: Option<Instancing>,
    #[serde(rename = "KHR_node_visibility")]
    visibility: Option<Visibility>,
}

/// Whether a node is visible, with everything below it.
#[derive(Deserialize)]
struct Visibility {
    visible: Option<bool>,
}

impl Node {
    /// Whether it shows itself and what is below it.
    pub(super) fn is_visible(&self) -> bool {
        self.extensions.visibility.as_ref().and_then(|visibility| visibility.visible).unwrap_or(true)
    }
}

/// The transforms of copies of a node's mesh.
#[derive(Deserialize)]
pub(super) struct Instancing {
    /// The accessors, by the names of their attributes.
    pub attributes: BTreeMap<String, usize>,
}

impl Document {
    /// Parses the JSON of a file, and checks that its version and extensions can be read. `applied` are extensions that
    /// the caller applies itself.
    pub(super) fn parse(json: &[u8], applied: &[&str]) -> Result<Self, Fault> {
        let head: Head = serde_json::from_slice(json).map_err(Fault::Json)?;
        let version = &head.asset.version;
        if version.split('.').next() != Some("2") {
            return Err(Fault::Version(version.chars().take(20).collect()));
        }
        let mut document: Self = serde_json::from_slice(json).map_err(Fault::Json)?;
        document.check_extensions(applied)?;
        document.check_names()?;
        document.compose_names();
        Ok(document)
    }

    fn check_extensions(&self, applied: &[&str]) -> Result<(), Fault> {
        for name in &self.extensions_required {
            if ![&READ, applied].iter().any(|known| known.contains(&name.as_str())) && !is_harmless(name) {
                return Err(Fault::Extension(name.clone()));
            }
        }
        Ok(())
    }

    /// The data of an extension for the whole file.
    pub(super) fn extension(&self, name: &str) -> Option<&Value> {
        self.extensions.get(name)
    }

    /// The extensions that the file requires but that are not read.
    pub(super) fn read_past(&self) -> impl Iterator<Item = &str> {
        self.extensions_required.iter().map(String::as_str).filter(|name| is_harmless(name))
    }

    /// The default weights of a node's morph targets: its own, otherwise its mesh's.
    pub(super) fn weights(&self, node: usize, mesh: usize) -> &[f32] {
        let own = self.nodes.get(node).and_then(|node| node.weights.as_deref());
        own.or_else(|| self.meshes.get(mesh)?.weights.as_deref()).unwrap_or_default()
    }

    fn check_names(&self) -> Result<(), Fault> {
        let nodes = self.nodes.iter().map(|node| &node.name);
        let meshes = self.meshes.iter().map(|mesh| &mesh.name);
        let materials = self.materials.iter().map(|material| &material.name);
        check_names("scene", self.scenes.iter().map(|scene| &scene.name))?;
        check_names("node", nodes)?;
        check_names("mesh", meshes)?;
        check_names("material", materials)
    }

    /// Brings all names into one normal form, so that a name is the same in each file.
    fn compose_names(&mut self) {
        let scenes = self.scenes.iter_mut().map(|scene| &mut scene.name);
        let nodes = self.nodes.iter_mut().map(|node| &mut node.name);
        let meshes = self.meshes.iter_mut().map(|mesh| &mut mesh.name);
        let materials = self.materials.iter_mut().map(|material| &mut material.name);
        for name in scenes.chain(nodes).chain(meshes).chain(materials).flatten() {
            if let Cow::Owned(composed) = composed(name) {
                *name = composed;
            }
        }
    }

    /// A scene's name, if it has one.
    pub(super) fn scene_name(&self, scene: usize) -> Option<&str> {
        given(&self.scenes.get(scene)?.name)
    }

    /// A node's name, otherwise its mesh's, otherwise its index.
    pub(super) fn node_name(&self, node: usize) -> String {
        let of_mesh = || self.mesh_name(self.nodes.get(node)?.mesh?);
        let own = self.nodes.get(node).and_then(|node| given(&node.name));
        own.or_else(of_mesh).map_or_else(|| format!("node {node}"), str::to_owned)
    }

    /// A mesh's name, if it has one.
    pub(super) fn mesh_name(&self, mesh: usize) -> Option<&str> {
        given(&self.meshes.get(mesh)?.name)
    }

    /// Whether a material is see-through; see [`Material::is_see_through`].
    pub(super) fn is_see_through(&self, material: usize, has_faded_vertices: bool) -> bool {
        self.materials.get(material).is_some_and(|material| material.is_see_through(has_faded_vertices))
    }

    /// A material's name, otherwise its index; `default` for a primitive without a material.
    pub(super) fn material_name(&self, material: Option<usize>) -> String {
        let Some(index) = material else {
            return "default".into();
        };
        let own = self.materials.get(index).and_then(|material| given(&material.name));
        own.map_or_else(|| format!("material {index}"), str::to_owned)
    }
}

/// A value if it is text: a file is not refused for a malformed scene name.
fn text<'de, D: Deserializer<'de>>(from: D) -> Result<Option<String>, D::Error> {
    match Value::deserialize(from)? {
        Value::String(text) => Ok(Some(text)),
        _ => Ok(None),
    }
}

fn is_harmless(extension: &str) -> bool {
    HARMLESS.iter().any(|prefix| extension.starts_with(prefix))
}

/// Treats an empty name as missing.
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
