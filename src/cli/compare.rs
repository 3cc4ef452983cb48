//! `gnomon compare`: how a change of the site affects its shadow.

use super::arguments::{Common, DrawArgs, PlaceArgs, PlanArgs, ResolutionArgs, WindowArgs};
use super::commands::{between, drawn_by, lines};
use super::model::{GroundArgs, ModelArgs};
use super::output::{say, who};
use super::progress::Progress;
use crate::deliver::comparison::comparison;
use crate::deliver::{Folder, Sink};
use crate::site::{Overrides, Pair, SiteError, inputs};
use crate::study::Stopwatch;
use clap::Args;
use std::fmt::Write;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(super) struct CompareArgs {
    /// The existing site: a site file, a folder that contains a site.toml, or a model, whose place is in its file or in
    /// --place
    #[arg(value_name = "BEFORE")]
    before: PathBuf,
    /// The proposed site; if it has no place, that of the first is used
    #[arg(value_name = "AFTER")]
    after: PathBuf,
    #[command(flatten)]
    place: PlaceArgs,
    #[command(flatten)]
    ground: GroundArgs,
    #[command(flatten)]
    model: ModelArgs,
    #[command(flatten)]
    window: WindowArgs,
    #[command(flatten)]
    resolution: ResolutionArgs,
    #[command(flatten)]
    draw: DrawArgs,
    #[command(flatten)]
    plan: PlanArgs,
    /// Folder for the files
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    #[command(flatten)]
    pub(super) common: Common,
}

impl CompareArgs {
    fn overrides(&self) -> Result<Overrides, SiteError> {
        let asked = self.window.onto(self.ground.onto(self.model.onto(self.place.overrides()?)))?;
        self.plan.onto(self.draw.onto(self.resolution.onto(asked)?))
    }
}

/// `gnomon compare`
pub(super) fn compare(asked: &CompareArgs) -> anyhow::Result<()> {
    let watch = Stopwatch::start();
    let pair = Pair::load(&asked.before, &asked.after, &asked.overrides()?)?;
    let inputs = [inputs(&asked.before)?, inputs(&asked.after)?].concat();
    let mut progress = Progress::new(asked.common.quiet);
    let sink = Sink::Folder(Folder { path: &asked.out, who: &who(), inputs: &inputs });
    let answer = comparison(&pair, watch, sink, &mut |event| progress.heard(&event))?;
    if asked.common.json {
        return say(&answer.report);
    }
    let mut text = lines(&answer.written);
    // writing to a String cannot fail
    let _ = writeln!(text, "{}", drawn_by(&answer.drawn, &pair.after.ground));
    text.push_str(&between(&answer.drawn, pair.after.receivers, &pair.after));
    text.push_str(&answer.table);
    say(&text)
}
