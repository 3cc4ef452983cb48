//! The shadows of one instant, in the plan, from a side or in a camera's picture.

use super::again::persist;
use super::chooser::{choose, counting, not_patches, of_volumes};
use super::{Event, InstantOutcome, InstantWants, NOTHING_COUNTED, OnEvent, SiteView, Stopwatch, StudyError};
use super::{judged, night, note_site, subject_of, tell, tiles};
use crate::gpu::Gpu;
use crate::message::{Field, aside, message};
use crate::shadow::{Technique, plan_surface};
use crate::site::Site;
use crate::sun::Instant;
use crate::view::{Mask, Overlay, Tile, View};
use std::sync::Arc;

/// Draws the shadows at the track's first instant. At night nothing sees the sun, and a note says so.
///
/// [`Site::receivers`] applies to the plan. A camera always judges what it sees.
///
/// # Errors
/// [`StudyError`].
pub fn instant(
    site: &Site,
    view: View,
    wants: &InstantWants,
    on_event: &mut OnEvent<'_>,
) -> Result<InstantOutcome, StudyError> {
    not_patches(site)?;
    note_site(site, on_event)?;
    // only an adapter draws and counts volumes
    let can = !wants.volumes && !wants.silhouette && wants.counted.is_none();
    persist(site, can, on_event, &mut |site, gpu, on_event| once(gpu, site, view, wants, on_event))
}

/// As [`instant()`], on one machine.
fn once(
    gpu: Option<&Arc<Gpu>>,
    site: &Site,
    view: View,
    wants: &InstantWants,
    on_event: &mut OnEvent<'_>,
) -> Result<InstantOutcome, StudyError> {
    let mut watch = Stopwatch::start();
    let instant = site.track.instants.first().ok_or(StudyError::NoInstant)?;
    let machine = match (shows_volumes(wants), wants.counted) {
        (true, _) => of_volumes(gpu, site, &view)?,
        (false, Some(counted)) => counting(gpu, site, &view, counted.field())?,
        (false, None) => choose(gpu, site, &view, on_event)?,
    };
    let look = SiteView { site, machine: &machine, view, receivers: judged(site, &view) };
    let tiles = tiles_of(&look, wants)?;
    let first = tiles.first().filter(|tile| !tile.is_whole());
    super::event::note_tiles(&tiles, on_event)?;
    let mut technique = first.map_or_else(|| look.technique(), |tile| look.technique_of(*tile))?;
    let surface = match (wants.surface, view) {
        (false, _) => None,
        (true, View::Plan(grid)) if first.is_some() => {
            Some(plan_surface(&look.surface_mesh(), site.ground.level, &grid))
        }
        (true, _) => Some(look.surface(&*technique)?),
    };
    watch.lap("prepare");

    let count = tiles.len().max(1);
    tell(on_event, Event::Started { instants: count, tiles: count })?;
    let (mut overlay, mut counted) = (None, None);
    let mask = if instant.night {
        note_night(instant, wants, on_event)?;
        night(&view)
    } else {
        overlay = overlay_of(&look, wants, instant, on_event)?;
        if wants.counted.is_some() {
            counted = technique.counted(instant.to_sun)?;
        }
        match first {
            None => technique.draw(instant.to_sun)?.read()?,
            Some(_) => in_tiles(&look, technique.as_mut(), &tiles, instant, on_event)?,
        }
    };
    if let Some(note) = technique.note() {
        tell(on_event, Event::Note(note.into()))?;
    }
    tell(on_event, Event::Drawn { index: count - 1, count, time: instant.time, mask: Some(&mask), bits: None })?;
    watch.lap("shadows");
    let (surface_mesh, timings, drawn) = (look.surface_mesh(), watch.stages, machine.drawn());
    Ok(InstantOutcome { mask, surface, overlay, counted, surface_mesh, timings, drawn })
}

/// Whether volumes or silhouettes are laid over the picture.
fn shows_volumes(wants: &InstantWants) -> bool {
    wants.volumes || wants.silhouette
}

/// The tiles of a plan; empty for other views. Counts are refused if there are several tiles.
fn tiles_of(look: &SiteView<'_>, wants: &InstantWants) -> Result<Vec<Tile>, StudyError> {
    let tiles = match look.view {
        View::Plan(grid) => tiles::of_instant(grid, subject_of(look.site, &look.view), look.machine),
        View::Camera(_) | View::Elevation(_) => Vec::new(),
    };
    match (tiles.first().filter(|tile| !tile.is_whole()), wants.counted) {
        (Some(_), Some(counted)) => {
            let message = message![
                "the plan is done in tiles, and counts are reported only for a whole plan";
                "take larger cells", aside(Field::Cell), ", or leave it out"
            ];
            Err(StudyError::Conflict { field: counted.field(), message })
        }
        _ => Ok(tiles),
    }
}

/// Notes that it is night, and what cannot be shown therefore.
fn note_night(instant: &Instant, wants: &InstantWants, on_event: &mut OnEvent<'_>) -> Result<(), StudyError> {
    let below = -instant.altitude_deg();
    tell(
        on_event,
        Event::Note(format!("night: the sun is {below:.1}° below the horizon, and nothing sees it").into()),
    )?;
    if shows_volumes(wants) {
        tell(on_event, Event::Note("without a sun there are no volumes and no silhouette".to_owned().into()))?;
    }
    if wants.counted.is_some() {
        tell(on_event, Event::Note(NOTHING_COUNTED.to_owned().into()))?;
    }
    Ok(())
}

/// The overlay of the picture if it was requested, and a note if it is empty.
fn overlay_of(
    look: &SiteView<'_>,
    wants: &InstantWants,
    instant: &Instant,
    on_event: &mut OnEvent<'_>,
) -> Result<Option<Overlay>, StudyError> {
    let overlay = look.overlay(wants, instant.to_sun)?;
    if overlay.as_ref().is_some_and(Overlay::is_empty) {
        let note = "there are no volumes and no silhouette to see: no caster stands above the ground in this view";
        tell(on_event, Event::Note(note.to_owned().into()))?;
    }
    Ok(overlay)
}

/// Draws the plan's mask tile by tile; `technique` is made for the first one.
fn in_tiles(
    look: &SiteView<'_>,
    technique: &mut dyn Technique,
    tiles: &[Tile],
    instant: &Instant,
    on_event: &mut OnEvent<'_>,
) -> Result<Mask, StudyError> {
    let mut mask = night(&look.view);
    let plan_width = mask.width as usize;
    let mut made;
    let mut technique = technique;
    for (index, tile) in tiles.iter().enumerate() {
        if index > 0 && !technique.turn_to_tile(*tile)? {
            made = look.technique_of(*tile)?;
            technique = made.as_mut();
        }
        let part = technique.draw(instant.to_sun)?.read()?;
        let [left, top] = tile.first.map(|first| first as usize);
        let rows = mask.share.chunks_exact_mut(plan_width).skip(top);
        for (to, from) in rows.zip(part.share.chunks_exact(part.width as usize)) {
            to[left..left + from.len()].copy_from_slice(from);
        }
        // the last tile is reported with the whole mask
        if index + 1 < tiles.len() {
            let drawn = Event::Drawn { index, count: tiles.len(), time: instant.time, mask: None, bits: None };
            tell(on_event, drawn)?;
        }
    }
    Ok(mask)
}
