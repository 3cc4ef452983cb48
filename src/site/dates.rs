//! Several days, as asked: of the command line, or of the study.

use super::asked::{Overrides, refuse};
use super::error::{At, SiteError};
use super::study::date_of;
use super::written::Written;
use crate::sun::{MOST_DAYS, Reading, SunError};
use chrono::NaiveDate;

/// The days of `--from-date` and `--to-date`, or else of the study's `dates` where the command line names no date of its
/// own, and where they are asked; none where a single day is.
pub(super) fn several(written: &Written, asked: &Overrides) -> Result<Option<(Vec<NaiveDate>, At)>, SiteError> {
    let option = |name: &'static str, text: &Option<String>| date_of(text.clone().map(|text| (text, At::Option(name))));
    match (option("--from-date", &asked.from_date)?, option("--to-date", &asked.to_date)?) {
        (Some(first), Some(last)) => {
            if asked.date.is_some() {
                let what = "says nothing beside --from-date and --to-date; leave one out";
                return Err(refuse(At::Option("--date"), what));
            }
            let before = format!("{last} is before --from-date {first}; exchange them");
            let dates = between(first, last, At::Option("--to-date"), before)?;
            return Ok(Some((dates, At::Option("--from-date"))));
        }
        (Some(_), None) => return Err(refuse(At::Option("--from-date"), "needs --to-date, the last of the days")),
        (None, Some(_)) => return Err(refuse(At::Option("--to-date"), "needs --from-date, the first of the days")),
        (None, None) => {}
    }
    let study = &written.site.study;
    let Some([first, last]) = &study.dates else { return Ok(None) };
    let at = || written.key("study", "dates");
    if study.date.is_some() {
        return Err(refuse(at(), "says nothing beside date; leave one of the two out"));
    }
    // a single date of the command line goes before the file's
    let in_option = |text: &Option<String>| text.as_ref().is_some_and(|text| own_date(text).is_some());
    if asked.date.is_some() || in_option(&asked.from) {
        return Ok(None);
    }
    let date = |text: &str| date_of(Some((text.to_owned(), at())));
    let (Some(first), Some(last)) = (date(&first.0)?, date(&last.0)?) else { return Ok(None) };
    let dates = between(first, last, at(), format!("{last} is before {first}; exchange them"))?;
    Ok(Some((dates, at())))
}

fn between(first: NaiveDate, last: NaiveDate, at: At, before: String) -> Result<Vec<NaiveDate>, SiteError> {
    let days = (last - first).num_days() + 1;
    if days < 1 {
        return Err(refuse(at, before));
    }
    if days > MOST_DAYS {
        return Err(SiteError::sun(at, SunError::WindowTooLong { days, most: MOST_DAYS }));
    }
    Ok(first.iter_days().take_while(|date| *date <= last).collect())
}

/// A reading that is meant for each day.
pub(super) fn of_each_day(text: &str, at: At) -> Result<Reading, SiteError> {
    let reading: Reading = text.parse().map_err(|error| SiteError::sun(at.clone(), error))?;
    if reading.date.is_some() {
        let what = format!("{text} has a date, but is meant for each day; leave it out, and name days with --date");
        return Err(refuse(at, what));
    }
    Ok(reading)
}

/// The date that a reading names.
pub(super) fn own_date(text: &str) -> Option<NaiveDate> {
    text.parse::<Reading>().ok()?.date
}
