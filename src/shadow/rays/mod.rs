//! Tests rays against triangles: a tree of boxes and blocks of eight triangles, both tested with SIMD; what these
//! cannot exclude is decided in double precision. Parallel rays that are close together are traced at once, as a beam.

mod beam;
mod caster;
mod cells;
#[cfg(feature = "test-hooks")]
mod counted;
mod frame;
mod lanes;
#[cfg(feature = "test-hooks")]
mod plain;
mod prune;
mod raster;
mod search;
mod shear;
mod tree;

pub use caster::RayCaster;
pub use cells::CellSet;
#[cfg(feature = "test-hooks")]
pub use counted::RayCounts;
pub use lanes::SimdLevel;
#[cfg(feature = "test-hooks")]
pub use plain::PlainCaster;
pub use raster::{BlockedCells, RasterFate, RayRaster};
pub use shear::Shear;
