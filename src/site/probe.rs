//! The request for probes: the points and the days.

use super::dates::{date_of, of_each_day, several};
use super::error::{FieldLocation, SiteError};
use super::file::Names;
use super::ground::{self, Ground};
use super::laid::{PointLayout, lay};
use super::models::Models;
use super::names::names_of;
use super::notes::on_probes;
use super::overrides::{Overrides, refuse};
use super::points_file::{self, MOST_PROBES, unit};
use super::study::no_study;
use super::written::WrittenSite;
use crate::choice::Receivers;
use crate::formats::composed;
use crate::mesh::Mesh;
use crate::message::{Field, Message, Words, message};
use crate::sun::{DayWindow, Place, Reading, Zone};
use crate::view::Probe;
use chrono::NaiveDate;
use glam::DVec3;
use rayon::prelude::*;
use std::path::Path;

/// The checked request of `gnomon probe`: place, models, points, days.
#[derive(Clone, Debug)]
pub struct ProbeSite {
    /// The place on Earth.
    pub place: Place,
    /// All models, welded, in the world frame.
    pub mesh: Mesh,
    /// Notes on how the models were read, as in [`super::Site::notes`].
    pub notes: Vec<Message>,
    /// As in [`super::Site::words`].
    pub words: &'static dyn Words,
    /// For each component, whether it casts.
    pub casts: Vec<bool>,
    /// The ground.
    pub ground: Ground,
    /// The points; no two have the same name. There is at least one here or in `laid`.
    pub probes: Vec<Probe>,
    /// Points that the program lays. Each has up to two candidates for its outer side, of which the study takes the one
    /// that is more open to the sky.
    pub laid: Vec<Vec<Probe>>,
    /// The days in order, at least one, each with the requested part of it.
    pub days: Vec<DayWindow>,
    /// Whether directions include atmospheric refraction.
    pub refraction: bool,
}

/// Reads and checks a request for probes. The study's date is used if the face sets none; nothing else of the study is.
///
/// # Errors
/// Anything wrong with it. Each error names the file and the key or option, and has a hint.
pub fn load_probes(path: &Path, asked: &Overrides) -> Result<ProbeSite, SiteError> {
    let as_written = WrittenSite::read(path, asked)?;
    let (written, models) =
        as_written.located(|| Models::read(&as_written, |path, options| asked.reading.read(path, options)))?;
    let place = written.place(asked)?;
    let probes = probes(&written, asked)?;
    let days = days(&place, &written, asked)?;
    let level = ground::level(&written, asked)?;
    let models = models()?.with_terrain(&written)?;
    let [casts, receives] = models.roles(&written)?;
    let mut notes: Vec<Message> = written.place_note().into_iter().collect();
    notes.extend(models.notes(&written, &casts));
    let Models { mesh, bounds, .. } = models;
    let ground = Ground::of(&mesh, bounds, &receives, level);
    let laid = laid(&mesh, asked, ground.level, &probes)?;
    check_count(asked, probes.len() + laid.len(), days.len())?;
    notes.extend((!laid.is_empty()).then(|| Message::from(format!("{} points are laid on components", laid.len()))));
    // a probe below the ground has its own note
    notes.extend(ground.notes(&mesh, &receives, Receivers::Ground));
    notes.extend(days.last().and_then(|day| Zone::doubt(&day.to)).map(Message::from));
    notes.extend(on_probes(&probes));
    let refraction = !asked.no_refraction;
    let words = asked.words;
    Ok(ProbeSite { place, mesh, notes, words, casts, ground, probes, laid, days, refraction })
}

/// The most points times days: a point's day takes some 300 bytes.
const MOST_POINT_DAYS: usize = 4_000_000;

/// Refuses requests whose answer would be too large.
fn check_count(asked: &Overrides, points: usize, days: usize) -> Result<(), SiteError> {
    let at = FieldLocation::Field(if asked.on.is_empty() { Field::Points } else { Field::On });
    if points > MOST_PROBES {
        let what = format!("there are more than {MOST_PROBES} points");
        return Err(refuse(at, message![what; "name fewer components"]));
    }
    if points.saturating_mul(days) <= MOST_POINT_DAYS {
        return Ok(());
    }
    let what = format!("{points} points on {days} days are more than {MOST_POINT_DAYS} together");
    Err(refuse(at, message![what; "ask for fewer points or days at once"]))
}

/// The points laid on the requested components.
fn laid(mesh: &Mesh, asked: &Overrides, ground: f64, beside: &[Probe]) -> Result<Vec<Vec<Probe>>, SiteError> {
    let at = |field| FieldLocation::Field(field);
    for (field, value) in [(Field::Spacing, asked.spacing), (Field::Height, asked.height)] {
        if asked.on.is_empty() && value.is_some() {
            return Err(refuse(at(field), message!["belongs to ", Field::On; "add that, or leave it out"]));
        }
    }
    if asked.on.is_empty() {
        return Ok(Vec::new());
    }
    let laying = match (asked.spacing, asked.height) {
        (None, None) => PointLayout::Pieces,
        (Some(spacing), Some(height)) if spacing.is_finite() && spacing >= 0.01 && height.is_finite() => {
            PointLayout::Row { spacing, height: ground + height }
        }
        (Some(_), Some(_)) => {
            let message = message!["is not a distance between points"; "write at least 0.01 metres"];
            return Err(refuse(at(Field::Spacing), message));
        }
        (Some(_), None) => {
            return Err(refuse(at(Field::Spacing), message!["needs ", Field::Height, ", metres above the ground"]));
        }
        (None, Some(_)) => {
            return Err(refuse(at(Field::Height), message!["needs ", Field::Spacing, ", metres between two points"]));
        }
    };
    let names = Names::Some(asked.on.clone());
    if let Some((name, nearest)) = names.unknown(&names_of(&mesh.components)) {
        return Err(SiteError::UnknownName { at: at(Field::On), name, nearest });
    }
    let laid = lay(mesh, &names.chosen(&mesh.components), laying, (MOST_PROBES, beside));
    if laid.is_empty() {
        return Err(refuse(
            at(Field::On),
            message!["there is no face to lay a point on"; "ask for another height, or other components"],
        ));
    }
    Ok(laid)
}

/// The points that the face sets, otherwise those of the file.
fn probes(written: &WrittenSite, asked: &Overrides) -> Result<Vec<Probe>, SiteError> {
    let is_laid = !asked.on.is_empty();
    for (field, is_asked) in [(Field::Points, asked.points.is_some()), (Field::On, is_laid)] {
        if asked.point.is_some() && is_asked {
            let message = message!["has no effect beside ", Field::Point; "leave one of the two out"];
            return Err(refuse(FieldLocation::Field(field), message));
        }
    }
    if let Some(point) = asked.point {
        if !point.is_finite() {
            let message =
                message![format!("{point} is not a point"); "write metres, for example ", (Field::Point, "12,-3,4.5")];
            return Err(refuse(FieldLocation::Field(Field::Point), message));
        }
        let normal = asked.normal.map(|normal| unit(normal.to_array(), || FieldLocation::Field(Field::Normal)));
        let normal = normal.transpose()?;
        return Ok(vec![Probe { name: "point".to_owned(), point, normal }]);
    }
    if asked.normal.is_some() {
        let message = message!["belongs to ", Field::Point; "add that, or leave it out"];
        return Err(refuse(FieldLocation::Field(Field::Normal), message));
    }
    if let Some(file) = &asked.points {
        return points_file::read(file);
    }
    if is_laid {
        return Ok(Vec::new());
    }
    if written.site.probe.is_empty() {
        return Err(SiteError::NoProbe { file: written.file.clone() });
    }
    of_tables(written)
}

/// The points of the site file.
fn of_tables(written: &WrittenSite) -> Result<Vec<Probe>, SiteError> {
    let mut probes: Vec<Probe> = Vec::new();
    for (index, table) in written.site.probe.iter().enumerate() {
        let at = |key: &str| written.probe_key(index, key);
        let name = table.name.clone().filter(|name| !name.trim().is_empty());
        let name = name.unwrap_or_else(|| format!("probe {}", index + 1));
        if probes.iter().any(|other| composed(&other.name) == composed(&name)) {
            return Err(refuse(
                at("name"),
                message![format!("\"{name}\" is the name of another probe, too"); "give each its own name"],
            ));
        }
        let Some(point) = table.point.map(DVec3::from_array) else {
            let probe = super::keys::numbered("probe", index, written.site.probe.len());
            return Err(written.missing(format!("point in {probe}"), super::keys::example("probe", "point")));
        };
        if !point.is_finite() {
            let what = format!("{point} is not a point");
            return Err(refuse(at("point"), message![what; "write metres, for example [12.0, -3.0, 4.5]"]));
        }
        let normal = table.normal.map(|normal| unit(normal, || at("normal"))).transpose()?;
        probes.push(Probe { name, point, normal });
    }
    Ok(probes)
}

/// The requested days, each with its part.
fn days(place: &Place, written: &WrittenSite, asked: &Overrides) -> Result<Vec<DayWindow>, SiteError> {
    let reading = |field, set: &Option<Reading>| {
        set.clone().map(|reading| of_each_day(reading, || FieldLocation::Field(field))).transpose()
    };
    let (from, to) = (reading(Field::From, &asked.from)?, reading(Field::To, &asked.to)?);
    let (dates, dates_at) = dates(written, asked)?;
    dates
        .into_par_iter()
        .map(|date| {
            DayWindow::on(place, date, from.as_ref(), to.as_ref()).map_err(|error| {
                let fails = |from| DayWindow::on(place, date, from, None).is_err();
                let at = match to {
                    _ if fails(None) => dates_at.clone(),
                    Some(_) if !fails(from.as_ref()) => FieldLocation::Field(Field::To),
                    _ => FieldLocation::Field(Field::From),
                };
                SiteError::sun(at, error)
            })
        })
        .collect()
}

/// The requested dates: one date or a range, of the face or of the study; and where they were given.
pub(super) fn dates(written: &WrittenSite, asked: &Overrides) -> Result<(Vec<NaiveDate>, FieldLocation), SiteError> {
    if let Some(dates) = several(written, asked)? {
        return Ok(dates);
    }
    let study = &written.site.study;
    if let Some(date) = asked.date {
        return Ok((vec![date], FieldLocation::Field(Field::Date)));
    }
    let at = |key: &str| written.key("study", key);
    if let Some(date) = &study.date {
        return Ok((vec![date_of(&date.0, at("date"))?], at("date")));
    }
    // a study without `date` may have the date in `from`
    let own = study.from.as_ref().and_then(|from| from.0.parse::<Reading>().ok()?.date);
    Ok((vec![own.ok_or_else(|| no_study(written, [false, true, true, true]))?], at("from")))
}
