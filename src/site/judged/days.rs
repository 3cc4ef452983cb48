//! The days of a site's study, for what is asked of judged windows and areas without a rule.

use crate::message::Field;
use crate::site::asked_value::AskedValue;
use crate::site::dates::of_each_day;
use crate::site::error::{FieldLocation, SiteError};
use crate::site::overrides::Overrides;
use crate::site::probe::dates;
use crate::site::written::WrittenSite;
use crate::sun::{DayWindow, Place, Reading};
use chrono::NaiveDate;
use rayon::prelude::*;
use std::path::Path;

/// The study's days, each with its window: `from` and `to` of the face, otherwise of the site file, otherwise the whole
/// day.
///
/// # Errors
/// A site file or a window that is wrong, each naming the key or option.
pub fn study_days(path: &Path, asked: &Overrides, place: &Place) -> Result<Vec<DayWindow>, SiteError> {
    let written = WrittenSite::read(path, asked)?;
    let (dates, dates_at) = dates(&written, asked)?;
    let in_file = [&written.site.study.from, &written.site.study.to].map(|text| text.as_ref().map(|it| it.0.as_str()));
    let from = AskedValue::of(&written, (Field::From, asked.from.clone()), ("from", in_file[0]));
    let to = AskedValue::of(&written, (Field::To, asked.to.clone()), ("to", in_file[1]));
    let [from_at, to_at] = [&from, &to].map(|asked| asked.as_ref().map_or(dates_at.clone(), AskedValue::at));
    let [from, to] = [from, to].map(|asked| asked.map(|asked| of_all(&asked, &dates)).transpose());
    let (from, to) = (from?, to?);
    let of = |date: NaiveDate| {
        DayWindow::on(place, date, from.as_ref(), to.as_ref()).map_err(|error| {
            let fails = |from| DayWindow::on(place, date, from, None).is_err();
            let at = match to {
                _ if fails(None) => &dates_at,
                Some(_) if !fails(from.as_ref()) => &to_at,
                _ => &from_at,
            };
            SiteError::sun(at.clone(), error)
        })
    };
    dates.par_iter().map(|date| of(*date)).collect()
}

/// A reading for all days; the date of the only one may stand in it.
fn of_all(asked: &AskedValue<'_, Reading>, dates: &[NaiveDate]) -> Result<Reading, SiteError> {
    let at = || -> FieldLocation { asked.at() };
    let mut reading = asked.read(str::parse::<Reading>)?;
    if dates.len() == 1 && reading.date == dates.first().copied() {
        reading.date = None;
    }
    of_each_day(reading, at)
}
