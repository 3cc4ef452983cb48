//! The days of a request that has several: set by a face, or in the study.

use super::error::{FieldLocation, SiteError};
use super::overrides::{Overrides, refuse};
use super::written::WrittenSite;
use crate::message::{Field, Message, message};
use crate::sun::{MOST_DAYS, Reading, SunError, parse_date};
use chrono::NaiveDate;

/// The first and the last day, and where they were given: by a face, otherwise by the study's `dates` if no face sets a
/// date. `None` for a single day.
pub(super) fn several(
    written: &WrittenSite,
    asked: &Overrides,
) -> Result<Option<(Vec<NaiveDate>, FieldLocation)>, SiteError> {
    match (asked.from_date, asked.to_date) {
        (Some(first), Some(last)) => {
            if asked.date.is_some() {
                let message =
                    message!["has no effect beside ", Field::FromDate, " and ", Field::ToDate; "leave one out"];
                return Err(refuse(FieldLocation::Field(Field::Date), message));
            }
            let before = message![format!("{last} is before "), (Field::FromDate, first.to_string()); "exchange them"];
            let dates = between(first, last, FieldLocation::Field(Field::ToDate), before)?;
            return Ok(Some((dates, FieldLocation::Field(Field::FromDate))));
        }
        (Some(_), None) => {
            let message = message!["needs ", Field::ToDate, ", the last of the days"];
            return Err(refuse(FieldLocation::Field(Field::FromDate), message));
        }
        (None, Some(_)) => {
            let message = message!["needs ", Field::FromDate, ", the first of the days"];
            return Err(refuse(FieldLocation::Field(Field::ToDate), message));
        }
        (None, None) => {}
    }
    let study = &written.site.study;
    let Some([first, last]) = &study.dates else { return Ok(None) };
    let at = || written.key("study", "dates");
    if study.date.is_some() {
        return Err(refuse(at(), message!["has no effect beside ", Field::Date; "leave one of the two out"]));
    }
    // a single date from a face has priority over the file's dates
    if asked.date.is_some() || asked.from.as_ref().is_some_and(|from| from.date.is_some()) {
        return Ok(None);
    }
    let (first, last) = (date_of(&first.0, at())?, date_of(&last.0, at())?);
    let dates = between(first, last, at(), message![format!("{last} is before {first}"); "exchange them"])?;
    Ok(Some((dates, at())))
}

fn between(first: NaiveDate, last: NaiveDate, at: FieldLocation, before: Message) -> Result<Vec<NaiveDate>, SiteError> {
    let days = (last - first).num_days() + 1;
    if days < 1 {
        return Err(refuse(at, before));
    }
    if days > MOST_DAYS {
        return Err(SiteError::sun(at, SunError::WindowTooLong { days, most: MOST_DAYS }));
    }
    Ok(first.iter_days().take_while(|date| *date <= last).collect())
}

/// A reading that applies to each day, and so may have no date.
pub(super) fn of_each_day(reading: Reading, at: impl Fn() -> FieldLocation) -> Result<Reading, SiteError> {
    if reading.date.is_some() {
        let what = format!("{reading} has a date, but applies to each day");
        return Err(refuse(at(), message![what; "leave the date out, and give days with ", Field::Date]));
    }
    Ok(reading)
}

/// Reads a date of the site file.
pub(super) fn date_of(text: &str, at: FieldLocation) -> Result<NaiveDate, SiteError> {
    parse_date(text).map_err(|error| SiteError::sun(at, error))
}
