//! The mesh: welded triangles, grouped by component, with edge adjacency.

use super::CornerPrecision;
use glam::{DVec3, DVec4, Vec3, Vec3A};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

/// A named part of the mesh: a range of its faces. It shares no vertices and no edges with others.
#[derive(Clone, Debug)]
pub struct Component {
    /// The name, such as `node/material` of glTF, or `IfcWindow/Glass` of IFC.
    pub name: String,
    /// Other names by which `casts` and `receives` can select it: those of its node, mesh, material, storey or layer.
    pub aliases: Vec<String>,
    /// The range of its faces.
    pub faces: Range<u32>,
    /// The range of its edges.
    pub edges: Range<u32>,
    /// Triangles that became lines because welding joined two of their corners.
    pub collapsed: Arc<[[u32; 2]]>,
    /// The number of those whose corners were distinct in the file: there welding has changed the shape.
    pub flattened: usize,
    /// The coarsest precision of its corners except strays; `None` if all are finely written.
    pub coarse: Option<CornerPrecision>,
    /// Whether it is terrain: the measured ground.
    pub is_terrain: bool,
}

/// A face at an edge: its index, and whether it runs along the edge (from its first to its second vertex) or against
/// it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Incidence(pub(super) u32);

impl Incidence {
    pub(super) fn new(face: u32, against: bool) -> Self {
        Incidence(face << 1 | u32::from(against))
    }

    /// The face.
    pub fn face(self) -> u32 {
        self.0 >> 1
    }

    /// +1 if the face runs along the edge, −1 if it runs against it.
    pub fn direction(self) -> i32 {
        1 - 2 * (self.0 & 1) as i32
    }
}

/// Welded triangles with planes and adjacency, in `f32` relative to `origin`. Clones share the large data.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// The world position of the local origin, in whole metres unless it was given.
    pub origin: DVec3,
    /// The vertices, metres relative to `origin`, shared with meshes that were made from this one.
    pub vertices: Arc<Vec<Vec3>>,
    /// Three vertices per face, counter-clockwise seen from outside; grouped by component.
    pub faces: Arc<Vec<[u32; 3]>>,
    pub(super) planes: Arc<OnceLock<Vec<DVec4>>>,
    /// The box around what stands together, relative to `origin`: lowest and highest corner. Strays are outside of it.
    pub(super) home: [Vec3; 2],
    /// The components.
    pub components: Vec<Component>,
    /// Two vertices per edge, the lower index first; grouped by component.
    pub edges: Arc<Vec<[u32; 2]>>,
    /// The index in `incidences` of each edge's first face; one entry more than `edges`.
    pub(super) edge_first: Arc<Vec<u32>>,
    pub(super) incidences: Arc<Vec<Incidence>>,
    /// In the order of faces and edges; at least one.
    pub(super) blocks: Arc<[MeshBlock]>,
}

/// Consecutive faces that share no vertex with others, and their edges.
#[derive(Clone, Debug)]
pub(crate) struct MeshBlock {
    pub(crate) faces: Range<u32>,
    pub(crate) edges: Range<u32>,
}

impl Mesh {
    /// The greatest number of faces of a mesh.
    pub const MOST_FACES: usize = 1 << 30;
    /// The greatest distance of a vertex from the origin, metres. There, `f32` still has steps of half a metre, which
    /// is coarse, but a model so large has the same steps in its file.
    pub const FARTHEST_M: f64 = 8.0e6;

    /// Blocks of faces, connected only within themselves, so that work along edges can be done block by block.
    pub(crate) fn blocks(&self) -> &[MeshBlock] {
        &self.blocks
    }

    /// The number of blocks.
    #[cfg(feature = "test-hooks")]
    pub fn block_count(&self) -> usize {
        self.blocks.len()
    }

    /// The faces at an edge.
    pub fn faces_at(&self, edge: usize) -> &[Incidence] {
        &self.incidences[self.edge_first[edge] as usize..self.edge_first[edge + 1] as usize]
    }

    /// The corners of a face, metres relative to `origin`.
    pub fn corners(&self, face: usize) -> [Vec3; 3] {
        self.faces[face].map(|vertex| self.vertices[vertex as usize])
    }

    /// The box around the faces in metres of the world frame: lowest and highest corner. `None` without faces.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        self.bounds_of(0..self.faces.len() as u32)
    }

    /// The same for a range of faces.
    pub fn bounds_of(&self, run: Range<u32>) -> Option<(DVec3, DVec3)> {
        self.bounds_where(run, |_| true)
    }

    pub(super) fn bounds_where(&self, run: Range<u32>, counts: impl Fn(u32) -> bool + Sync) -> Option<(DVec3, DVec3)> {
        /// The least number of faces for one task.
        const AT_ONCE: usize = 1 << 12;
        let none = || (Vec3A::INFINITY, Vec3A::NEG_INFINITY);
        let both = |one: (Vec3A, Vec3A), other: (Vec3A, Vec3A)| (one.0.min(other.0), one.1.max(other.1));
        let of_face = |bounds: (Vec3A, Vec3A), face: &[u32; 3]| {
            let corners = face.iter().filter(|&&vertex| counts(vertex));
            let corners = corners.map(|&vertex| Vec3A::from(self.vertices[vertex as usize]));
            corners.fold(bounds, |bounds, corner| both(bounds, (corner, corner)))
        };
        let faces = self.faces[run.start as usize..run.end as usize].par_iter().with_min_len(AT_ONCE);
        let (low, high) = faces.fold(none, of_face).reduce(none, both);
        (low.x <= high.x).then(|| (low.as_dvec3() + self.origin, high.as_dvec3() + self.origin))
    }

    /// As [`Mesh::bounds`], for what stands together, without strays.
    pub fn bounds_at_home(&self) -> Option<(DVec3, DVec3)> {
        if self.are_all_at_home() {
            return self.bounds();
        }
        self.bounds_where(0..self.faces.len() as u32, |vertex| self.is_at_home(vertex)).or_else(|| self.bounds())
    }

    /// The box around what stands together, metres relative to `origin`: lowest and highest corner.
    pub fn home(&self) -> [Vec3; 2] {
        self.home
    }

    /// Whether there are no strays, as in most meshes.
    pub(crate) fn are_all_at_home(&self) -> bool {
        /// The least number of vertices for one task.
        const AT_ONCE: usize = 1 << 14;
        let vertices = (0..self.vertices.len() as u32).into_par_iter().with_min_len(AT_ONCE);
        vertices.all(|vertex| self.is_at_home(vertex))
    }

    /// Whether a vertex belongs to what stands together, and is not a stray.
    pub fn is_at_home(&self, vertex: u32) -> bool {
        let [low, high] = self.home;
        let at = self.vertices[vertex as usize];
        at.cmpge(low).all() && at.cmple(high).all()
    }

    /// The height of the highest vertex of any face, metres of the world frame; −∞ without faces.
    pub fn top(&self) -> f64 {
        self.bounds().map_or(f64::NEG_INFINITY, |(_, high)| high.z)
    }

    /// Whether a face is terrain; `false` for an index without a face.
    pub fn is_terrain(&self, face: u32) -> bool {
        let at = self.components.partition_point(|component| component.faces.end <= face);
        self.components.get(at).is_some_and(|component| component.is_terrain)
    }

    /// Converts a homogeneous light (sun: w = 0, lamp: w = 1) from the world frame to the frame of the planes, relative
    /// to `origin`.
    pub fn local_light(&self, light: DVec4) -> DVec4 {
        light - DVec4::from((self.origin, 0.0)) * light.w
    }
}
