//! `gnomon envelope`: how high may be built on the site's plot.

use super::arguments::{Common, SiteArgs};
use super::judge::{chosen, folder_of, rule_file, wrong_use};
use super::model::ModelArgs;
use super::output::{say, who};
use super::progress::Progress;
use super::wrong_use::WrongUse;
use crate::deliver::envelope::{EnvelopeRequest, envelope as deliver};
use crate::deliver::{Folder, Sink};
use crate::rules::rule_for_site;
use crate::site::load_judged;
use crate::study::settle;
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(super) struct EnvelopeArgs {
    #[command(flatten)]
    site: SiteArgs,
    #[command(flatten)]
    model: ModelArgs,
    /// The rule whose windows, areas, façades or lines keep their sun: the name of a file beside the site, ID.toml, or a
    /// built-in one as `gnomon rules` lists them
    #[arg(long, value_name = "ID")]
    rule: String,
    /// What the rule leaves to the authority: hours=2h. May be repeated
    #[arg(long, value_name = "KEY=VALUE", allow_hyphen_values = true)]
    set: Vec<String>,
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
    let folder = folder_of(asked.site.path());
    let rule = rule_for_site(&asked.rule, folder).map_err(wrong_use)?;
    let resolved = rule.resolve(&chosen(&asked.set)?).map_err(wrong_use)?;
    let overrides = asked.model.onto(asked.site.overrides()?);
    let site = settle(load_judged(asked.site.path(), &overrides)?)?;
    let request =
        EnvelopeRequest { source: &rule.source, rule: &resolved, cell_m: asked.cell, highest_m: asked.highest };
    let mut progress = Progress::of("days", asked.common.quiet);
    let mut inputs = asked.site.inputs()?;
    inputs.extend(rule_file(&asked.rule, folder));
    let sink = Sink::Folder(Folder { path: &asked.out, who: &who(), inputs: &inputs });
    let answer = deliver(&site, request, sink, &mut |event| progress.heard(&event))?;
    match asked.common.json {
        true => say(&answer.report),
        false => say(&answer.table),
    }
}
