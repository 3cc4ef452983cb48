//! How models are read.

use crate::site::Overrides;
use crate::site::model::Up;
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
