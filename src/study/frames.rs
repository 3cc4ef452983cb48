//! Draws every instant of a study as a picture, including those at night.

use super::again::persist;
use super::chooser::{choose, not_patches};
use super::{Event, OnEvent, SiteView, StudyError, judged, night, note_site, subject_of, tell, tiles};
use crate::choice::Receivers;
use crate::gpu::Gpu;
use crate::mesh::Mesh;
use crate::profile::Provenance;
use crate::site::Site;
use crate::sun::SunTrack;
use crate::view::{Mask, Surface, View};
use std::sync::Arc;

/// One frame of an animation.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// A track with only its instant.
    pub track: &'a SunTrack,
    /// The share of the sun that each cell sees.
    pub mask: &'a Mask,
    /// What the cells see; the same in all frames.
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
    view: View,
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
    view: View,
    on_event: &mut OnEvent<'_>,
    on_frame: &mut dyn FnMut(&Frame<'_>) -> Result<(), StudyError>,
) -> Result<Provenance, StudyError> {
    let machine = choose(gpu, site, &view, on_event)?;
    if let View::Plan(grid) = view {
        tiles::at_once(grid, subject_of(site, &view), &machine)?;
    }
    let look = SiteView { site, machine: &machine, view, receivers: judged(site, &view) };
    let mut technique = look.technique()?;
    let surface = look.surface(&*technique)?;
    let (surface_mesh, drawn) = (look.surface_mesh(), machine.drawn());
    let dark = night(&view);

    let count = site.track.instants.len();
    tell(on_event, Event::Started { instants: count, tiles: 1 })?;
    let mut noted = None;
    for (index, (instant, track)) in site.track.instants.iter().zip(site.track.each()).enumerate().skip(first) {
        let lit = if instant.night { None } else { Some(technique.draw(instant.to_sun)?.read()?) };
        let mask = lit.as_ref().unwrap_or(&dark);
        // a repeated note is reported once
        let note = technique.note().filter(|note| noted.as_ref() != Some(note));
        if let Some(note) = note {
            tell(on_event, Event::Note(note.clone().into()))?;
            noted = Some(note);
        }
        let (track, surface, surface_mesh, drawn) = (&track, &surface, &surface_mesh, &drawn);
        on_frame(&Frame { track, mask, surface, surface_mesh, receivers: look.receivers, drawn })?;
        tell(on_event, Event::Drawn { index, count, time: instant.time, mask: None, bits: None })?;
    }
    Ok(drawn)
}
