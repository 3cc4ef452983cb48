//! What stands there: welded, indexed triangles with named components and edge adjacency.

use glam::{DVec3, DVec4, Vec3};
use std::ops::Range;

/// One component as a model file gives it: triangles of one node and one material, before welding.
#[derive(Clone, Debug, Default)]
pub struct Part {
    /// `node/material`, or `node` where the node has one material.
    pub name: String,
    /// The names by which `casts` and `receives` may mean it: of its node, mesh and material.
    pub aliases: Vec<String>,
    /// Metres in the world frame.
    pub positions: Vec<DVec3>,
    /// Counter-clockwise seen from outside (mirroring transforms already undone).
    pub triangles: Vec<[u32; 3]>,
}

/// A named part of the mesh, a run of its faces. Adjacency never crosses it.
#[derive(Clone, Debug)]
pub struct Component {
    /// `node/material`, or `node` where the node has one material.
    pub name: String,
    /// The names by which `casts` and `receives` may mean it: of its node, mesh and material.
    pub aliases: Vec<String>,
    /// Its faces.
    pub faces: Range<u32>,
    /// Its edges.
    pub edges: Range<u32>,
}

/// Welded triangles with planes and adjacency, `f32` around `origin`.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// World position of the local origin, whole metres.
    pub origin: DVec3,
    /// Metres around `origin`.
    pub vertices: Vec<Vec3>,
    /// Three vertices a face, counter-clockwise seen from outside; grouped by component.
    pub faces: Vec<[u32; 3]>,
    /// Per face the unit plane (n, −n·p) around `origin`; all zero where the face has no area.
    pub planes: Vec<DVec4>,
    /// The parts.
    pub components: Vec<Component>,
}
