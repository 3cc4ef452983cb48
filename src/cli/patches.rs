//! `gnomon profile --receivers surfaces`: hours of sun on the models' surfaces.

use super::arguments::{ProfileArgs, ProfileFile};
use super::commands::{between, drawn_by, lines};
use super::output::{say, who};
use super::progress::Progress;
use super::wrong_use::WrongUse;
use crate::choice::Receivers;
use crate::deliver::patches::{PatchesRequest, patches as deliver};
use crate::deliver::{Folder, Sink};
use crate::site::Site;
use crate::study::Stopwatch;
use std::fmt::Write;

pub(super) fn profile(asked: &ProfileArgs, site: &Site, watch: Stopwatch) -> anyhow::Result<()> {
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
        let what = format!("{option} is for the plan, but --receivers surfaces has none; leave one of the two out");
        return Err(WrongUse(what).into());
    }
    let kinds = asked.wanted(&[ProfileFile::Png, ProfileFile::Glb, ProfileFile::Csv, ProfileFile::Json])?;
    let wanted = |kind| kinds.contains(&kind);
    let request = PatchesRequest {
        drawing: wanted(ProfileFile::Png),
        model: wanted(ProfileFile::Glb),
        table: wanted(ProfileFile::Csv),
        report: wanted(ProfileFile::Json),
        watch,
    };
    let mut progress = Progress::new(asked.common.quiet);
    let sink = Sink::Folder(Folder { path: &asked.out, who: &who(), inputs: &asked.site.inputs()? });
    let answer = deliver(site, &request, sink, &mut |event| progress.heard(&event))?;
    if asked.common.json {
        return say(&answer.report);
    }
    let mut text = lines(&answer.written);
    // writing to a String cannot fail
    let _ = writeln!(text, "{}", drawn_by(&answer.drawn, &site.ground));
    text.push_str(&between(&answer.drawn, Receivers::Patches, site));
    text.push_str(&answer.summary);
    say(&text)
}
