//! Draws every instant of a study as a picture, including those at night.

use super::again::persist;
use super::chooser::{choose, not_patches};
use super::machine::Machine;
use super::{Event, OnEvent, SiteView, StudyError, judged, night, note_site, subject_of, tell, tiles};
use crate::choice::Receivers;
use crate::gpu::Gpu;
use crate::mesh::Mesh;
use crate::profile::Provenance;
use crate::shadow::Technique;
use crate::site::Site;
use crate::sun::{Instant, SunTrack};
use crate::view::{Mask, Surface, View};
use std::sync::Arc;

/// From where frames are seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FrameView {
    /// All of them from one view.
    Still(View),
    /// Each along the rays of its own sun.
    Sun,
}

impl FrameView {
    /// The view at an instant.
    ///
    /// # Errors
    /// [`StudyError::NoSunToSee`] where there is no sun from which it could be seen.
    pub fn at(&self, site: &Site, instant: &Instant) -> Result<View, StudyError> {
        match self {
            FrameView::Still(view) => Ok(*view),
            FrameView::Sun => {
                let seen = site.sun_view(instant.to_sun).filter(|_| !instant.night);
                let (time, below_deg) = (instant.time, -instant.altitude_deg());
                seen.ok_or(StudyError::NoSunToSee { time, below_deg })
            }
        }
    }

    /// The view at the first instant of a study, which must have a sun at all of them where that is the viewer.
    ///
    /// # Errors
    /// As of [`FrameView::at`].
    pub fn at_first(&self, site: &Site) -> Result<View, StudyError> {
        let mut views = site.track.instants.iter().map(|instant| self.at(site, instant));
        let first = views.next().unwrap_or(Ok(View::Plan(site.grid)))?;
        views.try_for_each(|view| view.map(drop))?;
        Ok(first)
    }
}

/// One frame of an animation.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// A track with only its instant.
    pub track: &'a SunTrack,
    /// The share of the sun that each cell sees.
    pub mask: &'a Mask,
    /// From where it is seen.
    pub view: View,
    /// What the cells see; the same in all frames of one view.
    pub surface: &'a Surface,
    /// The mesh to which [`Surface::face`] refers.
    pub surface_mesh: &'a Mesh,
    /// The receivers that were judged.
    pub receivers: Receivers,
    /// What drew the mask.
    pub drawn: &'a Provenance,
}

/// Draws as `study::instant` for every instant of the study, but keeps resources from one to the next. Returns what
/// drew them.
///
/// # Errors
/// [`StudyError`], and the errors of `on_frame`.
pub fn frames<E: From<StudyError>>(
    site: &Site,
    view: FrameView,
    on_event: &mut OnEvent<'_>,
    on_frame: &mut dyn FnMut(&Frame<'_>) -> Result<(), E>,
) -> Result<Provenance, E> {
    not_patches(site)?;
    note_site(site, on_event)?;
    // frames that were already delivered keep their own provenance
    let (mut given, mut fault) = (0, None);
    let drawn = persist(site, true, on_event, &mut |site, gpu, on_event| {
        let first = given;
        from(first, gpu, site, view, on_event, &mut |frame| {
            given += 1;
            on_frame(frame).map_err(|error| {
                fault = Some(error);
                StudyError::Interrupted
            })
        })
    });
    match fault {
        Some(fault) => Err(fault),
        None => Ok(drawn?),
    }
}

/// Draws the frames from one on, on one machine.
fn from(
    first: usize,
    gpu: Option<&Arc<Gpu>>,
    site: &Site,
    view: FrameView,
    on_event: &mut OnEvent<'_>,
    on_frame: &mut dyn FnMut(&Frame<'_>) -> Result<(), StudyError>,
) -> Result<Provenance, StudyError> {
    let first_view = view.at_first(site)?;
    let machine = choose(gpu, site, &first_view, on_event)?;
    if let View::Plan(grid) = first_view {
        tiles::at_once(grid, subject_of(site, &first_view), &machine)?;
    }
    let mut seen = SeenView::of(site, &machine, first_view)?;
    let (surface_mesh, drawn) = (seen.look.surface_mesh(), machine.drawn());

    let count = site.track.instants.len();
    tell(on_event, Event::Started { instants: count, tiles: 1 })?;
    let mut noted = None;
    for (index, (instant, track)) in site.track.instants.iter().zip(site.track.each()).enumerate().skip(first) {
        let view = view.at(site, instant)?;
        if view != seen.look.view {
            seen = SeenView::of(site, &machine, view)?;
        }
        let lit = if instant.night { None } else { Some(seen.technique.draw(instant.to_sun)?.read()?) };
        let mask = lit.as_ref().unwrap_or(&seen.dark);
        // a repeated note is reported once
        let note = seen.technique.note().filter(|note| noted.as_ref() != Some(note));
        if let Some(note) = note {
            tell(on_event, Event::Note(note.clone().into()))?;
            noted = Some(note);
        }
        let (track, surface, surface_mesh, drawn) = (&track, &seen.surface, &surface_mesh, &drawn);
        on_frame(&Frame { track, mask, view, surface, surface_mesh, receivers: seen.look.receivers, drawn })?;
        tell(on_event, Event::Drawn { index, count, time: instant.time, mask: None, bits: None })?;
    }
    Ok(drawn)
}

/// One view, and what draws it.
struct SeenView<'a> {
    look: SiteView<'a>,
    technique: Box<dyn Technique>,
    surface: Surface,
    /// The mask of a night.
    dark: Mask,
}

impl<'a> SeenView<'a> {
    fn of(site: &'a Site, machine: &'a Machine, view: View) -> Result<SeenView<'a>, StudyError> {
        let look = SiteView { site, machine, view, receivers: judged(site, &view) };
        let technique = look.technique()?;
        let surface = look.surface(&*technique)?;
        Ok(SeenView { look, technique, surface, dark: night(&view) })
    }
}
