//! What a study makes beside its answer.

use crate::message::Field;
use std::path::PathBuf;
use std::time::Duration;

/// The memory for everything that grows with the raster: sums, masks, what cells see and what the drawing takes,
/// including the adapter's memory. The models, the program with a few megabytes for each of its threads, and the
/// adapter's driver come on top.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budget {
    /// The whole budget, bytes.
    pub bytes: u64,
    /// The part of it that the caller needs for a drawing once the sums are done, bytes.
    pub drawing: u64,
}

/// What a study makes beside the profile.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Wants {
    /// Every instant's mask, in [`Event::Drawn`](super::Event::Drawn).
    pub masks: bool,
    /// For every instant with a sun, which cells are in shadow, in [`Event::Drawn`](super::Event::Drawn).
    pub bits: bool,
    /// The folder to which the caller writes the masks, by its canonical name. A study that writes them elsewhere is
    /// another study.
    pub masks_in: Option<PathBuf>,
    /// Whether lines are drawn. They are made of all cells at once, so that tiles are not possible.
    pub lines: bool,
    /// What the cells see, for a drawing.
    pub surface: bool,
    /// The statistics of counting.
    pub statistics: bool,
    /// How often the state so far is reported in [`Event::Kept`](super::Event::Kept); it is also reported when the work
    /// is ended.
    pub keep_every: Option<Duration>,
    /// The memory for rasters; without a value there is no limit.
    pub budget: Option<Budget>,
}

/// What is made beside the mask of one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct InstantWants {
    /// What the cells see, for a drawing.
    pub surface: bool,
    /// The layers of the shadow volumes before a camera's picture.
    pub volumes: bool,
    /// The silhouette's lines over a camera's picture.
    pub silhouette: bool,
    /// How much work counting took, cell by cell, and for which purpose.
    pub counted: Option<CountingPurpose>,
}

/// The purposes of counting shadow volumes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CountingPurpose {
    /// Statistics of the whole.
    Statistics,
    /// A diagram of what the map decided and what the volumes decided.
    Mask,
    /// A diagram of how many fragments were counted.
    Overdraw,
}

impl CountingPurpose {
    /// The field that asks for it.
    pub(super) fn field(self) -> Field {
        match self {
            CountingPurpose::Statistics => Field::Statistics,
            CountingPurpose::Mask => Field::MaskDiagram,
            CountingPurpose::Overdraw => Field::OverdrawDiagram,
        }
    }
}

/// Where something asks what counting took.
pub(super) const NOTHING_COUNTED: &str =
    "without a sun nothing is counted: there are no statistics, no mask and no overdraw to show";
