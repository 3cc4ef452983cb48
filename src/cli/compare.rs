//! `gnomon compare`: what a change of the site does to its shadow.

use super::arguments::{Common, DrawArgs, PlaceArgs, PlanArgs, WindowArgs};
use super::commands::drawn_by;
use super::model::{GroundArgs, ModelArgs};
use super::profile::written;
use super::progress::Progress;
use super::{interrupt, say, who};
use crate::export::report::Told;
use crate::export::workplace::Workplace;
use crate::export::{comparison, figure, file, raster};
use crate::site::{Overrides, Pair, Site, inputs};
use crate::study::{self, Stopwatch};
use clap::Args;
use std::fmt::Write;
use std::path::PathBuf;

/// What it writes.
const FILES: [&str; 3] = ["compare.png", "shadow-hours-difference.tif", "compare.json"];

#[derive(Debug, Args)]
pub(super) struct CompareArgs {
    /// The site as it is: a site file, a folder that holds a site.toml, or a model (.glb, .gltf) together with --place
    #[arg(value_name = "BEFORE")]
    before: PathBuf,
    /// The site as it is to be; what says no place stands where the first does
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
    draw: DrawArgs,
    #[command(flatten)]
    plan: PlanArgs,
    /// The folder for the files
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    #[command(flatten)]
    pub(super) common: Common,
}

impl CompareArgs {
    fn overrides(&self) -> Overrides {
        self.plan.onto(self.draw.onto(self.window.onto(self.ground.onto(self.model.onto(self.place.overrides())))))
    }
}

/// `gnomon compare`
pub(super) fn compare(asked: &CompareArgs) -> anyhow::Result<()> {
    let mut watch = Stopwatch::start();
    let pair = Pair::load(&asked.before, &asked.after, &asked.overrides())?;
    let outputs = FILES.map(|name| asked.out.join(name));
    file::check_inputs(&[inputs(&asked.before)?, inputs(&asked.after)?].concat(), &outputs)?;
    let workplace = Workplace::take([asked.out.as_path()], &outputs, &who())?;
    watch.lap("load");
    let mut progress = Progress::new(asked.common.quiet);
    progress.note(workplace.note());
    progress.letters([&pair.names[0], &pair.names[1], &pair.after.place.name].map(String::as_str));
    let outcome = study::compare(&pair, &mut |event| {
        progress.hear(&event);
        interrupt::flow()
    })?;
    watch.lap("shadows");

    let Site { place, track, receivers, ground, .. } = &pair.after;
    let (receivers, ground) = (*receivers, *ground);
    let [first, second] = [0, 1].map(|at| {
        let (mesh, surface, drawn) = (&outcome.meshes[at], &outcome.surfaces[at], &outcome.drawn[at]);
        figure::Scene { place, track, mesh, surface, receivers, ground, drawn }
    });
    let change = &outcome.comparison;
    let picture = figure::difference(&[first, second], &pair.names, change)?;
    watch.lap("picture");
    interrupt::check()?;
    let raster = raster::difference_geotiff(change, place)?;
    watch.lap("raster");
    interrupt::check()?;
    let drawn = &outcome.drawn[1];
    let (timings, notes) = (&watch.timings(), &pair.notes());
    let told = Told { receivers, ground, drawn, timings, statistics: None, notes };
    let json = comparison::json(change, &pair.names, place, track, &told)?;
    let files: Vec<_> = FILES.into_iter().zip([picture, raster, json.clone().into_bytes()]).collect();
    workplace.check()?;
    let mut text = written(&asked.out, &files)?;
    if asked.common.json {
        return say(&json);
    }
    let _ = writeln!(text, "{}", drawn_by(drawn, &ground));
    text.push_str(&comparison::table(change, track));
    say(&text)
}
