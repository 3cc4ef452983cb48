//! The result of comparing every technique with ray casting, over the instants of a study.

mod difference;
mod edges;
mod tally;

pub use difference::Difference;
pub use edges::{Edges, is_edge_cell};
pub use tally::Tally;

use crate::choice::{Promise, Truth};
use crate::profile::{Provenance, Shaded};
use crate::view::Grid;

/// The comparison of all techniques on one site.
#[derive(Clone, Debug)]
pub struct Verification {
    /// The plan's raster.
    pub grid: Grid,
    /// The number of instants that were compared, without night.
    pub instants: usize,
    /// Whether every casting part is closed and well wound.
    pub clean: bool,
    /// The share of the edge cells of an exact technique that may differ.
    pub edge_share: f64,
    /// The number of points of the sun's disc for ray casting.
    pub sun_samples: u32,
    /// The time of ray casting to the disc, seconds per instant.
    pub disc_secs: f64,
    /// The façades and roofs that were compared; `None` where nothing has any.
    pub surfaces: Option<ComparedSurfaces>,
    /// One row per technique, ray casting last.
    pub rows: Vec<Row>,
}

/// Façades and roofs on which techniques were compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComparedSurfaces {
    /// A texel's side, metres.
    pub cell: f64,
    /// The number of texels.
    pub texels: usize,
    /// The share of the edge texels of an exact technique that may differ.
    pub edge_share: f64,
}

impl Verification {
    /// Whether a row passes; `None` if the row does not decide.
    pub fn row_holds(&self, row: &Row) -> Option<bool> {
        match row.promise {
            Promise::Exact => Some(row.difference.holds(self.edge_share_of(row))),
            Promise::Same => Some(row.difference.differ() == 0),
            Promise::ExactButForMap | Promise::Near => None,
        }
    }

    /// The share of the edge cells of an exact technique that may differ where a row was compared.
    pub fn edge_share_of(&self, row: &Row) -> f64 {
        let of_surfaces = self.surfaces.filter(|_| row.on_surfaces);
        of_surfaces.map_or(self.edge_share, |surfaces| surfaces.edge_share)
    }

    /// The rows that fail.
    pub fn failed(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(|row| self.row_holds(row) == Some(false))
    }
}

/// The row of one technique.
#[derive(Clone, Debug)]
pub struct Row {
    /// What drew its masks.
    pub drawn: Provenance,
    /// The truth that it was compared with.
    pub against: Truth,
    /// What it promises.
    pub promise: Promise,
    /// Whether it was compared on façades and roofs, texel by texel, and not on the plan.
    pub on_surfaces: bool,
    /// The cells that differ: their share is off by more than half the sun.
    pub difference: Difference,
    /// The number of cells that differ next to things thinner than a cell; they are not in `difference`.
    pub thin: u64,
    /// The number of cells that the map decided differently than the stencil; they are not in `difference`. Absent
    /// without such a map.
    pub missed: Option<u64>,
    /// The greatest distance of a cell that differs from a shadow edge of the truth, in cells; absent if none differs.
    pub furthest: Option<f64>,
    /// The mean error of the share over all cells, 0 to 1.
    pub share_off: f64,
    /// The error of the profile in hours; absent if the instants have no weight.
    pub hours_off: Option<HoursDifference>,
    /// The time of an instant until its mask was in memory, seconds. The first instant, which includes building, counts
    /// only if it is the only one.
    pub secs: f64,
}

/// How two profiles differ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HoursDifference {
    /// The greatest difference of a cell, hours.
    pub largest: f64,
    /// The mean difference over all cells, hours.
    pub mean: f64,
}

impl HoursDifference {
    /// The difference between two sums of shaded time in 1/255 s.
    pub fn between(drawn: &Shaded, truth: &Shaded) -> HoursDifference {
        let off = || drawn.iter().zip(truth.iter()).map(|(drawn, truth)| drawn.abs_diff(truth));
        let hours = |sum: u64| sum as f64 / (255.0 * 3600.0);
        HoursDifference {
            largest: hours(off().max().unwrap_or(0)),
            mean: hours(off().sum()) / drawn.len().max(1) as f64,
        }
    }
}
