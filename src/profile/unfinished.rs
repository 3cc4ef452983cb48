//! The state of a study that was stopped.

use super::{Shaded, Statistics};

/// The state of a study that was stopped. It does not contain the finished tiles before the last one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unfinished {
    /// The fingerprint of the study.
    pub study: u64,
    /// The number of its tiles.
    pub tiles: usize,
    /// The number of finished instants, summed over the tiles.
    pub done: usize,
    /// The sum of those in the last tile.
    pub shaded: Shaded,
    /// The statistics of counting them, if they were requested.
    pub statistics: Option<Statistics>,
}
