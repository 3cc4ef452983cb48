//! The options for how models are read, and for the height of the ground below them.

use super::memory;
use crate::formats::{ModelReader, ReadLimits, Up};
use crate::site::Overrides;
use crate::sun::parse_duration_secs;
use clap::Args;
use std::time::Duration;

#[derive(Debug, Args)]
pub(super) struct ModelArgs {
    /// Up axis of the models, y or z, whatever the site file says [default: as the file or its format has it]
    #[arg(long, value_name = "AXIS")]
    pub(super) up: Option<Up>,
    /// Height of buildings whose footprints have none, metres [default: they are left out]
    #[arg(long, value_name = "M", allow_negative_numbers = true, value_parser = height)]
    default_height: Option<f64>,
    #[command(flatten)]
    reading: ReadingArgs,
}

/// The limits of reading models.
#[derive(Debug, Args)]
struct ReadingArgs {
    /// Do not use the cache of models that were read before, and do not add to it
    #[arg(long)]
    no_cache: bool,
    /// Time limit for readers that run in a process of their own [default: 10min]
    #[arg(long, value_name = "TIME", value_parser = duration)]
    read_time: Option<Duration>,
    /// Memory limit for such readers, such as 8GiB [default: three quarters of the machine's]
    #[arg(long, value_name = "SIZE", value_parser = memory::parse)]
    read_memory: Option<u64>,
}

impl ModelArgs {
    pub(super) fn onto(&self, asked: Overrides) -> Overrides {
        let reading = self.reading.onto(asked.reading);
        Overrides { up: self.up, default_height: self.default_height, reading, ..asked }
    }
}

impl ReadingArgs {
    fn onto(&self, usual: ModelReader) -> ModelReader {
        ModelReader {
            limits: ReadLimits { time: self.read_time.unwrap_or(usual.limits.time), memory: self.read_memory },
            cache: usual.cache.filter(|_| !self.no_cache),
            ..usual
        }
    }
}

/// A height above 0, in metres.
fn height(text: &str) -> Result<f64, String> {
    let height = text.parse().ok().filter(|height: &f64| height.is_finite() && *height > 0.0);
    height.ok_or_else(|| "write metres above 0, for example 9".to_owned())
}

/// A time that is written like a study's step.
fn duration(text: &str) -> Result<Duration, String> {
    match parse_duration_secs(text) {
        Ok(secs @ 1..) => Ok(Duration::from_secs(secs.into())),
        _ => Err("write a time above 0, for example 30min or 1h".to_owned()),
    }
}

/// The height of the ground.
#[derive(Debug, Args)]
pub(super) struct GroundArgs {
    /// Height of the ground, metres above the place's point [default: 0 if the models reach through 0, otherwise their
    /// lowest point]
    #[arg(long, value_name = "METRES", allow_hyphen_values = true)]
    ground: Option<f64>,
}

impl GroundArgs {
    pub(super) fn onto(&self, asked: Overrides) -> Overrides {
        Overrides { ground: self.ground, ..asked }
    }
}
