//! The answer: shaded time per cell, and where it lies on the ground.

pub mod accumulate;
pub mod compare;
pub mod verify;

use crate::view::Grid;

/// The raster of shaded time.
///
/// Sums are exact integers, the same on every machine: seconds times the covered share of the sun in 1/255.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// Where the raster lies.
    pub grid: Grid,
    /// Per cell the shaded time in 1/255 s, row 0 (north) first; night is not in it.
    pub shaded: Vec<u32>,
    /// Seconds of the window with the sun above the horizon.
    pub day_secs: u32,
    /// Seconds of the window without.
    pub night_secs: u32,
}

impl Profile {
    /// Hours of shadow in a cell, 0 to `day_secs / 3600`.
    pub fn hours(&self, cell: usize) -> f32 {
        (f64::from(self.shaded[cell]) / (255.0 * 3600.0)) as f32
    }
}

/// What drew an answer: never `auto`, always the choice that was made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Drawn {
    /// The technique's name as the command takes it: `stencil`, `ray-cast`, …
    pub technique: &'static str,
    /// The silhouette finder's name as the command takes it; absent where none was used.
    pub silhouette: Option<&'static str>,
    /// `gpu` or `cpu`.
    pub engine: &'static str,
    /// The graphics adapter's own name; absent where none was used.
    pub adapter: Option<String>,
}

/// How long each stage took, in seconds and in the order of the work; the last one is `total`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Timings(pub Vec<(&'static str, f64)>);
