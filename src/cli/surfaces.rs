//! `gnomon profile --receivers surfaces`: hours of sun on the model itself.

use super::arguments::{ProfileArgs, Written};
use super::commands::drawn_by;
use super::profile::written;
use super::progress::Progress;
use super::{WrongUse, interrupt, say, who};
use crate::export::report::{self, Told};
use crate::export::surfaces::{self, Surfaces};
use crate::export::workplace::Workplace;
use crate::export::{figure, file};
use crate::site::{Receivers, Site, inputs};
use crate::study::{self, Stopwatch};
use std::fmt::Write;
use std::path::PathBuf;

pub(super) fn profile(asked: &ProfileArgs, site: &Site, mut watch: Stopwatch) -> anyhow::Result<()> {
    let of_plan = asked.plan.given().into_iter().filter(|option| *option != "--receivers");
    let of_masks = [
        ("--masks", asked.masks.is_some()),
        ("--bits", asked.bits),
        ("--memory", asked.memory.is_some()),
        ("--draw", asked.lines.given()),
        ("--stats", asked.stats),
    ];
    let of_masks = of_masks.into_iter().filter(|(_, given)| *given).map(|(option, _)| option);
    if let Some(option) = of_plan.chain(of_masks).next() {
        let what = format!("{option} is for the plan, and --receivers surfaces has none; leave one of the two out");
        return Err(WrongUse(what).into());
    }
    let kinds = asked.wanted(&[Written::Png, Written::Glb, Written::Csv, Written::Json])?;
    let outputs: Vec<PathBuf> = kinds.iter().map(|kind| asked.out.join(kind.file(site.receivers))).collect();
    file::check_inputs(&inputs(&asked.site.path)?, &outputs)?;
    let workplace = Workplace::take([asked.out.as_path()], &outputs, &who())?;
    watch.lap("load");

    let mut progress = Progress::new(asked.common.quiet);
    progress.note(workplace.note());
    if kinds.contains(&Written::Png) {
        progress.letters([site.place.name.as_str()]);
    }
    let outcome = study::surfaces(site, site.patch_cell, &mut |event| {
        progress.hear(&event);
        interrupt::flow()
    })?;
    watch.laps(outcome.timings);

    let Site { place, track, mesh, receives, .. } = site;
    let (drawn, ground) = (&outcome.drawn, site.ground);
    let answer = Surfaces { place, track, mesh, receives, patches: &outcome.patches, hours: &outcome.hours };
    let mut files: Vec<(&str, Vec<u8>)> = Vec::new();
    if kinds.contains(&Written::Png) {
        let (mesh, surface) = &study::seen_receivers(site)?;
        let scene = figure::Scene { place, track, mesh, surface, receivers: Receivers::Surfaces, ground, drawn };
        files.push((Written::Png.file(site.receivers), figure::surfaces(&scene, &site.picture(), &answer)?));
        watch.lap("picture");
        interrupt::check()?;
    }
    if kinds.contains(&Written::Glb) {
        files.push((Written::Glb.file(site.receivers), surfaces::glb(&answer)?));
        watch.lap("model");
        interrupt::check()?;
    }
    if kinds.contains(&Written::Csv) {
        files.push((Written::Csv.file(site.receivers), surfaces::csv(&answer).into_bytes()));
    }
    let (timings, notes) = (&watch.timings(), &site.notes);
    let told = Told { receivers: Receivers::Surfaces, ground, drawn, timings, statistics: None, notes };
    let json = report::surfaces_json(&answer, &told)?;
    if kinds.contains(&Written::Json) {
        files.push((Written::Json.file(site.receivers), json.clone().into_bytes()));
    }
    workplace.check()?;
    let mut text = written(&asked.out, &files)?;
    if asked.common.json {
        return say(&json);
    }
    let _ = writeln!(text, "{}", drawn_by(drawn, &ground));
    text.push_str(&surfaces::summary(&answer));
    say(&text)
}
