//! What a study makes besides its profile.

use crate::message::Field;
use std::path::PathBuf;
use std::time::Duration;

/// The memory for everything that grows with the raster: sums, masks, surfaces, and the drawing, including the
/// adapter's memory. Not included are the models, the program with a few megabytes for each of its threads, and the
/// adapter's driver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budget {
    /// The whole budget, bytes.
    pub bytes: u64,
    /// The part of it that the caller needs for a drawing once the sums are done, bytes.
    pub drawing: u64,
}

/// What a study makes besides the profile.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Wants {
    /// Every instant's mask, in [`Event::Drawn`](super::Event::Drawn).
    pub masks: bool,
    /// For every instant with a sun, which cells are in shadow, in [`Event::Drawn`](super::Event::Drawn).
    pub bits: bool,
    /// The canonical path of the folder to which the caller writes the masks. A study that writes them elsewhere is a
    /// different study.
    pub masks_in: Option<PathBuf>,
    /// Whether lines are drawn. They need all cells at once, so tiles are not possible.
    pub lines: bool,
    /// What the cells see, for a drawing.
    pub surface: bool,
    /// The statistics of counting.
    pub statistics: bool,
    /// How often the state is reported in [`Event::Kept`](super::Event::Kept). It is also reported when the work is
    /// ended.
    pub keep_every: Option<Duration>,
    /// The memory for rasters; `None` for no limit.
    pub budget: Option<Budget>,
}

/// What is made besides the mask of one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct InstantWants {
    /// What the cells see, for a drawing.
    pub surface: bool,
    /// The layers of the shadow volumes in front of a camera's picture.
    pub volumes: bool,
    /// The silhouette's lines over a camera's picture.
    pub silhouette: bool,
    /// The work of counting, cell by cell, and its purpose.
    pub counted: Option<CountingPurpose>,
}

/// The purposes of counting fragments of shadow volumes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CountingPurpose {
    /// Statistics of the whole.
    Statistics,
    /// A diagram that shows which cells the map decided and which the volumes did.
    Mask,
    /// A diagram of the number of fragments in each cell.
    Overdraw,
}

impl CountingPurpose {
    /// The field of the request for it.
    pub(super) fn field(self) -> Field {
        match self {
            CountingPurpose::Statistics => Field::Statistics,
            CountingPurpose::Mask => Field::MaskDiagram,
            CountingPurpose::Overdraw => Field::OverdrawDiagram,
        }
    }
}

/// The note if counts were requested for a night.
pub(super) const NOTHING_COUNTED: &str =
    "without a sun nothing is counted: there are no statistics, and no mask or overdraw to show";
