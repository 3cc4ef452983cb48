//! The state of a study that was stopped.

use super::{ShadedTime, Statistics};

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
    pub shaded: ShadedTime,
    /// What counting them took, where that was asked.
    pub statistics: Option<Statistics>,
}
