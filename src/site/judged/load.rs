//! The site file as written → the request for a verdict.

use super::areas::areas;
use super::before::{AskedSite, states};
use super::facades::facades;
use super::plot::plot;
use super::request::JudgedSite;
use super::rooms::add_rooms;
use super::windows::windows;
use crate::choice::Receivers;
use crate::message::{Message, few, message};
use crate::site::error::{FieldLocation, SiteError};
use crate::site::ground;
use crate::site::models::Models;
use crate::site::overrides::{Overrides, refuse};
use crate::site::probe::dates;
use crate::site::written::WrittenSite;
use chrono::Datelike as _;
use std::path::Path;

/// Reads and checks what is judged of a site. Only the year of the study's date is used. Sides that only rays can tell
/// are left to `study::settle`.
///
/// # Errors
/// Everything that can be wrong with it, each naming the file, the key or option, and a hint.
pub fn load_judged(path: &Path, asked: &Overrides) -> Result<JudgedSite, SiteError> {
    let written = WrittenSite::read(path, asked)?;
    judged_with_models(&written, asked, || Models::read(&written, |path, options| asked.reading.read(path, options)))
}

/// The same of a request that is read already; its models may be read, too.
///
/// # Errors
/// As [`load_judged`].
pub(crate) fn judged_with_models(
    as_written: &WrittenSite,
    asked: &Overrides,
    models: impl FnOnce() -> Result<Models, SiteError>,
) -> Result<JudgedSite, SiteError> {
    let (written, models) = as_written.located(models)?;
    let written = &*written;
    let mut place = written.place(asked)?;
    let (dates, _) = dates(written, asked).map_err(|error| no_date(error, written))?;
    let year = dates[0].year();
    let level = ground::level(written, asked)?;
    let models = models()?.with_terrain(written)?;
    place.elevation_m = models.elevation_m.unwrap_or(place.elevation_m);

    let mut windows = windows(written, &models.mesh)?;
    add_rooms(written, &mut windows)?;
    let site = AskedSite { written, place: &place, models: &models, level, is_glass: &windows.is_glass };
    let (now, before, of_before) = states(&site, asked)?;
    let (areas, of_areas) = areas(written, &place, &models.mesh)?;
    let (facades, of_facades) = facades(written, &models.mesh, now.ground.level)?;
    let (plot, of_plot) = plot(written, &place)?;

    let [casts, receives] = models.roles(written)?;
    let mut notes: Vec<Message> = written.place_note().into_iter().collect();
    notes.extend(models.notes(written, &casts));
    notes.extend(of_before.into_iter().filter(|note| !notes.contains(note)).collect::<Vec<_>>());
    notes.extend(now.ground.notes(&models.mesh, &receives, Receivers::Ground));
    let cast = models.mesh.components.iter().zip(&casts).zip(&windows.is_glass);
    let clear =
        cast.filter(|((_, casts), is_glass)| **casts && **is_glass).map(|((of, _), _)| format!("\"{}\"", of.name));
    notes.extend(note_glass(clear.collect()));
    notes.extend(windows.notes.into_iter().chain(of_areas).chain(of_facades).chain(of_plot));
    let last = dates.last().map_or(year, |date| date.year());
    notes.extend(
        (last != year).then(|| Message::from(format!("the days of {year} are judged, the study's first year"))),
    );
    Ok(JudgedSite {
        file: written.file.clone(),
        place,
        now,
        before,
        notes,
        words: asked.words,
        areas,
        windows: windows.list,
        facades,
        plot,
        year,
        refraction: !asked.no_refraction,
    })
}

/// The site file alone says which year is judged: no face has an option for it.
fn no_date(error: SiteError, written: &WrittenSite) -> SiteError {
    let SiteError::NoStudy { .. } = error else { return error };
    let at = FieldLocation::Key { file: written.file.clone(), table: "[study]".into(), key: "date".into() };
    refuse(
        at,
        message!["it does not say the year whose days are judged"; "write date = 2026-03-21 under [study] in a site file"],
    )
}

/// A note that the glass of judged windows does not cast.
fn note_glass(mut names: Vec<String>) -> Option<Message> {
    let (components, they) = match names.len() {
        0 => return None,
        1 => ("1 component of glass whose windows are judged lets".to_owned(), "it casts"),
        more => (format!("{more} components of glass whose windows are judged let"), "they cast"),
    };
    // panes of one type are often all called the same
    names.sort();
    names.dedup();
    Some(Message::from(format!("{components} the sun through: {they} no shadow here ({})", few(names))))
}
