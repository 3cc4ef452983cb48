//! The mesh: welded, indexed triangles with named components and edge adjacency.
//!
//! Real models are open, crowded and flipped. Nothing is repaired, and nothing refused: the mesh is what the file says,
//! [`report`] says what is wrong with it, and the rule in [`crate::volume`] makes the shadows of defective parts right.

mod adjacency;
pub(crate) mod blocks;
mod build;
mod error;
mod part;
#[doc(hidden)]
pub mod patches;
mod planes;
#[doc(hidden)]
pub mod report;
pub(crate) mod scan;
mod spacing;
mod together;
mod triangles;
mod weld;

pub(crate) use adjacency::lowest;
pub use error::MeshError;
pub use part::{CornerPrecision, Part};
#[doc(hidden)]
pub use planes::plane_faces;
pub(crate) use triangles::MeshBlock;
pub use triangles::{Component, Incidence, Mesh};
