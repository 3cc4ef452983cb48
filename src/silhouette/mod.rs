//! What bounds the shadow: the edges from which a volume's walls hang.
//!
//! Every face is turned towards the light. An edge then carries the sum of its faces' directions, its
//! **multiplicity**: 0 inside a surface, ±1 at a border, ±2 at the silhouette of a two-sided surface, more
//! where faces crowd. (Seed 002, section 4.3.3, carried to edges with any number of faces; for two well-wound
//! faces this is the classic rule of seed 004, section 4, counted for both halves of the surface.)
//! It is right for every mesh, since it only adds up the prisms that the single faces cut out of the light.

pub mod brute_force;

use crate::mesh::Mesh;

/// A silhouette edge, from vertex to vertex: the face it bounds lies on its left, seen from the light.
/// An edge of multiplicity ±n stands n times in a silhouette.
pub type DirectedEdge = [u32; 2];

/// Finds silhouettes of one mesh. All finders give the same edges, in any order.
pub trait SilhouetteFinder: Send {
    /// Appends the silhouette for the light that `facing` was asked with ([`Mesh::facing`]).
    fn find(&self, mesh: &Mesh, facing: &[bool], silhouette: &mut Vec<DirectedEdge>);

    /// The name by which people know the finder.
    fn name(&self) -> &'static str;
}

/// The multiplicity of an edge: positive from its first vertex to its second.
pub fn multiplicity(mesh: &Mesh, facing: &[bool], edge: usize) -> i32 {
    let direction = |&face: &crate::mesh::Incidence| {
        if facing[face.face() as usize] { face.direction() } else { -face.direction() }
    };
    mesh.faces_at(edge).iter().map(direction).sum()
}
