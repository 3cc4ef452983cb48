//! Every instant of a study as a picture: night too.

use super::machine::{choose, not_surfaces};
use super::{Event, Look, OnEvent, StudyError, judged, night, note_models, tell, tiles};
use crate::mesh::Mesh;
use crate::profile::Drawn;
use crate::shadow::Technique;
use crate::site::{Receivers, Site};
use crate::sun::SunTrack;
use crate::view::{Mask, Surface, View};
use glam::DVec3;

/// One of them.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// Its instant alone.
    pub track: &'a SunTrack,
    /// Which part of the sun each cell sees.
    pub mask: &'a Mask,
    /// What the cells see; the same in all frames.
    pub surface: &'a Surface,
    /// Whose faces [`Surface::face`] counts.
    pub surface_mesh: &'a Mesh,
    /// Which surfaces were judged.
    pub receivers: Receivers,
    /// What drew it.
    pub drawn: &'a Drawn,
}

/// As [`super::instant`] for every instant of the study, with what is kept from one to the next. Returns what drew them.
///
/// # Errors
/// [`StudyError`], and what `on_frame` says.
pub fn frames<E: From<StudyError>>(
    site: &Site,
    view: View,
    on_event: &mut OnEvent<'_>,
    on_frame: &mut dyn FnMut(&Frame<'_>) -> Result<(), E>,
) -> Result<Drawn, E> {
    not_surfaces(site)?;
    note_models(&site.notes, on_event)?;
    let machine = choose(site, &view, on_event)?;
    if let View::Plan(grid) = view {
        tiles::at_once(grid, site.receivers, &machine)?;
    }
    let look = Look { site, machine: &machine, view, receivers: judged(site, &view) };
    let mut technique = look.technique().map_err(StudyError::from)?;
    let surface = look.surface(&*technique).map_err(StudyError::from)?;
    let (surface_mesh, drawn) = (look.surface_mesh(), machine.drawn());
    let dark = night(&view);

    let count = site.track.instants.len();
    tell(on_event, Event::Started { instants: count, tiles: 1 })?;
    let mut noted = None;
    for (index, (instant, track)) in site.track.instants.iter().zip(site.track.each()).enumerate() {
        let lit = if instant.night { None } else { Some(draw(&mut *technique, instant.to_sun)?) };
        let mask = lit.as_ref().unwrap_or(&dark);
        // told once where the same holds again and again
        let note = technique.note().filter(|note| noted.as_ref() != Some(note));
        if let Some(note) = note {
            tell(on_event, Event::Note(note.clone()))?;
            noted = Some(note);
        }
        let (track, surface, surface_mesh, drawn) = (&track, &surface, &surface_mesh, &drawn);
        on_frame(&Frame { track, mask, surface, surface_mesh, receivers: look.receivers, drawn })?;
        tell(on_event, Event::Drawn { index, count, time: instant.time, mask: None, bits: None })?;
    }
    Ok(drawn)
}

fn draw(technique: &mut dyn Technique, to_sun: DVec3) -> Result<Mask, StudyError> {
    Ok(technique.draw(to_sun)?.read()?)
}
