//! The interface of all finders: the edges, the cost, and the multiplicity.

use crate::mesh::{Incidence, Mesh};
use glam::DVec4;

/// A silhouette edge from vertex to vertex. The face that it bounds is on its left, seen from the light. A silhouette
/// contains an edge of multiplicity ±n n times in sequence.
pub type DirectedEdge = [u32; 2];

/// Finds silhouettes of the mesh that it was made for. All finders return the same edges, in any order.
pub trait SilhouetteFinder: Send {
    /// Appends the silhouette of `mesh` for a light relative to the mesh's origin (sun: w = 0, lamp: w = 1).
    fn find(&mut self, mesh: &Mesh, local_light: DVec4, silhouette: &mut Vec<DirectedEdge>) -> QueryCost;
}

/// The cost of a query.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct QueryCost {
    /// The number of nodes of a tree and of edges (or classes of edges) that were tested.
    pub at: usize,
    /// The number of edges (or classes) that are part of the silhouette.
    pub found: usize,
}

/// Returns the sum of the directions of an edge's faces, each turned towards the light: positive from the edge's first
/// vertex to its second.
pub fn multiplicity(faces: &[Incidence], facing: impl Fn(Incidence) -> bool) -> i32 {
    faces.iter().map(|&face| if facing(face) { face.direction() } else { -face.direction() }).sum()
}

/// Appends an edge as many times as its multiplicity, in the direction of its sign.
pub(super) fn append(silhouette: &mut Vec<DirectedEdge>, [first, second]: [u32; 2], multiplicity: i32) {
    let edge = if multiplicity > 0 { [first, second] } else { [second, first] };
    silhouette.extend(std::iter::repeat_n(edge, multiplicity.unsigned_abs() as usize));
}
