//! Rays against triangles: a tree of boxes, and triangles in blocks of eight, both asked with SIMD; what those cannot rule
//! out is decided in double precision. Parallel rays that lie close together are asked at once, as a beam.

mod beam;
mod caster;
mod frame;
mod lanes;
#[cfg(feature = "test-hooks")]
mod plain;
mod prune;
mod search;
mod shear;
mod tree;

pub use caster::RayCaster;
pub use lanes::SimdLevel;
#[cfg(feature = "test-hooks")]
pub use plain::PlainCaster;
pub use shear::Shear;
