//! Dates, times of day and steps.

use super::TypedError;
use super::number::number;
use crate::sun::{Reading, SunError, parse_date, parse_duration_secs};
use chrono::{Month, NaiveDate, NaiveTime, Timelike};

/// A date as people write it: `2026-12-21`, `21.12.2026`, `21/12/2026`, `21 Dec 2026`.
///
/// With points the day comes first, as is usual. With slashes or dashes the order is accepted only if it is
/// unambiguous. The year has four digits.
///
/// # Errors
/// [`TypedError::Date`], [`TypedError::TwoDates`].
pub fn date(text: &str) -> Result<NaiveDate, TypedError> {
    let bad = || TypedError::Date(text.trim().to_owned());
    if let Ok(date) = parse_date(text) {
        return Ok(date);
    }
    let parts: Vec<&str> = text.split(|char: char| !char.is_alphanumeric()).filter(|part| !part.is_empty()).collect();
    let &[a, b, c] = &parts[..] else { return Err(bad()) };
    let of = |year: &str, month: u32, day: &str| {
        let is_year = year.len() == 4;
        NaiveDate::from_ymd_opt(year.parse().ok().filter(|_| is_year)?, month, day.parse().ok()?)
    };
    let named = |name: &str| name.parse().ok().map(|month: Month| month.number_from_month());
    let numbered = |month: &str| month.parse().unwrap_or(0);
    if let Some(month) = named(b) {
        return of(c, month, a).ok_or_else(bad);
    }
    if let Some(month) = named(a) {
        return of(c, month, b).ok_or_else(bad);
    }
    if a.len() == 4 {
        return of(a, numbered(b), c).ok_or_else(bad);
    }
    let day_first = of(c, numbered(b), a);
    let month_first = of(c, numbered(a), b).filter(|_| !text.contains('.'));
    match (day_first, month_first) {
        (Some(first), Some(second)) if first != second => {
            Err(TypedError::TwoDates { text: text.trim().to_owned(), dates: [first, second] })
        }
        (Some(date), _) | (None, Some(date)) => Ok(date),
        (None, None) => Err(bad()),
    }
}

/// A time as people write it, in the spelling of site files: `16`, `16.30`, `16:30`, `16h30`, `4 pm`, and everything
/// that [`Reading`] reads.
///
/// # Errors
/// [`TypedError::Clock`], [`TypedError::DayEnd`].
pub fn clock(text: &str) -> Result<String, TypedError> {
    let text = text.trim();
    for written in [text.to_owned(), text.to_lowercase()] {
        if written.parse::<Reading>().is_ok() {
            return Ok(written);
        }
    }
    let time = spoken(&text.to_lowercase()).ok_or_else(|| TypedError::Clock(text.to_owned()))?;
    let [hour, minute, second] = time;
    if time == [24, 0, 0] {
        return Err(TypedError::DayEnd);
    }
    let time = NaiveTime::from_hms_opt(hour, minute, second).ok_or_else(|| TypedError::Clock(text.to_owned()))?;
    Ok(time.format(if time.second() == 0 { "%-H:%M" } else { "%-H:%M:%S" }).to_string())
}

/// Hour, minute and second.
fn spoken(text: &str) -> Option<[u32; 3]> {
    let halves = [("a.m.", 0), ("am", 0), ("p.m.", 12), ("pm", 12)];
    let half = halves.iter().find_map(|(word, from)| Some((text.strip_suffix(word)?, *from)));
    let (rest, from) = half.map_or((text, None), |(rest, from)| (rest, Some(from)));
    let rest = rest.trim();
    // after "16h" only minutes may follow
    let rest = rest.strip_suffix('h').unwrap_or(rest).trim_end();
    let mut fields = rest.split([':', '.', 'h']);
    let mut time = [0; 3];
    let hour = fields.next()?.trim();
    let digits = |text: &str, least: usize| {
        let is_field = (least..=2).contains(&text.len()) && text.bytes().all(|byte| byte.is_ascii_digit());
        text.parse::<u32>().ok().filter(|_| is_field)
    };
    time[0] = digits(hour, 1)?;
    for slot in &mut time[1..] {
        let Some(field) = fields.next() else { break };
        *slot = digits(field.trim(), 2)?;
    }
    if fields.next().is_some() {
        return None;
    }
    if let Some(from) = from {
        time[0] = Some(time[0]).filter(|hour| (1..=12).contains(hour))? % 12 + from;
    }
    Some(time)
}

/// A step as people write it, in the spelling of site files: `30min`, `1 h`, `0,5 h`, `90s`.
///
/// # Errors
/// [`TypedError::Step`], and [`SunError::ZeroStep`].
pub fn step(text: &str) -> Result<String, TypedError> {
    let text = text.trim();
    let secs = parse_duration_secs(text).ok();
    let parts = || {
        let lower = text.to_lowercase();
        let units = [("min", 60.0), ("h", 3600.0), ("s", 1.0)];
        let (count, size) = units.iter().find_map(|(unit, size)| Some((lower.strip_suffix(unit)?.to_owned(), size)))?;
        let secs = number(&count).ok()? * size;
        let whole = secs.round();
        let written = if whole % 60.0 == 0.0 { format!("{}min", whole / 60.0) } else { format!("{whole}s") };
        Some(written).filter(|_| (secs - whole).abs() < 1e-6)
    };
    let written = if secs.is_some() { Some(text.to_owned()) } else { parts() };
    let written = written.filter(|written| parse_duration_secs(written).is_ok());
    let written = written.ok_or_else(|| TypedError::Step(text.to_owned()))?;
    match parse_duration_secs(&written) {
        Ok(0) => Err(SunError::ZeroStep.into()),
        _ => Ok(written),
    }
}

/// The word that asks for the instants alone, without times of change between them.
pub(super) const INSTANTS_ALONE: &str = "step";

/// The precision of times of change as people write it: a duration like a [`step`], or the word `step`.
///
/// # Errors
/// [`TypedError::Resolution`]
pub fn resolution(text: &str) -> Result<String, TypedError> {
    let text = text.trim();
    match text.eq_ignore_ascii_case(INSTANTS_ALONE) {
        true => Ok(INSTANTS_ALONE.to_owned()),
        false => step(text).map_err(|_| TypedError::Resolution(text.to_owned())),
    }
}
