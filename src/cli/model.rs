//! How models are read, and where the ground lies below them.

use crate::formats::Up;
use crate::site::Overrides;
use clap::Args;

#[derive(Debug, Args)]
pub(super) struct ModelArgs {
    /// Which axis of the models is up, y or z, whatever the site file says [default: y, as glTF has it]
    #[arg(long, value_name = "AXIS")]
    pub(super) up: Option<Up>,
}

impl ModelArgs {
    pub(super) fn onto(&self, asked: Overrides) -> Overrides {
        Overrides { up: self.up, ..asked }
    }
}

/// How high the ground lies.
#[derive(Debug, Args)]
pub(super) struct GroundArgs {
    /// The ground's height, metres above the place's point [default: 0 where the models reach through 0, else their lowest
    /// point]
    #[arg(long, value_name = "METRES", allow_hyphen_values = true)]
    ground: Option<f64>,
}

impl GroundArgs {
    pub(super) fn onto(&self, asked: Overrides) -> Overrides {
        Overrides { ground: self.ground, ..asked }
    }
}
