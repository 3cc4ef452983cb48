//! What a study makes beside its answer.

use crate::message::Field;
use std::path::PathBuf;
use std::time::Duration;

/// Memory for all that grows with the raster: sums, masks, what cells see and what the drawing takes, on the adapter too.
/// The models, the program with the few megabytes that each of its threads works with, and the adapter's driver come on top.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budget {
    /// All that there is, bytes.
    pub bytes: u64,
    /// What whoever asks takes of it for a drawing once the sums are done, bytes.
    pub drawing: u64,
}

/// What is made beside the profile.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Wants {
    /// Every instant's mask, in [`Event::Drawn`](super::Event::Drawn).
    pub masks: bool,
    /// Of every instant with a sun which cells are in shadow, in [`Event::Drawn`](super::Event::Drawn).
    pub bits: bool,
    /// The folder to which whoever asks writes the masks, by its canonical name: a study that writes them elsewhere is
    /// another study.
    pub masks_in: Option<PathBuf>,
    /// Whether lines are drawn, which are made of all cells at once: tiles will not do.
    pub lines: bool,
    /// What the cells see, for a drawing.
    pub surface: bool,
    /// What counting took.
    pub statistics: bool,
    /// What is done so far, in [`Event::Kept`](super::Event::Kept): each time that so long has passed, and when the work is ended.
    pub keep_every: Option<Duration>,
    /// What memory there is for rasters; without one as much as they take.
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
    /// What counting took, cell by cell, and what it is for.
    pub counted: Option<CountingPurpose>,
}

/// What counting shadow volumes is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CountingPurpose {
    /// Numbers of the whole.
    Statistics,
    /// A diagram of what a map decided and what the volumes did.
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
