//! A glTF 2.0 file → the parts that stand there, in metres in the world frame.
//!
//! What casts a shadow is read, and nothing else: textures, lights, cameras and animations may be missing or broken.
//! Meshes stand as no animation moves them: with their default morph weights, and with their skins at rest. What is
//! hidden is not there. Points and lines cast nothing and are skipped.
//!
//! A file is never trusted: every index and byte range is checked before it is used, and what is made of it is
//! counted before memory is taken. The files of this folder, in the order of the flow: `container` (bytes → JSON and
//! binary chunk), `document` and `material` (JSON → structure), `scene` (which nodes stand where), `buffers`, `accessor`
//! and `reader` (bytes → numbers), `coarse` (how exact those are), `instances`, `primitive` (which triangles a mesh has),
//! `pose` (morphs and skins), `build` (all of it → parts), `notes` (what the user should know of it); beside it `named`
//! (which other files are the model's).

use crate::mesh::Part;
use crate::site::file::SceneName;
use glam::{DAffine3, DMat3, DVec3};
use std::path::Path;

mod accessor;
mod buffers;
mod build;
mod coarse;
mod container;
mod document;
mod error;
mod instances;
mod material;
mod named;
mod notes;
mod pose;
mod primitive;
mod reader;
mod scene;

pub use error::{Fault, ModelError};
pub(crate) use named::named_by;

/// The most triangles a model may have, instances counted. Their vertices take at most 7.2 GB, their indices 1.2 GB.
pub const MAX_TRIANGLES: u64 = 100_000_000;

/// The most components a model may have: each costs names and adjacency of its own, whatever its size.
pub const MAX_COMPONENTS: usize = 1_000_000;

/// The most numbers that may move the triangles of a model, each triangle's morph targets and joints counted: they cost
/// no memory, but time.
const MAX_MOVES: u64 = 1_000_000_000;

/// What a model file gives.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// In the order of the scene.
    pub parts: Vec<Part>,
    /// What the user should know of how it was read, each a sentence without its stop whose subject is the file.
    pub notes: Vec<String>,
    /// Materials that light passes, each name once. They cast as solid.
    pub see_through: Vec<SeeThrough>,
}

/// A material that is cut out or translucent.
#[derive(Clone, Debug)]
pub struct SeeThrough {
    /// Its name, by which `casts` may mean it.
    pub material: String,
    /// The parts that have it, from 0; one or more.
    pub parts: Vec<usize>,
}

/// Which of a model's axes is up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Up {
    /// As glTF has it: x is east, and −z north.
    #[default]
    Y,
    /// As drawings and maps have it: x is east, and y north.
    Z,
}

/// Which scene of a model is read, and where it stands: it is scaled, turned, then moved.
#[derive(Clone, Debug, PartialEq)]
pub struct Placement {
    /// The scene; the file's default one where none is said.
    pub scene: Option<SceneName>,
    /// Which of the model's axes is up.
    pub up: Up,
    /// Radians clockwise from the model's north (−Z where its y is up, +Y where its z is) to true north; the model is turned
    /// by as much the other way.
    pub north_rad: f64,
    /// Metres east, north and up.
    pub position: DVec3,
    /// Metres per model unit; above zero.
    pub scale: f64,
}

impl Default for Placement {
    fn default() -> Self {
        Self { scene: None, up: Up::Y, north_rad: 0.0, position: DVec3::ZERO, scale: 1.0 }
    }
}

impl Placement {
    /// glTF has y up and north at −z: (x, y, z) becomes (x, −z, y), then the placement follows. A model that is z up has
    /// the world's axes.
    fn world_from_model(&self) -> DAffine3 {
        let upright = match self.up {
            Up::Y => DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y),
            Up::Z => DMat3::IDENTITY,
        };
        let turned = DMat3::from_rotation_z(self.north_rad);
        DAffine3::from_mat3_translation(turned * upright * self.scale, self.position)
    }
}

/// Reads a scene of a `.glb` or `.gltf` file (all root nodes where it has no scenes).
///
/// One part per node and material, in the order of the scene; every part has triangles, and there is at least one.
pub fn load(path: &Path, placement: &Placement) -> Result<Model, ModelError> {
    read(path, placement).map_err(|fault| ModelError { file: path.to_owned(), fault })
}

fn read(path: &Path, placement: &Placement) -> Result<Model, Fault> {
    let bytes = container::read_file(path)?;
    let container = container::open(&bytes, path)?;
    let document = document::Document::parse(container.json)?;
    let world_from_model = placement.world_from_model();
    let is_asked = placement.scene.is_some();
    let standing = scene::place(&document, world_from_model, placement.scene.as_ref())?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let buffers = buffers::Buffers::new(&document, container.binary, folder);
    let build::BuiltScene { parts, see_through } =
        build::build(&document, &buffers, &standing.placed, world_from_model)?;
    if parts.is_empty() {
        let scene = if is_asked { "that scene" } else { "its default scene" };
        return Err(Fault::Empty { scene, way_out: notes::way_out(&document, &standing) });
    }
    Ok(Model { parts, notes: notes::of(&document, &standing, is_asked), see_through })
}
