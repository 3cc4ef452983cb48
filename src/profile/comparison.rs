//! How a change of the site affects its shadow: two profiles of one study, compared cell by cell.
//!
//! *Sun lost* is shadow after the change that was not there before; *sun gained* is the opposite. A cell that sees a
//! different surface after the change (a roof instead of the ground) is *altered*: its hours are not compared, and it
//! is not part of any area.

use super::Profile;
use crate::view::{Grid, Surface};

/// Surfaces closer to each other than this are the same, metres: rounding of a slope's height is below it.
const ONE_SURFACE_M: f32 = 0.05;

/// How the surface that a cell sees has changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Alteration {
    /// It is the same surface.
    No,
    /// The cell sees something new above what was there.
    Built,
    /// What the cell saw is gone.
    Cleared,
}

impl Alteration {
    /// The alteration of each cell between two surfaces on one grid.
    pub fn between(before: &Surface, after: &Surface) -> Vec<Alteration> {
        let heights = before.height_m.iter().zip(&after.height_m);
        let altered = |(before, after): (&f32, &f32)| match after - before {
            higher if higher > ONE_SURFACE_M => Alteration::Built,
            higher if higher < -ONE_SURFACE_M => Alteration::Cleared,
            _ => Alteration::No,
        };
        heights.map(altered).collect()
    }
}

/// Two profiles of one study on one grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    before: Profile,
    after: Profile,
    altered: Vec<Alteration>,
}

/// A direction of change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// More shadow after than before.
    SunLost,
    /// Less shadow after than before.
    SunGained,
}

/// The cell with the greatest change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GreatestChange {
    /// The first such cell, row by row from the north-west.
    pub cell: usize,
    /// The change, hours, above 0.
    pub hours: f64,
    /// Its centre, metres east and north.
    pub at: [f64; 2],
}

impl Comparison {
    /// The comparison of two profiles of one study.
    ///
    /// # Panics
    /// If they do not have the same grid and daylight, or if `altered` has a different number of cells.
    pub fn new(before: Profile, after: Profile, altered: Vec<Alteration>) -> Comparison {
        assert_eq!((before.grid, before.day_secs), (after.grid, after.day_secs));
        assert_eq!([before.shaded.len(), after.shaded.len(), altered.len()], [before.grid.cells(); 3]);
        Comparison { before, after, altered }
    }

    /// The grid of both profiles.
    pub fn grid(&self) -> &Grid {
        &self.before.grid
    }

    /// The number of cells.
    pub fn cells(&self) -> usize {
        self.altered.len()
    }

    /// The profile before.
    pub fn before(&self) -> &Profile {
        &self.before
    }

    /// The profile after.
    pub fn after(&self) -> &Profile {
        &self.after
    }

    /// How the surface that a cell sees has changed.
    pub(crate) fn altered(&self, cell: usize) -> Alteration {
        self.altered[cell]
    }

    /// The shaded time after minus the one before, in 1/255 s; `None` if the cell is altered.
    pub fn change(&self, cell: usize) -> Option<i64> {
        // sums of ten years are below 2^37
        let change = || self.after.shaded.of(cell) as i64 - self.before.shaded.of(cell) as i64;
        (self.altered[cell] == Alteration::No).then(change)
    }

    /// The same in hours; NaN if the cell is altered.
    pub fn hours(&self, cell: usize) -> f32 {
        self.change(cell).map_or(f32::NAN, |change| hours(change) as f32)
    }

    /// The area with that alteration, square metres.
    pub fn altered_m2(&self, altered: Alteration) -> f64 {
        self.area(self.altered.iter().filter(|it| **it == altered).count())
    }

    /// The area that changes by more than that many seconds, square metres.
    pub fn more_than_m2(&self, change: Change, secs: u32) -> f64 {
        let least = i64::from(secs) * 255;
        self.area(self.changes(change).filter(|(_, change)| *change > least).count())
    }

    /// The areas, square metres, with at least this many seconds of sun, before and after.
    pub(crate) fn sun_at_least_m2(&self, secs: u32) -> [f64; 2] {
        [&self.before, &self.after].map(|profile| {
            let most = u64::from(profile.day_secs.saturating_sub(secs)) * 255;
            let has = |cell: &usize| self.altered[*cell] == Alteration::No && profile.shaded.of(*cell) <= most;
            let enough = secs <= profile.day_secs;
            self.area((0..self.cells()).filter(|cell| enough && has(cell)).count())
        })
    }

    /// The sum over the area, square metres times hours.
    pub fn total_m2_hours(&self, change: Change) -> f64 {
        let sum: i128 = self.changes(change).map(|(_, change)| i128::from(change.max(0))).sum();
        sum as f64 / (255.0 * 3600.0) * self.area(1)
    }

    /// The cell with the greatest change; `None` if no cell changes.
    pub fn most(&self, change: Change) -> Option<GreatestChange> {
        let first = self.changes(change).fold(None, |most: Option<(usize, i64)>, (cell, change)| match most {
            Some((_, largest)) if largest >= change => most,
            _ => Some((cell, change)),
        });
        first.filter(|(_, change)| *change > 0).map(|(cell, change)| {
            let width = self.grid().width as usize;
            let at = self.grid().centre((cell % width) as u32, (cell / width) as u32);
            GreatestChange { cell, hours: hours(change), at: at.to_array() }
        })
    }

    /// The changes in that direction of the cells that are compared, in 1/255 s.
    fn changes(&self, which: Change) -> impl Iterator<Item = (usize, i64)> {
        let sign = if which == Change::SunLost { 1 } else { -1 };
        (0..self.cells()).filter_map(move |cell| Some((cell, sign * self.change(cell)?)))
    }

    fn area(&self, cells: usize) -> f64 {
        cells as f64 * self.grid().cell.powi(2)
    }
}

fn hours(change: i64) -> f64 {
    change as f64 / (255.0 * 3600.0)
}
