//! Reads glTF 2.0 files into parts, in the file's own units and axes.
//!
//! Only what casts a shadow is read: textures, lights, cameras and animations may be missing or broken. Meshes are
//! posed without animation: with their default morph weights, and with their skins at rest. Hidden nodes are left out.
//! Points and lines cast nothing, and are skipped.
//!
//! A file is never trusted: every index and byte range is checked before it is used, and sizes are computed before
//! memory is allocated. The files of this folder, in the order of the flow: `container` (finds the JSON and the binary
//! chunk), `document` and `material` (parse the JSON), `scene` (places nodes), `buffers`, `accessor` and `reader` (read
//! numbers), `draco` and `meshopt` (decompress), `coarse` (measures precision), `instances`, `primitive` (the triangles
//! of a mesh), `features` (the features that they belong to), `pose` (morphs and skins), `build` (makes parts), `own`
//! (data that this program wrote itself), and `notes`; also `named` (the other files of a model).

use super::{Format, MAX_COMPONENTS, MAX_TRIANGLES, Model, ModelFault, ReadOptions, SeeThrough};
use crate::message::message;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

mod accessor;
mod buffers;
mod build;
mod coarse;
mod container;
mod document;
mod draco;
mod error;
mod feature_attributes;
mod features;
mod instances;
mod material;
mod meshopt;
mod named;
mod notes;
mod own;
mod pose;
mod primitive;
mod reader;
mod scene;

pub(super) use buffers::percent_decode;
pub use error::Fault;
pub(super) use features::batch_names;

/// glTF 2.0, `.glb` and `.gltf`.
pub struct Gltf;

impl Format for Gltf {
    fn name(&self) -> &'static str {
        "glTF"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["glb", "gltf"]
    }

    fn keys(&self) -> &'static [&'static str] {
        &["scene"]
    }

    fn begins(&self, head: &[u8]) -> bool {
        head.starts_with(b"glTF")
    }

    /// Reads a scene (all root nodes if the file has no scenes): one part per node and material, in the order of the
    /// scene.
    fn read(&self, path: &Path, options: &ReadOptions) -> Result<Model, ModelFault> {
        Ok(read(path, options)?)
    }

    /// Draco's decoder is from another library. A missing scene is reported in this process, which knows who asked for
    /// it.
    fn is_foreign(&self, path: &Path, options: &ReadOptions) -> bool {
        let Some(json) = container::json_of_file(path) else { return false };
        let Ok(document) = document::Document::parse(&json, &[]) else { return false };
        draco::is_used(&document) && scene::place(&document, options.scene.as_ref()).is_ok()
    }

    fn named_by(&self, path: &Path) -> Vec<PathBuf> {
        named::named_by(path)
    }
}

fn read(path: &Path, options: &ReadOptions) -> Result<Model, Fault> {
    read_bytes(&container::read_file(path)?, path, options, GltfContext::default())
}

/// The JSON of a glTF in memory.
pub(super) fn json_in(bytes: &[u8]) -> Option<&[u8]> {
    container::open(bytes).ok().map(|container| container.json)
}

/// What the caller of [`read_bytes`] knows about a glTF.
#[derive(Clone, Copy, Default)]
pub(super) struct GltfContext<'a> {
    /// Extensions that the caller applies itself.
    pub applied: &'a [&'a str],
    /// The names of a tile's features.
    pub batch: &'a [String],
}

/// Reads a glTF in memory, such as a content of 3D Tiles. Paths in it are relative to `path`.
pub(super) fn read_bytes(
    bytes: &[u8],
    path: &Path,
    options: &ReadOptions,
    context: GltfContext,
) -> Result<Model, Fault> {
    let container = container::open(bytes)?;
    let document = document::Document::parse(container.json, context.applied)?;
    let is_asked = options.scene.is_some();
    let standing = scene::place(&document, options.scene.as_ref())?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut buffers = buffers::Buffers::new(&document, container.binary, folder);
    let meshes: BTreeSet<usize> = standing.placed.iter().map(|place| place.mesh).collect();
    meshes.into_iter().try_for_each(|mesh| buffers.unpack(mesh))?;
    let features = features::Features::of(&document, &buffers, context.batch);
    let build::BuiltScene { parts, kinds, from_ground, see_through } =
        build::build(&document, &buffers, &features, &standing.placed, options.told_step(1.0))?;
    if parts.is_empty() {
        let scene = if is_asked { "that scene" } else { "its default scene" };
        return Err(Fault::Empty { scene, way_out: notes::way_out(&document, &standing) });
    }
    let mut notes = notes::of(&document, &standing, is_asked);
    if features.is_damaged {
        notes.push(message!["has a damaged table of names, so its features are not separated"; "export it again"]);
    }
    let scene = standing.scene.and_then(|scene| document.scenes.get(scene));
    let own::OwnScene { anchor, unit_m, up_is_said } = scene.map(|scene| scene.own.clone()).unwrap_or_default();
    let anchors = anchor.into_iter().collect();
    // glTF is in metres and y up, but many programs export something else. Unless this program wrote the file, nothing
    // is stated, so that the unit and the axis can be doubted.
    Ok(Model { parts, kinds, notes, see_through, anchors, unit_m, up_is_said, from_ground, ..Model::default() })
}
