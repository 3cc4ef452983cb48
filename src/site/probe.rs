//! The request for probes: which points, on which days.

use super::dates::{date_of, of_each_day, own_date, several};
use super::error::{FieldLocation, SiteError};
use super::ground::{self, Ground};
use super::models::Models;
use super::notes::on_probes;
use super::overrides::{Overrides, numbers, refuse};
use super::study::no_study;
use super::written::WrittenSite;
use crate::choice::Receivers;
use crate::formats::composed;
use crate::mesh::Mesh;
use crate::message::{Field, Message, Words, message};
use crate::sun::{DayWindow, Place, Zone};
use crate::view::Probe;
use chrono::NaiveDate;
use glam::DVec3;
use rayon::prelude::*;
use std::path::Path;

/// The checked request of `gnomon probe`: place, models, points, days.
#[derive(Clone, Debug)]
pub struct ProbeSite {
    /// Where on earth.
    pub place: Place,
    /// All models, welded, in the world frame.
    pub mesh: Mesh,
    /// What the user should know of how the models were read, as [`super::Site::notes`].
    pub notes: Vec<Message>,
    /// As [`super::Site::words`].
    pub words: &'static dyn Words,
    /// Per component: whether it casts.
    pub casts: Vec<bool>,
    /// The ground.
    pub ground: Ground,
    /// The points, at least one, each with its own name.
    pub probes: Vec<Probe>,
    /// The days in their order, at least one, and what is asked of each.
    pub days: Vec<DayWindow>,
    /// Whether directions include atmospheric refraction.
    pub refraction: bool,
}

/// Reads and checks a request for probes; of the study only the date is asked, and only where the command line names
/// none.
///
/// # Errors
/// Everything that can be wrong with it, each naming the file, the key or option, and the way out.
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
    // a probe below it says so itself
    notes.extend(ground.notes(&mesh, &receives, Receivers::Ground));
    notes.extend(days.last().and_then(|day| Zone::doubt(&day.to)).map(Message::from));
    notes.extend(on_probes(&probes));
    let refraction = !asked.no_refraction;
    let words = asked.words;
    Ok(ProbeSite { place, mesh, notes, words, casts, ground, probes, days, refraction })
}

/// The point of the command line, or else those of the file.
fn probes(written: &WrittenSite, asked: &Overrides) -> Result<Vec<Probe>, SiteError> {
    if let Some(point) = &asked.point {
        let point = DVec3::from_array(numbers(Field::Point, point, "12,-3,4.5")?);
        let normal = match &asked.normal {
            Some(text) => Some(unit(numbers(Field::Normal, text, "0,-1,0")?, || FieldLocation::Field(Field::Normal))?),
            None => None,
        };
        return Ok(vec![Probe { name: "point".to_owned(), point, normal }]);
    }
    if asked.normal.is_some() {
        let message = message!["belongs to ", Field::Point; "add that, or leave it out"];
        return Err(refuse(FieldLocation::Field(Field::Normal), message));
    }
    if written.site.probe.is_empty() {
        return Err(SiteError::NoProbe { file: written.file.clone() });
    }
    let mut probes: Vec<Probe> = Vec::new();
    for (index, table) in written.site.probe.iter().enumerate() {
        let at = |key: &str| written.probe_key(index, key);
        let name = table.name.clone().filter(|name| !name.trim().is_empty());
        let name = name.unwrap_or_else(|| format!("probe {}", index + 1));
        if probes.iter().any(|other| composed(&other.name) == composed(&name)) {
            return Err(refuse(
                at("name"),
                message![format!("\"{name}\" is the name of another probe, too"); "name each otherwise"],
            ));
        }
        let Some(point) = table.point.map(DVec3::from_array) else {
            let probe = super::keys::numbered("probe", index, written.site.probe.len());
            return Err(written.missing(format!("point in {probe}"), super::keys::example("probe", "point")));
        };
        if !point.is_finite() {
            let what = format!("{point} is no point");
            return Err(refuse(at("point"), message![what; "write metres, for example [12.0, -3.0, 4.5]"]));
        }
        let normal = table.normal.map(|normal| unit(normal, || at("normal"))).transpose()?;
        probes.push(Probe { name, point, normal });
    }
    Ok(probes)
}

/// A normal's direction, whatever its length.
fn unit(normal: [f64; 3], at: impl Fn() -> FieldLocation) -> Result<DVec3, SiteError> {
    let normal = DVec3::from_array(normal);
    // Brought near 1 first, so that no square overflows.
    let unit = (normal / normal.abs().max_element()).normalize();
    if unit.is_finite() {
        return Ok(unit);
    }
    let what = format!("{normal} is no direction");
    Err(refuse(at(), message![what; "write one of any length but 0, for example [0, -1, 0]"]))
}

/// The days asked, each with the part of it that is.
fn days(place: &Place, written: &WrittenSite, asked: &Overrides) -> Result<Vec<DayWindow>, SiteError> {
    let reading = |field, text: &Option<String>| {
        text.as_ref().map(|text| of_each_day(text, FieldLocation::Field(field))).transpose()
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

/// One date, of the command line or of the study, or a range of them, and where they are asked.
fn dates(written: &WrittenSite, asked: &Overrides) -> Result<(Vec<NaiveDate>, FieldLocation), SiteError> {
    if let Some(dates) = several(written, asked)? {
        return Ok(dates);
    }
    let study = &written.site.study;
    let at = || FieldLocation::Field(Field::Date);
    if let Some(date) = date_of(asked.date.clone().map(|text| (text, at())))? {
        return Ok((vec![date], at()));
    }
    let at = |key: &str| written.key("study", key);
    if let Some(date) = date_of(study.date.as_ref().map(|text| (text.0.clone(), at("date"))))? {
        return Ok((vec![date], at("date")));
    }
    // A study without a date has one in its beginning.
    let own = study.from.as_ref().and_then(|from| own_date(&from.0));
    Ok((vec![own.ok_or_else(|| no_study(written, [false, true, true, true]))?], at("from")))
}
