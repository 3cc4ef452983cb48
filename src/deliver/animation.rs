//! The animation: the study's instants as pictures, and as a GIF. Both are in one folder, and the GIF is made once all
//! pictures exist.

use super::parts::{DrawnView, figure_context, note, note_letters, report_context};
use super::{DeliverError, Folder, Sink, WrittenFiles};
use crate::export::animation::{Frames, MOST_FRAMES};
use crate::export::figure::{self, PictureExtras};
use crate::export::report::{self, ReportContext};
use crate::profile::Provenance;
use crate::site::Site;
use crate::study::{self, Event, Frame, FrameView, OnEvent, Stopwatch, tell};
use std::path::{Path, PathBuf};

/// The default width of a picture, pixels.
pub const WIDTH: u32 = 1280;
/// The default number of pictures per second.
pub(crate) const FPS: u16 = 4;

/// The request for an animation.
#[derive(Clone, Debug)]
pub struct AnimationRequest {
    /// The view of the site.
    pub view: FrameView,
    /// The width of a picture, pixels.
    pub width: u32,
    /// Pictures per second in the GIF. Each is shown for a whole number of hundredths of a second.
    pub fps: u16,
    /// A stopwatch that has been running since before the site was read.
    pub watch: Stopwatch,
}

/// The result of an animation.
#[derive(Clone, Debug)]
pub struct AnimationAnswer {
    /// The GIF.
    pub gif: PathBuf,
    /// The frames, in order.
    pub frames: WrittenFiles,
    /// The report in JSON.
    pub report: String,
    /// What drew the pictures.
    pub drawn: Provenance,
}

/// Draws every instant of the site's study into a folder. Besides the study's events it reports the stage `gif` for
/// each frame that is added to the GIF.
///
/// # Errors
/// [`DeliverError`]. Too many instants, and files that cannot be written, are refused before anything is drawn.
pub fn animation(
    site: &Site,
    asked: &AnimationRequest,
    folder: Folder<'_>,
    on_event: &mut OnEvent<'_>,
) -> Result<AnimationAnswer, DeliverError> {
    let count = site.track.instants.len();
    if count > MOST_FRAMES {
        return Err(DeliverError::TooManyFrames { count, most: MOST_FRAMES });
    }
    let first_view = asked.view.at_first(site)?;
    // relative names: the sink knows the folder
    let open = Sink::Folder(folder).open(&Frames::outputs(Path::new(""), count), None)?;
    let mut watch = asked.watch.clone();
    watch.lap("load");
    note(open.note(), on_event)?;
    note_letters([site.place.name.as_str()], on_event)?;
    let mut notes = site.notes.clone();
    let mut frames = Frames::new(folder.path, count)?;
    note(frames.note(), on_event)?;
    let drawn = draw(site, asked, &mut frames, &mut |event| {
        study::gather(&event, &site.notes, &mut notes);
        on_event(event)
    })?;
    watch.lap("frames");
    open.check()?;
    // in whole hundredths of a second
    let mut gif = frames.gif((100.0 / f64::from(asked.fps)).round() as u16)?;
    for index in 0..count {
        tell(on_event, Event::Stage("gif"))?;
        gif.add(index)?;
    }
    let gif = gif.finish()?;
    watch.lap("gif");
    let timings = &watch.timings();
    let receivers = study::judged(site, &first_view);
    let told = ReportContext { notes: &notes, ..report_context(site, receivers, &drawn, timings, None) };
    let report = report::shadow_json(&first_view, &site.place, &site.track, &told)?;
    let paths = (0..count).map(|index| Frames::path(folder.path, index)).collect();
    Ok(AnimationAnswer { gif, frames: WrittenFiles { paths, files: Vec::new() }, report, drawn })
}

fn draw(
    site: &Site,
    asked: &AnimationRequest,
    frames: &mut Frames,
    on_event: &mut OnEvent<'_>,
) -> Result<Provenance, DeliverError> {
    study::frames(site, asked.view, on_event, &mut |frame| -> Result<(), DeliverError> {
        let Frame { track, mask, view, surface, surface_mesh: mesh, receivers, drawn } = *frame;
        let scene =
            figure::FigureContext { track, ..figure_context(site, DrawnView { receivers, surface, mesh, drawn }) };
        let picture = figure::instant_on_screen(&scene, &view, mask, &PictureExtras::default(), asked.width)?;
        Ok(frames.add(&picture)?)
    })
}
