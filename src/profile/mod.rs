//! The answer on the plan: shaded time per cell, and the raster's position.

#[doc(hidden)]
pub mod accumulate;
#[doc(hidden)]
pub mod comparison;
mod provenance;
mod shaded;
mod statistics;
mod unfinished;

pub use provenance::{Provenance, Timings};
pub use shaded::Shaded;
#[doc(hidden)]
pub use shaded::{ShadedCells, ShadedPart};
pub use statistics::Statistics;
pub use unfinished::Unfinished;

use crate::view::Grid;

/// The raster of shaded time.
///
/// Sums are exact integers, the same on every machine: seconds times the covered share of the sun in 1/255.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile<S = Shaded> {
    /// The grid of the raster.
    pub grid: Grid,
    /// The shaded time of each cell, without night.
    pub shaded: S,
    /// Seconds of the window with the sun above the horizon.
    pub day_secs: u32,
    /// Seconds of the window with the sun below the horizon.
    pub night_secs: u32,
}

impl Profile {
    /// Hours of shadow in a cell, 0 to `day_secs / 3600`.
    pub fn hours(&self, cell: usize) -> f32 {
        hours(self.shaded.of(cell))
    }
}

/// Converts a shaded time to hours.
pub fn hours(shaded: u64) -> f32 {
    (shaded as f64 / (255.0 * 3600.0)) as f32
}
