//! Makes the study's instants from the request.

use super::asked_value::AskedValue;
use super::dates::{date_of, of_each_day, several};
use super::error::{FieldLocation, SiteError};
use super::overrides::{Overrides, refuse};
use super::typed;
use super::written::WrittenSite;
use crate::message::{Field, message};
use crate::sun::{DayWindow, EachDay, Place, Reading, SunError, SunTrack, Window, parse_duration_secs};
use chrono::NaiveDate;

/// The requested instants: a single one, or the study's window, in which the face's fields have priority over the
/// file's.
pub(super) fn track(place: &Place, written: &WrittenSite, asked: &Overrides) -> Result<SunTrack, SiteError> {
    let refraction = !asked.no_refraction;
    if let Some(time) = asked.instant {
        let time = time.with_timezone(&place.time_zone);
        let track = SunTrack::of_instant(place, time, refraction);
        return track.map_err(|error| SiteError::sun(written.key("study", ""), error));
    }
    match &asked.at {
        Some(reading) => single(place, written, asked, reading),
        None => {
            let track = window(place, written, asked)?;
            Ok(SunTrack { resolution_secs: resolution_secs(written, asked, &track)?, ..track })
        }
    }
}

/// The requested precision of times of change, otherwise the track's.
fn resolution_secs(written: &WrittenSite, asked: &Overrides, track: &SunTrack) -> Result<u32, SiteError> {
    let step_secs = track.step_secs;
    let in_file = written.site.study.resolution.as_deref();
    let resolution = AskedValue::of(written, (Field::Resolution, asked.resolution_secs), ("resolution", in_file));
    let Some(resolution) = resolution else { return Ok(track.resolution_secs) };
    let secs = resolution.read(typed::resolution_secs)?;
    if secs > step_secs {
        let what = format!("a resolution of {secs} s is longer than the step, {step_secs} s");
        let hint = "write for example 1min, or step for the instants alone";
        return Err(refuse(resolution.at(), message![what; hint]));
    }
    Ok(secs)
}

/// The date of the file's study.
fn date_in_file(written: &WrittenSite) -> Result<Option<NaiveDate>, SiteError> {
    let date = written.site.study.date.as_ref();
    date.map(|date| date_of(&date.0, written.key("study", "date"))).transpose()
}

/// The single instant that is requested instead of the study.
fn single(place: &Place, written: &WrittenSite, asked: &Overrides, reading: &Reading) -> Result<SunTrack, SiteError> {
    let given = [
        (Field::From, asked.from.is_some()),
        (Field::To, asked.to.is_some()),
        (Field::Step, asked.step_secs.is_some()),
        (Field::Resolution, asked.resolution_secs.is_some()),
        (Field::FromDate, asked.from_date.is_some()),
        (Field::ToDate, asked.to_date.is_some()),
    ];
    if let Some((field, _)) = given.into_iter().find(|(_, given)| *given) {
        let message = message!["has no effect beside ", Field::At; "leave one of the two out"];
        return Err(refuse(FieldLocation::Field(field), message));
    }
    let date = match asked.date {
        // a reading with its own date does not need the file's
        None if reading.date.is_none() => date_in_file(written)?,
        date => date,
    };
    SunTrack::at(place, reading, date, !asked.no_refraction)
        .map_err(|error| SiteError::sun(FieldLocation::Field(Field::At), error))
}

/// The study's beginning, end and step, from the face, otherwise from the file.
#[derive(Clone, Debug)]
struct AskedWindow<'a> {
    from: Option<AskedValue<'a, Reading>>,
    to: Option<AskedValue<'a, Reading>>,
    step: Option<AskedValue<'a, u32>>,
}

impl<'a> AskedWindow<'a> {
    fn of(written: &'a WrittenSite, asked: &Overrides) -> AskedWindow<'a> {
        let study = &written.site.study;
        let [from, to] = [&study.from, &study.to].map(|text| text.as_ref().map(|text| text.0.as_str()));
        AskedWindow {
            from: AskedValue::of(written, (Field::From, asked.from.clone()), ("from", from)),
            to: AskedValue::of(written, (Field::To, asked.to.clone()), ("to", to)),
            step: AskedValue::of(written, (Field::Step, asked.step_secs), ("step", study.step.as_deref())),
        }
    }
}

/// The study's window, or the same window on each of several days.
fn window(place: &Place, written: &WrittenSite, asked: &Overrides) -> Result<SunTrack, SiteError> {
    let refraction = !asked.no_refraction;
    let said = AskedWindow::of(written, asked);
    if let Some((dates, dates_at)) = several(written, asked)? {
        return each_day(place, written, (&dates, dates_at), said, refraction);
    }
    let own_date = said.from.as_ref().and_then(|from| from.read(str::parse::<Reading>).ok()?.date);
    let dated = own_date.is_some() || asked.date.is_some() || written.site.study.date.is_some();
    let (Some(from), Some(to), Some(step), true) = (&said.from, &said.to, &said.step, dated) else {
        return Err(no_study(written, [dated, said.from.is_some(), said.to.is_some(), said.step.is_some()]));
    };

    let reading = from.read(str::parse::<Reading>)?;
    // a beginning with its own date, set by a face, has priority over the file's date
    let overrides = reading.date.is_some() && asked.from.is_some();
    let date = match asked.date {
        None if !overrides => date_in_file(written)?,
        date => date,
    };
    let window =
        Window { date, to: to.read(str::parse::<Reading>)?, step_secs: step.read(parse_duration_secs)?, from: reading };
    SunTrack::window(place, &window, refraction).map_err(|error| {
        let at = match error {
            SunError::ZeroStep | SunError::TooManyInstants { .. } => step.at(),
            SunError::EmptyWindow { .. } | SunError::Backwards { .. } | SunError::WindowTooLong { .. } => to.at(),
            // if the beginning is valid, the end is at fault
            _ if window.begin(place).is_ok() => to.at(),
            _ => from.at(),
        };
        SiteError::sun(at, error)
    })
}

/// A window on each of several days; the whole days without `from` and `to`.
fn each_day(
    place: &Place,
    written: &WrittenSite,
    (dates, dates_at): (&[NaiveDate], FieldLocation),
    AskedWindow { from, to, step }: AskedWindow<'_>,
    refraction: bool,
) -> Result<SunTrack, SiteError> {
    let Some(step) = step else {
        return Err(no_study(written, [true, true, true, false]));
    };
    let step_secs = step.read(parse_duration_secs)?;
    let reading = |said: &Option<AskedValue<'_, Reading>>| {
        said.as_ref().map(|said| of_each_day(said.read(str::parse::<Reading>)?, || said.at())).transpose()
    };
    let each = EachDay { from: reading(&from)?, to: reading(&to)? };
    SunTrack::days(place, dates, each.clone(), step_secs, refraction).map_err(|error| {
        let fails = |from: Option<&Reading>| dates.iter().any(|date| DayWindow::on(place, *date, from, None).is_err());
        let at = match (&error, from, to) {
            (SunError::ZeroStep | SunError::TooManyInstants { .. }, ..) => step.at(),
            (_, Some(from), _) if !fails(None) && fails(each.from.as_ref()) => from.at(),
            (_, _, Some(last)) | (_, Some(last), None) if !fails(None) => last.at(),
            _ => dates_at,
        };
        SiteError::sun(at, error)
    })
}

/// The error that names those of date, from, to and step that nothing gives.
pub(super) fn no_study(written: &WrittenSite, said: [bool; 4]) -> SiteError {
    const EXAMPLES: [(Field, &str); 4] =
        [(Field::Date, "2026-03-21"), (Field::From, "9:00"), (Field::To, "17:00"), (Field::Step, "1h")];
    let unsaid = EXAMPLES.into_iter().zip(said).filter(|(_, said)| !said);
    SiteError::NoStudy { file: written.file.clone(), missing: unsaid.map(|(missing, _)| missing).collect() }
}
