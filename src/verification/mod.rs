//! The result of comparing every technique with ray casting, over the instants of a study.

mod difference;
mod edges;
mod tally;

pub use difference::Difference;
pub use edges::{Edges, is_edge_cell};
pub use tally::Tally;

use crate::choice::{Promise, Truth};
use crate::profile::{Provenance, ShadedTime};
use crate::view::Grid;

/// All techniques on one site.
#[derive(Clone, Debug)]
pub struct Verification {
    /// The plan's raster.
    pub grid: Grid,
    /// How many instants were compared; night is left out.
    pub instants: usize,
    /// Whether every part that casts is closed and well wound.
    pub clean: bool,
    /// Which part of the edge cells of an exact technique may differ.
    pub edge_share: f64,
    /// To how many points of the sun's disc rays were cast.
    pub sun_samples: u32,
    /// How long ray casting took to the disc, seconds an instant.
    pub disc_secs: f64,
    /// A technique each, ray casting last.
    pub rows: Vec<Row>,
}

impl Verification {
    /// Whether a row holds; none where the row decides nothing.
    pub fn row_holds(&self, row: &Row) -> Option<bool> {
        match row.promise {
            Promise::Exact => Some(row.difference.holds(self.edge_share)),
            Promise::Same => Some(row.difference.differ() == 0),
            Promise::ExactButForMap | Promise::Near => None,
        }
    }

    /// The rows that do not hold.
    pub fn failed(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(|row| self.row_holds(row) == Some(false))
    }
}

/// One technique.
#[derive(Clone, Debug)]
pub struct Row {
    /// What drew it.
    pub drawn: Provenance,
    /// What it was held against.
    pub against: Truth,
    /// What it promises.
    pub promise: Promise,
    /// The cells that differ: their share is off by more than half the sun.
    pub difference: Difference,
    /// Cells that differ beside what is thinner than a cell; not in `difference`.
    pub thin: u64,
    /// Cells that the map decided otherwise than the stencil; not in `difference`. Absent without such a map.
    pub missed: Option<u64>,
    /// How far the furthest of the cells that differ lies from a shadow edge of the truth, in cells; absent where none does.
    pub furthest: Option<f64>,
    /// By how much the share is off, 0 to 1, in the mean of all cells.
    pub share_off: f64,
    /// By how many hours the profile is off; absent where the instants have no weight.
    pub hours_off: Option<HoursDifference>,
    /// How long an instant took until the mask was in memory, seconds; the first one, which also builds, counts only
    /// where it is alone.
    pub secs: f64,
}

/// How two profiles differ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HoursDifference {
    /// In the worst cell, hours.
    pub largest: f64,
    /// In the mean of all cells, hours.
    pub mean: f64,
}

impl HoursDifference {
    /// Between sums of shaded time in 1/255 s.
    pub fn between(drawn: &ShadedTime, truth: &ShadedTime) -> HoursDifference {
        let off = || drawn.iter().zip(truth.iter()).map(|(drawn, truth)| drawn.abs_diff(truth));
        let hours = |sum: u64| sum as f64 / (255.0 * 3600.0);
        HoursDifference {
            largest: hours(off().max().unwrap_or(0)),
            mean: hours(off().sum()) / drawn.len().max(1) as f64,
        }
    }
}
