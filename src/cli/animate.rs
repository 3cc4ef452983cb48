//! `gnomon animate`: the study's instants as pictures, and as a GIF.

use super::arguments::{Common, DrawArgs, PlanArgs, SiteArgs, WindowArgs};
use super::commands::drawn_by;
use super::eye::Eye;
use super::model::ModelArgs;
use super::progress::Progress;
use super::{WrongUse, interrupt, say, who};
use crate::export::animation::{Frames, MOST_FRAMES};
use crate::export::report::{self, Told};
use crate::export::workplace::Workplace;
use crate::export::{figure, file};
use crate::profile::Drawn;
use crate::site::{Overrides, Site, inputs};
use crate::study::{self, Event, OnEvent, Stopwatch, StudyError};
use crate::view::View;
use clap::{Args, value_parser};
use std::path::{Path, PathBuf};

/// How wide a picture is where nobody says, pixels.
pub(crate) const WIDTH: u32 = 1280;
/// Pictures a second where nobody says.
pub(crate) const FPS: u16 = 4;

#[derive(Debug, Args)]
pub(super) struct AnimateArgs {
    #[command(flatten)]
    site: SiteArgs,
    #[command(flatten)]
    model: ModelArgs,
    #[command(flatten)]
    window: WindowArgs,
    #[command(flatten)]
    draw: DrawArgs,
    #[command(flatten)]
    plan: PlanArgs,
    /// From where
    #[arg(long, value_name = "NAME", value_enum, default_value_t = Eye::Plan)]
    view: Eye,
    /// How wide a picture is, 320 to 3508: the sheet that shadow draws, in fewer pixels
    #[arg(long, value_name = "PIXELS", default_value_t = WIDTH, allow_negative_numbers = true,
          value_parser = value_parser!(u32).range(320..=i64::from(figure::WIDTH)))]
    width: u32,
    /// Pictures a second in the GIF, 1 to 50; each is shown for whole hundredths of a second, the nearest
    #[arg(long, value_name = "N", default_value_t = FPS, allow_negative_numbers = true,
          value_parser = value_parser!(u16).range(1..=50))]
    fps: u16,
    /// The folder for the files
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    #[command(flatten)]
    pub(super) common: Common,
}

impl AnimateArgs {
    fn overrides(&self) -> Overrides {
        let asked = self.plan.onto(self.draw.onto(self.window.onto(self.model.onto(self.site.overrides()))));
        Overrides { side: self.view.side(), ..asked }
    }
}

pub(super) fn animate(asked: &AnimateArgs) -> anyhow::Result<()> {
    let mut watch = Stopwatch::start();
    asked.view.check(&asked.plan)?;
    let site = Site::load(&asked.site.path, &asked.overrides())?;
    let (place, track, out) = (&site.place, &site.track, &asked.out);
    let count = check(&site)?;
    let outputs = Frames::outputs(out, count);
    file::check_inputs(&inputs(&asked.site.path)?, &outputs)?;
    let workplace = Workplace::take([out.as_path()], &outputs, &who())?;
    watch.lap("load");

    let view = asked.view.of(&site);
    let mut progress = Progress::new(asked.common.quiet);
    progress.note(workplace.note());
    progress.letters([place.name.as_str()]);
    let (drawn, frames) = frames(&site, view, out, asked.width, &mut |event| {
        progress.hear(&event);
        interrupt::flow()
    })?;
    watch.lap("frames");
    workplace.check()?;
    let path = gif(frames, count, asked.fps, &mut |_| interrupt::check())?;
    watch.lap("gif");

    if asked.common.json {
        let (receivers, timings) = (study::judged(&site, &view), &watch.timings());
        let notes = &site.notes;
        let told = Told { receivers, ground: site.ground, drawn: &drawn, timings, statistics: None, notes };
        return say(&report::shadow_json(&view, place, track, &told)?);
    }
    let [first, last] = [0, count - 1].map(|index| Frames::path(out, index).display().to_string());
    let night = track.instants.iter().filter(|instant| instant.night).count();
    let of_them = if night > 0 { format!(", {night} of them at night") } else { String::new() };
    say(&format!(
        "{}\n{first} to {last}\n{count} frames{of_them}\n{}\n",
        path.display(),
        drawn_by(&drawn, &site.ground)
    ))
}

/// How many frames a site's study has.
///
/// # Errors
/// [`WrongUse`] where those are too many.
pub(crate) fn check(site: &Site) -> anyhow::Result<usize> {
    let count = site.track.instants.len();
    if count > MOST_FRAMES {
        let what = format!(
            "the study has {count} instants, and an animation at most {MOST_FRAMES} frames; take a longer --step, or \
             fewer hours with --from and --to"
        );
        return Err(WrongUse(what).into());
    }
    Ok(count)
}

/// Draws the frames into a folder, so many pixels wide.
pub(crate) fn frames(
    site: &Site,
    view: View,
    out: &Path,
    width: u32,
    on_event: &mut OnEvent<'_>,
) -> anyhow::Result<(Drawn, Frames)> {
    let mut frames = Frames::new(out, site.track.instants.len())?;
    if let Some(note) = frames.note() {
        // what is to be given up is given up at the first frame
        let _ = on_event(Event::Note(note));
    }
    let drawn = study::frames(site, view, on_event, &mut |frame| -> anyhow::Result<()> {
        let study::Frame { track, mask, surface, surface_mesh: mesh, receivers, drawn } = *frame;
        let scene = figure::Scene { place: &site.place, track, mesh, surface, receivers, ground: site.ground, drawn };
        let picture = figure::instant_on_screen(&scene, &view, mask, &figure::Shown::default(), width)?;
        Ok(frames.add(&picture)?)
    })?;
    Ok((drawn, frames))
}

/// Makes the GIF of as many frames, so many a second; returns its path. Who is told of each can end it.
pub(crate) fn gif(
    frames: Frames,
    count: usize,
    fps: u16,
    on_frame: &mut dyn FnMut(usize) -> Result<(), StudyError>,
) -> anyhow::Result<PathBuf> {
    let mut gif = frames.gif(hundredths(fps))?;
    for index in 0..count {
        on_frame(index)?;
        gif.add(index)?;
    }
    Ok(gif.finish()?)
}

/// For how long a frame is shown.
fn hundredths(fps: u16) -> u16 {
    (100.0 / f64::from(fps)).round() as u16
}
