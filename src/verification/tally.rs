//! Sums one technique's masks and times, instant by instant.

use super::{Difference, Edges, HoursDifference, Row};
use crate::choice::{Promise, Truth};
use crate::profile::accumulate::Sum;
use crate::profile::{Provenance, Shaded};
use crate::shadow::{DrawnMask, ShadowError};
use crate::view::{Grid, Mask};

/// The masks and times of one technique, summed instant by instant.
pub struct Tally {
    sum: Sum,
    /// The time of each instant, seconds.
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
    /// A tally without masks.
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

    /// Adds a mask that was drawn.
    ///
    /// # Errors
    /// Never, for a mask in memory.
    pub fn draw(&mut self, mask: &Mask, weight_secs: u32, secs: f64) -> Result<(), ShadowError> {
        self.secs.push(secs);
        self.sum.add(&DrawnMask::Memory(mask), weight_secs)
    }

    /// Adds shares that were compared singly.
    pub fn compare<'a>(&mut self, shares: impl IntoIterator<Item = (&'a u8, &'a u8)>) {
        for (share, truth) in shares {
            self.share_off += u64::from(share.abs_diff(*truth));
            self.cells += 1;
        }
    }

    /// Adds cells that differ from the truth; `thin` and `missed` are counted separately.
    pub fn differ(&mut self, difference: Difference, thin: u64, missed: u64, truth: &Mask) {
        self.thin += thin;
        self.missed += missed;
        let at = || difference.edge_at.iter().chain(&difference.other_at);
        if at().next().is_some() {
            let edges = Edges::of(truth);
            let furthest = at().filter_map(|&(column, row)| edges.distance(column, row));
            self.furthest = furthest.chain(self.furthest).max_by(f64::total_cmp);
        }
        // positions are not needed, and a study would have many
        self.difference.add(Difference { edge_at: Vec::new(), other_at: Vec::new(), ..difference });
    }

    /// The typical time of an instant, seconds.
    pub fn secs(&self) -> f64 {
        let secs = if self.secs.len() > 1 { &self.secs[1..] } else { &self.secs };
        secs.iter().sum::<f64>() / secs.len().max(1) as f64
    }

    /// The sum of all masks that were drawn.
    ///
    /// # Errors
    /// Never, for masks in memory.
    pub fn sum(self) -> Result<Shaded, ShadowError> {
        self.sum.finish()
    }

    /// The technique's row. `truth` is the sum of the truth, if the instants have weights.
    ///
    /// # Errors
    /// Never, for masks in memory.
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
            on_surfaces: false,
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
