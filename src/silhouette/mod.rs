//! What bounds the shadow: the edges from which a volume's walls hang.
//!
//! Every face is turned towards the light. An edge then carries the sum of its faces' directions, its
//! **multiplicity**: 0 inside a surface, ±1 at a border, ±2 at the silhouette of a two-sided surface, more
//! where faces crowd. (Seed 002, section 4.3.3, carried to edges with any number of faces; for two well-wound
//! faces this is the classic rule of seed 004, section 4, counted for both halves of the surface.)
//! It is right for every mesh, since it only adds up the prisms that the single faces cut out of the light.

#[doc(hidden)]
pub mod brute_force;
#[doc(hidden)]
pub mod hextree;
#[doc(hidden)]
pub mod hierarchy;

use crate::mesh::{Incidence, Mesh};
use brute_force::BruteForce;
use glam::DVec4;
use hextree::Hextree;
use hierarchy::Hierarchy;

/// A silhouette edge, from vertex to vertex: the face it bounds lies on its left, seen from the light.
/// An edge of multiplicity ±n stands n times in a row in a silhouette.
#[doc(hidden)]
pub type DirectedEdge = [u32; 2];

/// Finds silhouettes of the mesh for which it was made. All finders give the same edges, in any order.
#[doc(hidden)]
pub trait SilhouetteFinder: Send {
    /// Appends the silhouette of `mesh` for a light around the mesh's origin (sun: w = 0, lamp: w = 1).
    fn find(&mut self, mesh: &Mesh, local_light: DVec4, silhouette: &mut Vec<DirectedEdge>) -> QueryCost;
}

/// How much a query looked at for what it found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[doc(hidden)]
pub struct QueryCost {
    /// Nodes of a tree and edges (or classes of edges) that were tested.
    pub at: usize,
    /// Edges (or classes) of them that are silhouette.
    pub found: usize,
}

/// The finders that work on the processor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProcessorFinder {
    /// One pass over all edges.
    BruteForce,
    /// The paper's tree.
    Hextree {
        /// Levels below the root.
        depth: u32,
    },
    /// Classes of edges under a bounding hierarchy.
    Hierarchy,
}

impl ProcessorFinder {
    /// Makes the finder for a mesh.
    #[doc(hidden)]
    pub fn build(self, mesh: &Mesh) -> Box<dyn SilhouetteFinder> {
        match self {
            ProcessorFinder::BruteForce => Box::new(BruteForce),
            ProcessorFinder::Hextree { depth } => Box::new(Hextree::new(mesh, depth)),
            ProcessorFinder::Hierarchy => Box::new(Hierarchy::default()),
        }
    }
}

/// The sum of the directions of an edge's faces, each turned towards the light: positive from the edge's first vertex
/// to its second.
#[doc(hidden)]
pub fn multiplicity(faces: &[Incidence], facing: impl Fn(Incidence) -> bool) -> i32 {
    faces.iter().map(|&face| if facing(face) { face.direction() } else { -face.direction() }).sum()
}

/// Appends an edge as often as its multiplicity says, in the direction of its sign.
fn append(silhouette: &mut Vec<DirectedEdge>, [first, second]: [u32; 2], multiplicity: i32) {
    let edge = if multiplicity > 0 { [first, second] } else { [second, first] };
    silhouette.extend(std::iter::repeat_n(edge, multiplicity.unsigned_abs() as usize));
}
