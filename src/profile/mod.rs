//! The answer: shaded time per cell, and where it lies on the ground.

pub mod accumulate;
pub mod compare;
pub mod comparison;
pub mod contour;
pub mod probe;
mod shaded;
pub mod surfaces;
pub mod verify;

pub use shaded::{Shaded, ShadedCells, ShadedPart};

use crate::choice::{Engine, Finder, Method, Settings};
use crate::view::{Decider, FragmentCounts, Grid};

/// The raster of shaded time.
///
/// Sums are exact integers, the same on every machine: seconds times the covered share of the sun in 1/255.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile<S = Shaded> {
    /// Where the raster lies.
    pub grid: Grid,
    /// Per cell the shaded time; night is not in it.
    pub shaded: S,
    /// Seconds of the window with the sun above the horizon.
    pub day_secs: u32,
    /// Seconds of the window without.
    pub night_secs: u32,
}

impl Profile {
    /// Hours of shadow in a cell, 0 to `day_secs / 3600`.
    pub fn hours(&self, cell: usize) -> f32 {
        hours(self.shaded.of(cell))
    }
}

/// Hours of a shaded time.
pub fn hours(shaded: u64) -> f32 {
    (shaded as f64 / (255.0 * 3600.0)) as f32
}

/// A study that was stopped, as far as it came. Tiles before the one that was worked on last are whole, and not in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unfinished {
    /// Which study: a number of all that its result depends on.
    pub study: u64,
    /// How many tiles it has.
    pub tiles: usize,
    /// How many of its instants are done, those of each tile counted.
    pub done: usize,
    /// The sum of those of the last tile.
    pub shaded: Shaded,
    /// What counting them took, where that was asked.
    pub statistics: Option<Statistics>,
}

/// What drew an answer: never [`Method::Auto`], [`Finder::Auto`] or [`Engine::Auto`], always the choice that was made.
#[derive(Clone, Debug, PartialEq)]
pub struct Provenance {
    /// The technique.
    pub technique: Method,
    /// Who found silhouettes; absent where nobody did.
    pub finder: Option<Finder>,
    /// The machine.
    pub engine: Engine,
    /// The graphics adapter's own name; absent where none was used.
    pub adapter: Option<String>,
    /// How it was set, each absent where the technique does not use it. Without [`Settings::sun_samples`] the sun was its
    /// centre; [`Settings::smoothie_width_m`] is there where it was set by hand.
    pub settings: Settings,
}

/// What counting shadow volumes took, over all cells and instants.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Cells of all instants.
    pub cells: u64,
    /// Those of them that a map left to the volumes, where there was one.
    pub silhouette_cells: Option<u64>,
    /// Fragments of walls and caps that reached the count.
    pub fragments: u64,
    /// Fragments that would have, if no mask kept any away.
    pub fragments_without_mask: u64,
}

impl Statistics {
    /// Adds an instant.
    pub fn add(&mut self, counted: &FragmentCounts) {
        self.cells += counted.reached.len() as u64;
        self.fragments += counted.reached.iter().map(|&fragments| u64::from(fragments)).sum::<u64>();
        self.fragments_without_mask += counted.all;
        if let Some(decided) = &counted.decided {
            let by_volumes = |it: &&Decider| matches!(it, Decider::VolumeShadow | Decider::VolumeLight);
            *self.silhouette_cells.get_or_insert(0) += decided.iter().filter(by_volumes).count() as u64;
        }
    }

    /// An instant's own.
    pub fn of(counted: &FragmentCounts) -> Statistics {
        let mut statistics = Statistics::default();
        statistics.add(counted);
        statistics
    }

    /// Fragments a cell, with the mask and without.
    pub fn overdraw(&self) -> [f64; 2] {
        [self.fragments, self.fragments_without_mask].map(|fragments| fragments as f64 / self.cells.max(1) as f64)
    }
}

/// How long each stage took, in seconds and in the order of the work; the last one is `total`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Timings(pub Vec<(&'static str, f64)>);
