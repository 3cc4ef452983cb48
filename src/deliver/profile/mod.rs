//! The shadow profile of a study: hours of shadow on the plan, as a drawing, a raster, a report, lines, masks and bits.
//!
//! A study that was stopped in a folder continues there. A caller that shows hours first and writes them later uses
//! [`find_hours`] and [`write_hours`].

mod files;
mod hours;
mod keeping;
mod request;
mod sums;

pub use hours::{Hours, Range};
pub use request::ProfileRequest;
pub use sums::Sums;

use super::parts::{note, note_letters};
use super::shelf::{self, Beside};
use super::{DeliverError, Folder, Sink, WrittenFiles};
use crate::export::figure::Outline;
use crate::profile::{Provenance, Statistics};
use crate::site::Site;
use crate::study::{Event, OnEvent, StudyError, tell};
use crate::view::Bits;
use files::Pieces;
use request::mask_path;

pub(super) use hours::find as find_kept;
pub(super) use keeping::StudyStore;

/// The result of a profile.
#[derive(Clone, Debug)]
pub struct ProfileAnswer {
    /// The files that were written, without the masks.
    pub written: WrittenFiles,
    /// The number of masks that were written.
    pub masks: usize,
    /// The contents of `profile.json`, whether it was written or not.
    pub report: String,
    /// What drew the shadows.
    pub drawn: Provenance,
    /// The statistics of counting, if they were requested.
    pub statistics: Option<Statistics>,
    /// The least and the most hours.
    pub range: Range,
}

/// Computes the hours of shadow on the site's plan, and writes the requested files.
///
/// # Errors
/// [`DeliverError`]. Contradictory requests, and files that cannot be written, are refused before anything is drawn.
pub fn profile(
    site: &Site,
    asked: &ProfileRequest<'_>,
    sink: Sink<'_>,
    on_event: &mut OnEvent<'_>,
) -> Result<ProfileAnswer, DeliverError> {
    let mut watch = asked.watch.clone();
    asked.lines.iter().try_for_each(|lines| lines.check(&site.track))?;
    let open = sink.open(&asked.names(), asked.mask_files(site))?;
    note(open.note(), on_event)?;
    note_drawn_letters(site, asked, on_event)?;
    watch.lap("load");

    let (hours, mut keeping) = hours::find(site, asked, sink.folder(), Beside::Studies(&[]), on_event)?;
    watch.laps(hours.timings.clone());
    let mut stage = |stage| keeping.stage(stage, on_event);
    // bits in a folder are already written
    let asked_now = ProfileRequest { bits: asked.bits && keeping.bits.is_none(), ..asked.clone() };
    let Pieces { ready, report, range } = files::make(site, &hours, &asked_now, &open, &mut watch, &mut stage)?;
    let (drawn, statistics) = (hours.drawn.clone(), hours.statistics);
    let mut written = open.put(ready)?;
    if let Some(bits) = keeping.bits.take() {
        written.paths.push(bits.path().to_owned());
        bits.finish()?;
    }
    // Windows cannot remove an open file
    drop(hours);
    keeping.finish()?;
    let masks = asked.masks.map_or(0, |_| site.track.instants.len());
    written.files.append(&mut keeping.held_masks);
    if let Some(folder) = asked.masks.filter(|_| sink.folder().is_some()) {
        let beyond = Some(mask_path(folder, masks)).filter(|path| path.exists());
        let beyond = beyond
            .map(|path| format!("{} and the masks after it belong to another study; remove them", path.display()));
        // everything is written, so there is nothing left to interrupt
        let _ = note(beyond, on_event);
    }
    Ok(ProfileAnswer { written, masks, report, drawn, statistics, range })
}

/// Notes the letters that no font has, if anything is drawn.
fn note_drawn_letters(site: &Site, asked: &ProfileRequest<'_>, on_event: &mut OnEvent<'_>) -> Result<(), StudyError> {
    let is_drawn = asked.drawing || !asked.lines.is_empty();
    note_letters(is_drawn.then_some(site.place.name.as_str()), on_event)
}

/// Computes hours to be shown, all of them in memory; with bits, each instant's shadow, too.
///
/// If a study is stopped, it is kept in `shelf` (which keeps the newest ones), and continues when the same request is made
/// again. Nothing is kept while another study works there.
///
/// # Errors
/// As [`profile()`].
pub fn find_hours(
    site: &Site,
    asked: &ProfileRequest<'_>,
    shelf: Option<Folder<'_>>,
    on_event: &mut OnEvent<'_>,
) -> Result<Hours, DeliverError> {
    shelf::find(shelf, on_event, |folder, on_event| {
        let (hours, mut keeping) = hours::find(site, asked, folder, Beside::Shelf, on_event)?;
        let mut hours = hours.in_memory()?;
        if let Some(bits) = keeping.bits.take() {
            hours.outlines = outlines_of(site, bits.shadows()?);
        }
        // what cannot be removed now will be removed when newer studies are kept
        let _ = keeping.finish();
        Ok(hours)
    })
}

/// The shadows at the instants with a sun, in order of time, each with its instant.
fn outlines_of(site: &Site, shadows: Vec<Bits>) -> Vec<Outline> {
    let with_sun = site.track.instants.iter().enumerate().filter(|(_, instant)| !instant.night);
    with_sun.zip(shadows).map(|((index, _), shadow)| Outline { index, shadow }).collect()
}

/// Writes the requested files of computed hours. The request's stopwatch continues from [`Hours::timings`].
///
/// # Errors
/// As [`profile()`].
pub fn write_hours(
    site: &Site,
    hours: &Hours,
    asked: &ProfileRequest<'_>,
    sink: Sink<'_>,
    on_event: &mut OnEvent<'_>,
) -> Result<ProfileAnswer, DeliverError> {
    let mut watch = asked.watch.clone();
    asked.lines.iter().try_for_each(|lines| lines.check(&site.track))?;
    let open = sink.open(&asked.names(), None)?;
    note(open.note(), on_event)?;
    note_drawn_letters(site, asked, on_event)?;
    let mut stage = |stage| tell(on_event, Event::Stage(stage));
    let Pieces { ready, report, range } = files::make(site, hours, asked, &open, &mut watch, &mut stage)?;
    let (drawn, statistics) = (hours.drawn.clone(), hours.statistics);
    Ok(ProfileAnswer { written: open.put(ready)?, masks: 0, report, drawn, statistics, range })
}
