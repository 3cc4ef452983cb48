//! `gnomon envelope`: how high may be built on the site's plot.

use super::arguments::Common;
use super::output::{say, who};
use super::progress::Progress;
use super::ruled_site::{RuledSite, RuledSiteArgs};
use super::wrong_use::WrongUse;
use crate::deliver::envelope::{EnvelopeRequest, envelope as deliver};
use crate::deliver::{Folder, Sink};
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(super) struct EnvelopeArgs {
    #[command(flatten)]
    ruled: RuledSiteArgs,
    /// Side of a cell of the plot, metres [default: a round one, of which the longer side has 100 to 200]
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    cell: Option<f64>,
    /// How high something may be where no sun is in the way, metres above the ground
    #[arg(long, value_name = "M", default_value_t = 100.0, allow_negative_numbers = true)]
    highest: f64,
    /// The folder for the files
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    #[command(flatten)]
    pub(super) common: Common,
}

pub(super) fn envelope(asked: &EnvelopeArgs) -> anyhow::Result<()> {
    for (option, value, least) in [("--cell", asked.cell, 0.01), ("--highest", Some(asked.highest), 0.1)] {
        if value.is_some_and(|value| !(least..=10_000.0).contains(&value)) {
            return Err(WrongUse(format!("{option} takes {least} to 10000 metres")).into());
        }
    }
    let RuledSite { source, rule, site, inputs } = asked.ruled.read()?;
    let request = EnvelopeRequest { source: &source, rule: &rule, cell_m: asked.cell, highest_m: asked.highest };
    let mut progress = Progress::of("days", asked.common.quiet);
    let sink = Sink::Folder(Folder { path: &asked.out, who: &who(), inputs: &inputs });
    let answer = deliver(&site, request, sink, &mut |event| progress.heard(&event))?;
    match asked.common.json {
        true => say(&answer.report),
        false => say(&answer.table),
    }
}
