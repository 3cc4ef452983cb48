//! `gnomon judge`: does a site keep a rule?

use super::arguments::Common;
use super::commands::lines;
use super::options::Options;
use super::output::say;
use super::progress::Progress;
use super::ruled_site::{ChosenRule, ReadSite, RuledSiteArgs};
use super::wrong_use::WrongUse;
use crate::deliver::Sink;
use crate::deliver::judgement::{JudgeAnswer, JudgeRequest, judge as deliver};
use crate::export::judgement as told;
use crate::rules::Verdict;
use clap::Args;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct JudgeArgs {
    #[command(flatten)]
    ruled: RuledSiteArgs,
    /// A table with a line for each area, window, façade or band: verdict, day, point, value, limit, margin, before, shares
    #[arg(long, value_name = "FILE.csv")]
    csv: Option<PathBuf>,
    #[command(flatten)]
    pub(super) common: Common,
}

/// The exit status of a verdict: 0 passes, 1 fails or is close to a limit, 3 only reports.
fn status(verdict: Verdict) -> ExitCode {
    match verdict {
        Verdict::Pass => ExitCode::SUCCESS,
        Verdict::Fail | Verdict::Close => ExitCode::from(1),
        Verdict::Report => ExitCode::from(3),
    }
}

pub(super) fn judge(asked: &JudgeArgs) -> anyhow::Result<ExitCode> {
    if let Some(path) = &asked.csv
        && path.extension().is_none_or(|extension| !extension.eq_ignore_ascii_case("csv"))
    {
        return Err(WrongUse(format!("--csv writes CSV; name a .csv file instead of {}", path.display())).into());
    }
    let (ChosenRule { source, rule }, ReadSite { site, inputs }) = asked.ruled.read()?;
    let request = JudgeRequest { source: &source, rule: &rule, table: asked.csv.as_ref() };
    let mut progress = Progress::of("receivers", asked.common.quiet);
    let sink = Sink::Paths { inputs: &inputs };
    let JudgeAnswer { judgement, notes, written } = deliver(&site, request, sink, &mut |event| progress.heard(&event))?;
    match asked.common.json {
        true => say(&told::json(&judgement, &site, (&notes, &Options))?)?,
        false => say(&(told::table(&judgement, &site) + &lines(&written)))?,
    }
    Ok(status(judgement.verdict))
}
