//! The silhouette: the edges from which a volume's walls are extruded.
//!
//! Every face is turned towards the light. An edge then carries the sum of its faces' directions, its **multiplicity**:
//! 0 inside a surface, ±1 at a border, ±2 at the silhouette of a two-sided surface, more where faces crowd. The rule is
//! that of M. Herf, *Efficient Generation of Soft Shadow Textures*, 1997, section 4.3.3, extended to edges with any
//! number of faces; for two well-wound faces it is the classic rule of *Geometry of Real Time Shadows*, section 4,
//! counted for both halves of the surface. It is right for every mesh, since it only adds up the prisms behind single
//! faces.

#[doc(hidden)]
pub mod brute_force;
mod finder;
#[doc(hidden)]
pub mod hextree;
#[doc(hidden)]
pub mod hierarchy;

#[doc(hidden)]
pub use finder::{DirectedEdge, QueryCost, SilhouetteFinder, multiplicity};

use crate::mesh::Mesh;
use brute_force::BruteForce;
use hextree::Hextree;
use hierarchy::Hierarchy;

/// The finders that work on the processor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProcessorFinder {
    /// One pass over all edges.
    BruteForce,
    /// The tree of the paper.
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
