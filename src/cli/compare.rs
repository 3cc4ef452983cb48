//! `gnomon compare`: what a change of the site does to its shadow.

use super::arguments::CompareArgs;
use super::commands::drawn_by;
use super::profile::written;
use super::progress::Progress;
use super::{interrupt, say};
use crate::export::report::Told;
use crate::export::{comparison, figure, file, raster};
use crate::site::Pair;
use crate::study::{self, Stopwatch};
use std::fmt::Write;

pub(super) fn compare(asked: &CompareArgs) -> anyhow::Result<()> {
    let mut watch = Stopwatch::start();
    let pair = Pair::load(&asked.before, &asked.after, &asked.overrides())?;
    file::check_folder(&asked.out)?;
    watch.lap("load");
    let mut progress = Progress::new(asked.common.quiet);
    let outcome = study::compare(&pair, &mut |event| {
        progress.hear(&event);
        interrupt::flow()
    })?;
    watch.lap("shadows");

    let (place, track, receivers) = (&pair.after.place, &pair.after.track, pair.after.receivers);
    let [first, second] = [0, 1].map(|at| {
        let (mesh, surface, drawn) = (&outcome.meshes[at], &outcome.surfaces[at], &outcome.drawn[at]);
        figure::Scene { place, track, mesh, surface, receivers, drawn }
    });
    let change = &outcome.comparison;
    let picture = figure::difference(&[first, second], &pair.names, change)?;
    watch.lap("picture");
    interrupt::check()?;
    let raster = raster::difference_geotiff(change, place)?;
    watch.lap("raster");
    interrupt::check()?;
    let drawn = &outcome.drawn[1];
    let told = Told { receivers, drawn, timings: &watch.timings(), statistics: None };
    let json = comparison::json(change, &pair.names, place, track, &told)?;
    let files = [
        ("compare.png", picture),
        ("shadow-hours-difference.tif", raster),
        ("compare.json", json.clone().into_bytes()),
    ];
    let mut text = written(&asked.out, &files)?;
    if asked.common.json {
        return say(&json);
    }
    let _ = writeln!(text, "{}", drawn_by(drawn));
    text.push_str(&comparison::table(change, track));
    say(&text)
}
