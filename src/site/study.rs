//! The study of the request → its instants.

use super::dates::{date_of, of_each_day, own_date, several};
use super::error::{FieldLocation, SiteError};
use super::overrides::{Overrides, refuse};
use super::typed::INSTANTS_ALONE;
use super::written::WrittenSite;
use crate::message::{Field, message};
use crate::sun::{DayWindow, EachDay, Place, Reading, SunError, SunTrack, Window, parse_duration_secs};
use chrono::NaiveDate;

/// A text and where it was written.
struct LocatedText<'a> {
    text: &'a str,
    at: FieldLocation,
}

impl LocatedText<'_> {
    fn fault(&self, error: SunError) -> SiteError {
        SiteError::sun(self.at.clone(), error)
    }

    fn reading(&self) -> Result<Reading, SiteError> {
        self.text.parse().map_err(|error| self.fault(error))
    }
}

/// The instants asked: a single one alone, or the study's window with the command line before the file.
pub(super) fn track(place: &Place, written: &WrittenSite, asked: &Overrides) -> Result<SunTrack, SiteError> {
    let refraction = !asked.no_refraction;
    if let Some(time) = asked.instant {
        let time = time.with_timezone(&place.time_zone);
        let track = SunTrack::of_instant(place, time, refraction);
        return track.map_err(|error| SiteError::sun(written.key("study", ""), error));
    }
    match &asked.at {
        Some(text) => single(place, written, asked, text),
        None => {
            let track = window(place, written, asked)?;
            Ok(SunTrack { resolution_secs: resolution_secs(written, asked, &track)?, ..track })
        }
    }
}

/// How near together times of change are found: as asked, else as the track has it.
fn resolution_secs(written: &WrittenSite, asked: &Overrides, track: &SunTrack) -> Result<u32, SiteError> {
    let step_secs = track.step_secs;
    let in_file = in_file(written, "resolution", written.site.study.resolution.as_deref());
    let Some((text, at)) = said(Field::Resolution, &asked.resolution).or(in_file) else {
        return Ok(track.resolution_secs);
    };
    if text.trim() == INSTANTS_ALONE {
        return Ok(0);
    }
    let example = "write for example 1min, or step for the instants alone";
    match parse_duration_secs(&text) {
        Err(_) | Ok(0) => Err(refuse(at, message![format!("\"{text}\" is no resolution"); example])),
        Ok(secs) if secs > step_secs => {
            let what = format!("a resolution of {secs} s is longer than the step, {step_secs} s");
            Err(refuse(at, message![what; example]))
        }
        Ok(secs) => Ok(secs),
    }
}

/// A text of the command line and its field.
fn said(field: Field, text: &Option<String>) -> Option<(String, FieldLocation)> {
    text.clone().map(|text| (text, FieldLocation::Field(field)))
}

/// A text of the file's study and its key.
fn in_file(written: &WrittenSite, key: &str, text: Option<&str>) -> Option<(String, FieldLocation)> {
    text.map(|text| (text.to_owned(), written.key("study", key)))
}

/// The date that the file's study has.
fn date_in_file(written: &WrittenSite) -> Option<(String, FieldLocation)> {
    in_file(written, "date", written.site.study.date.as_ref().map(|date| date.0.as_str()))
}

/// The single instant that is asked instead of the study.
fn single(place: &Place, written: &WrittenSite, asked: &Overrides, text: &str) -> Result<SunTrack, SiteError> {
    let given = [
        (Field::From, &asked.from),
        (Field::To, &asked.to),
        (Field::Step, &asked.step),
        (Field::Resolution, &asked.resolution),
        (Field::FromDate, &asked.from_date),
        (Field::ToDate, &asked.to_date),
    ];
    if let Some((field, _)) = given.into_iter().find(|(_, given)| given.is_some()) {
        let message = message!["says nothing beside ", Field::At; "leave one of the two out"];
        return Err(refuse(FieldLocation::Field(field), message));
    }
    let at = LocatedText { text, at: FieldLocation::Field(Field::At) };
    let reading = at.reading()?;
    // A reading with its own date does not ask the site file for one.
    let date = said(Field::Date, &asked.date).or(date_in_file(written).filter(|_| reading.date.is_none()));
    SunTrack::at(place, &reading, date_of(date)?, !asked.no_refraction).map_err(|error| at.fault(error))
}

/// The study's window, or that on each of several days.
fn window(place: &Place, written: &WrittenSite, asked: &Overrides) -> Result<SunTrack, SiteError> {
    let refraction = !asked.no_refraction;
    let study = &written.site.study;
    let file = |key: &str, text: Option<&str>| in_file(written, key, text);
    let date_asked = said(Field::Date, &asked.date);
    let date_written = date_in_file(written);
    let from = said(Field::From, &asked.from).or(file("from", study.from.as_ref().map(|text| text.0.as_str())));
    let to = said(Field::To, &asked.to).or(file("to", study.to.as_ref().map(|text| text.0.as_str())));
    let step = said(Field::Step, &asked.step).or(file("step", study.step.as_deref()));
    if let Some((dates, dates_at)) = several(written, asked)? {
        return each_day(place, written, (&dates, dates_at), [from, to, step], refraction);
    }
    let own_date = from.as_ref().and_then(|(text, _)| own_date(text));
    let dated = own_date.is_some() || date_asked.is_some() || date_written.is_some();
    let (Some(from), Some(to), Some(step), true) = (&from, &to, &step, dated) else {
        return Err(no_study(written, [dated, from.is_some(), to.is_some(), step.is_some()]));
    };
    let [from, to, step] = [from, to, step].map(|(text, at)| LocatedText { text, at: at.clone() });

    let reading = from.reading()?;
    // a beginning with its own date is asked later than the date in the file, and goes before it.
    let overrides = reading.date.is_some() && asked.from.is_some();
    let date = date_of(date_asked.or(date_written.filter(|_| !overrides)))?;
    let window = Window {
        date,
        to: to.reading()?,
        step_secs: parse_duration_secs(step.text).map_err(|error| step.fault(error))?,
        from: reading,
    };
    SunTrack::window(place, &window, refraction).map_err(|error| match error {
        SunError::ZeroStep | SunError::TooManyInstants { .. } => step.fault(error),
        SunError::EmptyWindow { .. } | SunError::Backwards { .. } | SunError::WindowTooLong { .. } => to.fault(error),
        // where its beginning is sound the fault lies in its end
        _ if window.begin(place).is_ok() => to.fault(error),
        _ => from.fault(error),
    })
}

/// A window on each of several days; without `from` and `to` the whole of them.
fn each_day(
    place: &Place,
    written: &WrittenSite,
    (dates, dates_at): (&[NaiveDate], FieldLocation),
    [from, to, step]: [Option<(String, FieldLocation)>; 3],
    refraction: bool,
) -> Result<SunTrack, SiteError> {
    let Some((step, step_at)) = step else {
        return Err(no_study(written, [true, true, true, false]));
    };
    let step_secs = parse_duration_secs(&step).map_err(|error| SiteError::sun(step_at.clone(), error))?;
    let reading = |said: &Option<(String, FieldLocation)>| {
        said.as_ref().map(|(text, at)| of_each_day(text, at.clone())).transpose()
    };
    let each = EachDay { from: reading(&from)?, to: reading(&to)? };
    SunTrack::days(place, dates, each.clone(), step_secs, refraction).map_err(|error| {
        let fails = |from: Option<&Reading>| dates.iter().any(|date| DayWindow::on(place, *date, from, None).is_err());
        let at = match (&error, from, to) {
            (SunError::ZeroStep | SunError::TooManyInstants { .. }, ..) => step_at,
            (_, Some((_, at)), _) if !fails(None) && fails(each.from.as_ref()) => at,
            (_, _, Some((_, at))) | (_, Some((_, at)), None) if !fails(None) => at,
            _ => dates_at,
        };
        SiteError::sun(at, error)
    })
}

/// Which of date, from, to and step nobody said.
pub(super) fn no_study(written: &WrittenSite, said: [bool; 4]) -> SiteError {
    const EXAMPLES: [(Field, &str); 4] =
        [(Field::Date, "2026-03-21"), (Field::From, "9:00"), (Field::To, "17:00"), (Field::Step, "1h")];
    let unsaid = EXAMPLES.into_iter().zip(said).filter(|(_, said)| !said);
    SiteError::NoStudy { file: written.file.clone(), missing: unsaid.map(|(missing, _)| missing).collect() }
}
