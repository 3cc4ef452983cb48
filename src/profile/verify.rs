//! What came of holding every technique against ray casting, over the instants of a study.

use super::accumulate::Sum;
use super::compare::{Difference, Edges};
use super::{Provenance, Shaded};
use crate::choice::{Promise, Truth};
use crate::shadow::{DrawnMask, ShadowError};
use crate::view::{Grid, Mask};

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
    pub fn between(drawn: &Shaded, truth: &Shaded) -> HoursDifference {
        let off = || drawn.iter().zip(truth.iter()).map(|(drawn, truth)| drawn.abs_diff(truth));
        let hours = |sum: u64| sum as f64 / (255.0 * 3600.0);
        HoursDifference {
            largest: hours(off().max().unwrap_or(0)),
            mean: hours(off().sum()) / drawn.len().max(1) as f64,
        }
    }
}

/// Masks and times of one technique, added up instant by instant.
pub struct Tally {
    sum: Sum,
    /// How long each instant took, seconds.
    secs: Vec<f64>,
    difference: Difference,
    thin: u64,
    missed: u64,
    furthest: Option<f64>,
    /// In 1/255 of the sun.
    share_off: u64,
    cells: u64,
}

impl Tally {
    /// Nothing yet.
    pub fn new(grid: &Grid) -> Tally {
        Tally {
            sum: Sum::new(None, grid.width, grid.height),
            secs: Vec::new(),
            difference: Difference::default(),
            thin: 0,
            missed: 0,
            furthest: None,
            share_off: 0,
            cells: 0,
        }
    }

    /// A mask was drawn.
    ///
    /// # Errors
    /// None for a mask in memory.
    pub fn draw(&mut self, mask: &Mask, weight_secs: u32, secs: f64) -> Result<(), ShadowError> {
        self.secs.push(secs);
        self.sum.add(&DrawnMask::Memory(mask), weight_secs)
    }

    /// Shares were compared one by one.
    pub fn compare<'a>(&mut self, shares: impl IntoIterator<Item = (&'a u8, &'a u8)>) {
        for (share, truth) in shares {
            self.share_off += u64::from(share.abs_diff(*truth));
            self.cells += 1;
        }
    }

    /// Cells differ from a truth; beside them `thin` and `missed`, which are counted apart.
    pub fn differ(&mut self, difference: Difference, thin: u64, missed: u64, truth: &Mask) {
        self.thin += thin;
        self.missed += missed;
        let at = || difference.edge_at.iter().chain(&difference.other_at);
        if at().next().is_some() {
            let edges = Edges::of(truth);
            let furthest = at().filter_map(|&(column, row)| edges.distance(column, row));
            self.furthest = furthest.chain(self.furthest).max_by(f64::total_cmp);
        }
        // a study's cells would be many, and nobody asks where they lie
        self.difference.add(Difference { edge_at: Vec::new(), other_at: Vec::new(), ..difference });
    }

    /// The typical time of an instant, seconds.
    pub fn secs(&self) -> f64 {
        let secs = if self.secs.len() > 1 { &self.secs[1..] } else { &self.secs };
        secs.iter().sum::<f64>() / secs.len().max(1) as f64
    }

    /// The sum of all masks drawn.
    ///
    /// # Errors
    /// None for masks in memory.
    pub fn sum(self) -> Result<Shaded, ShadowError> {
        self.sum.finish()
    }

    /// The row; `truth` is the sum that belongs to the truth, where instants have a weight.
    ///
    /// # Errors
    /// None for masks in memory.
    pub fn row(
        self,
        drawn: Provenance,
        against: Truth,
        promise: Promise,
        truth: Option<&Shaded>,
    ) -> Result<Row, ShadowError> {
        Ok(Row {
            drawn,
            against,
            promise,
            thin: self.thin,
            missed: (promise == Promise::ExactButForMap).then_some(self.missed),
            furthest: self.furthest,
            share_off: self.share_off as f64 / 255.0 / self.cells.max(1) as f64,
            secs: self.secs(),
            difference: self.difference,
            hours_off: truth
                .map(|truth| Ok::<_, ShadowError>(HoursDifference::between(&self.sum.finish()?, truth)))
                .transpose()?,
        })
    }
}
