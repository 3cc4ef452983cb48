//! `gnomon animate`: the study's instants as pictures, and as a GIF.

use super::arguments::{Common, DrawArgs, PlanArgs, SiteArgs, WindowArgs};
use super::commands::drawn_by;
use super::eye::Viewpoint;
use super::model::ModelArgs;
use super::output::{say, who};
use super::progress::Progress;
use crate::deliver::Folder;
use crate::deliver::animation::{AnimationAnswer, AnimationRequest, FPS, WIDTH, animation};
use crate::export::figure;
use crate::site::{Overrides, Site, SiteError};
use crate::study::Stopwatch;
use clap::{Args, value_parser};
use std::path::PathBuf;

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
    /// The view
    #[arg(long, value_name = "NAME", value_enum, default_value_t = Viewpoint::Plan)]
    view: Viewpoint,
    /// Width of a picture, 320 to 3508: the same drawing as shadow's, with fewer pixels
    #[arg(long, value_name = "PIXELS", default_value_t = WIDTH, allow_negative_numbers = true,
          value_parser = value_parser!(u32).range(320..=i64::from(figure::WIDTH)))]
    width: u32,
    /// Pictures per second in the GIF, 1 to 50, rounded to whole hundredths of a second per picture
    #[arg(long, value_name = "N", default_value_t = FPS, allow_negative_numbers = true,
          value_parser = value_parser!(u16).range(1..=50))]
    fps: u16,
    /// Folder for the files
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    #[command(flatten)]
    pub(super) common: Common,
}

impl AnimateArgs {
    fn overrides(&self) -> Result<Overrides, SiteError> {
        let asked = self.draw.onto(self.window.onto(self.model.onto(self.site.overrides()?))?);
        Ok(Overrides { side: self.view.side(), ..self.plan.onto(asked)? })
    }
}

pub(super) fn animate(asked: &AnimateArgs) -> anyhow::Result<()> {
    let watch = Stopwatch::start();
    asked.view.check(&asked.plan.given())?;
    let site = Site::load(asked.site.path(), &asked.overrides()?)?;
    let request = AnimationRequest { view: asked.view.of(&site), width: asked.width, fps: asked.fps, watch };
    let mut progress = Progress::new(asked.common.quiet);
    let folder = Folder { path: &asked.out, who: &who(), inputs: &asked.site.inputs()? };
    let AnimationAnswer { gif, frames, report, drawn } =
        animation(&site, &request, folder, &mut |event| progress.heard(&event))?;
    if asked.common.json {
        return say(&report);
    }
    let count = frames.paths.len();
    let [first, last] = [0, count - 1].map(|index| frames.paths[index].display().to_string());
    let night = site.track.instants.iter().filter(|instant| instant.night).count();
    let of_them = if night > 0 { format!(", {night} of them at night") } else { String::new() };
    let drawn = drawn_by(&drawn, &site.ground);
    say(&format!("{}\n{first} to {last}\n{count} frames{of_them}\n{drawn}\n", gif.display()))
}
