//! `gnomon profile`: the hours of shadow on the plan, or the hours of sun on patches.

use super::arguments::{ProfileArgs, ProfileFile};
use super::commands::{between, drawn_by, lines, took};
use super::output::{say, who};
use super::patches;
use super::progress::Progress;
use crate::choice::Receivers;
use crate::deliver::profile::{ProfileAnswer, ProfileRequest, profile as deliver};
use crate::deliver::{Folder, Sink};
use crate::site::Site;
use crate::study::Stopwatch;
use std::fmt::Write;

/// `gnomon profile`
pub(super) fn profile(asked: &ProfileArgs) -> anyhow::Result<()> {
    let watch = Stopwatch::start();
    let site = Site::load(asked.site.path(), &asked.overrides()?)?;
    if site.receivers == Receivers::Patches {
        return patches::profile(asked, &site, watch);
    }
    let kinds = asked.wanted(&[ProfileFile::Png, ProfileFile::Tif, ProfileFile::Json])?;
    let wanted = |kind| kinds.contains(&kind);
    let request = ProfileRequest {
        drawing: wanted(ProfileFile::Png),
        raster: wanted(ProfileFile::Tif),
        report: wanted(ProfileFile::Json),
        lines: &asked.lines.lines(),
        masks: asked.masks.as_deref(),
        bits: asked.bits,
        statistics: asked.stats,
        memory: asked.memory,
        watch,
    };
    let mut progress = Progress::new(asked.common.quiet);
    let sink = Sink::Folder(Folder { path: &asked.out, who: &who(), inputs: &asked.site.inputs()? });
    let answer = deliver(&site, &request, sink, &mut |event| progress.heard(&event))?;
    if asked.common.json {
        return say(&answer.report);
    }
    let mut text = lines(&answer.written);
    if let Some(folder) = &asked.masks {
        // writing to a String cannot fail
        let _ = writeln!(text, "{} ({} masks)", folder.display(), answer.masks);
    }
    let _ = writeln!(text, "{}", drawn_by(&answer.drawn, &site.ground));
    text.push_str(&between(&answer.drawn, site.receivers, &site));
    text.push_str(&answer.statistics.as_ref().map(took).unwrap_or_default());
    text.push_str(&extent(&answer, &site));
    say(&text)
}

/// The range of the hours, in two lines.
fn extent(answer: &ProfileAnswer, site: &Site) -> String {
    let (range, grid, instants) = (&answer.range, &site.grid, &site.track.instants);
    let night = instants.iter().filter(|instant| instant.night).count();
    format!(
        "{:.2} to {:.2} h of shadow out of {:.2} h with the sun above the horizon\n{} × {} cells of {} m, {} instants{}\n",
        range.least,
        range.most,
        range.day,
        grid.width,
        grid.height,
        (grid.cell * 1e6).round() / 1e6,
        instants.len(),
        if night > 0 { format!(", {night} of them at night") } else { String::new() },
    )
}
