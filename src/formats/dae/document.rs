//! The contents of a Collada file by their ids.

use super::effect::DaeEffect;
use crate::formats::face_cutter::FaceCutter;
use crate::formats::left_out::LeftOutTally;
use glam::{DAffine3, DVec3};
use rustc_hash::FxHashMap;

/// The up axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DaeUp {
    X,
    Y,
    Z,
}

pub(super) struct DaeMaterial {
    pub name: String,
    pub effect: Option<String>,
}

/// A scene: its name, and the nodes that stand in it.
#[derive(Default)]
pub(super) struct DaeScene {
    pub id: String,
    pub name: String,
    pub roots: Vec<usize>,
}

/// A geometry: triangles by the symbol of their material.
#[derive(Default)]
pub(super) struct DaeGeometry {
    pub name: String,
    pub positions: Vec<DVec3>,
    /// Every vertex index is within the positions.
    pub surfaces: Vec<(Option<String>, Vec<[u32; 3]>)>,
}

pub(super) struct DaeNode {
    /// Its name, otherwise its id; empty if it has neither.
    pub name: String,
    pub parent_from_node: DAffine3,
    pub children: Vec<usize>,
    /// The ids of nodes that are instantiated here.
    pub instances: Vec<String>,
    pub geometries: Vec<GeometryInstance>,
    /// Whether it is placed in a way that is not read, such as a camera's.
    pub is_astray: bool,
}

/// A geometry instantiated at a node.
pub(super) struct GeometryInstance {
    pub geometry: String,
    /// The geometry's symbols for materials, with the materials' ids.
    pub materials: Vec<(String, String)>,
}

/// The contents of a file.
pub(super) struct DaeDocument {
    pub unit_m: Option<f64>,
    /// The file's statement of its unit, if that is not a length.
    pub odd_unit: Option<String>,
    pub up: Option<DaeUp>,
    pub geometries: FxHashMap<String, DaeGeometry>,
    /// The nodes of all libraries and scenes.
    pub nodes: Vec<DaeNode>,
    pub node_of: FxHashMap<String, usize>,
    pub scenes: Vec<DaeScene>,
    /// The id of the scene that is shown.
    pub scene: Option<String>,
    pub materials: FxHashMap<String, DaeMaterial>,
    pub effects: FxHashMap<String, DaeEffect>,
    pub left_out: LeftOutTally,
    pub cutter: FaceCutter,
    /// The triangles of all geometries, each geometry counted once.
    pub triangles: u64,
}

impl DaeDocument {
    /// Whether a material is see-through.
    pub(super) fn is_see_through(&self, material: &DaeMaterial) -> bool {
        let effect = material.effect.as_ref().and_then(|effect| self.effects.get(effect));
        effect.is_some_and(DaeEffect::is_see_through)
    }
}
