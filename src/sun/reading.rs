//! Reads times, dates and durations as people write them.

use super::SunError;
use chrono::{FixedOffset, NaiveDate, NaiveTime};
use std::fmt;
use std::str::FromStr;

/// A time as written: a clock time, or one relative to sunrise or sunset.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reading {
    /// Its own date, if it has one.
    pub date: Option<NaiveDate>,
    /// Its time of day.
    pub time: TimeOfDay,
    pub(super) text: String,
}

/// A time of day as written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TimeOfDay {
    /// Local clock time in whole seconds. The offset distinguishes two instants with the same clock time.
    Clock(NaiveTime, Option<FixedOffset>),
    /// Seconds after sunrise; negative before.
    Sunrise(i64),
    /// Seconds after sunset; negative before.
    Sunset(i64),
}

impl fmt::Display for Reading {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl FromStr for Reading {
    type Err = SunError;

    fn from_str(text: &str) -> Result<Self, SunError> {
        let bad = || SunError::BadReading { text: text.into() };
        let compact: String = text.split_whitespace().collect::<Vec<_>>().join(" ");
        // A date ends at a T or at a space, as in TOML.
        let (date, rest) = match compact.as_bytes().get(4) {
            Some(b'-') => {
                let (date, rest) = compact.split_once(['T', 't', ' ']).ok_or_else(bad)?;
                (Some(parse_date(date)?), rest)
            }
            _ => (None, compact.as_str()),
        };
        let rest = rest.replace(' ', "");
        let time = if let Some(shift) = rest.strip_prefix("sunrise") {
            TimeOfDay::Sunrise(parse_shift(shift).ok_or_else(bad)?)
        } else if let Some(shift) = rest.strip_prefix("sunset") {
            TimeOfDay::Sunset(parse_shift(shift).ok_or_else(bad)?)
        } else {
            let (clock, offset) = parse_clock(&rest).ok_or_else(bad)?;
            TimeOfDay::Clock(clock, offset)
        };
        Ok(Reading { date, time, text: text.trim().to_owned() })
    }
}

/// A calendar date, year-month-day.
///
/// # Errors
/// [`SunError::BadDate`].
pub fn parse_date(text: &str) -> Result<NaiveDate, SunError> {
    let bad = || SunError::BadDate { text: text.into() };
    let mut fields = text.trim().split('-');
    let mut next = |digits: usize| {
        let field = fields.next()?;
        (field.len() == digits).then_some(())?;
        number(field)
    };
    let ymd = (|| Some((next(4)?, next(2)?, next(2)?)))();
    let (year, month, day) = ymd.ok_or_else(bad)?;
    if fields.next().is_some() {
        return Err(bad());
    }
    let year = i32::try_from(year).map_err(|_| bad())?;
    NaiveDate::from_ymd_opt(year, month, day).ok_or_else(bad)
}

/// A duration in seconds: `30min`, `1h`, `1h30`, `1h30min`, `90s`; at most 366 days.
///
/// # Errors
/// [`SunError::BadDuration`].
pub fn parse_duration_secs(text: &str) -> Result<u32, SunError> {
    let compact: String = text.split_whitespace().collect();
    duration(&compact).ok_or_else(|| SunError::BadDuration { text: text.into() })
}

fn duration(text: &str) -> Option<u32> {
    const MOST_SECS: u64 = 366 * 86_400;
    let mut rest = text;
    let mut seconds = 0_u64;
    let mut units = [("h", 3600), ("min", 60), ("s", 1)].into_iter();
    while !rest.is_empty() {
        let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
        let (count, tail) = rest.split_at(digits);
        let count = u64::from(number(count)?);
        // `1h30`: minutes below 60 need no unit after hours.
        let (size, tail) = if tail.is_empty() && rest.len() < text.len() {
            let minutes = units.next().filter(|unit| unit.0 == "min" && count < 60)?;
            (minutes.1, tail)
        } else {
            units.find_map(|(unit, size)| Some((size, tail.strip_prefix(unit)?)))?
        };
        seconds += count * size;
        rest = tail;
    }
    let written = !text.is_empty() && seconds <= MOST_SECS;
    u32::try_from(seconds).ok().filter(|_| written)
}

/// The part after `sunrise`: nothing, or a sign and a duration. In seconds.
fn parse_shift(text: &str) -> Option<i64> {
    if text.is_empty() {
        return Some(0);
    }
    if let Some(later) = text.strip_prefix('+') {
        return duration(later).map(i64::from);
    }
    // word processors write the true minus sign
    let earlier = text.strip_prefix('-').or_else(|| text.strip_prefix('−'))?;
    duration(earlier).map(|seconds| -i64::from(seconds))
}

/// `10:00`, `10:00:30`, each with or without an offset.
fn parse_clock(text: &str) -> Option<(NaiveTime, Option<FixedOffset>)> {
    if let Some(clock) = text.strip_suffix(['Z', 'z']) {
        return Some((parse_time(clock)?, FixedOffset::east_opt(0)));
    }
    match text.find(['+', '-', '−']) {
        None => Some((parse_time(text)?, None)),
        Some(at) => {
            let (clock, offset) = text.split_at(at);
            let mut rest = offset.chars();
            let sign = if rest.next()? == '+' { 1 } else { -1 };
            let ahead = parse_time(rest.as_str())?.signed_duration_since(NaiveTime::MIN);
            let seconds = sign * i32::try_from(ahead.num_seconds()).ok()?;
            Some((parse_time(clock)?, Some(FixedOffset::east_opt(seconds)?)))
        }
    }
}

fn parse_time(text: &str) -> Option<NaiveTime> {
    let mut fields = text.split(':');
    let hour = fields.next()?;
    let minute = fields.next()?;
    let second = fields.next();
    let two = |field: &str| (field.len() == 2).then(|| number(field)).flatten();
    if fields.next().is_some() || hour.len() > 2 {
        return None;
    }
    NaiveTime::from_hms_opt(number(hour)?, two(minute)?, second.map_or(Some(0), two)?)
}

/// Digits only: no sign, no space.
fn number(text: &str) -> Option<u32> {
    let plain = !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    plain.then(|| text.parse().ok()).flatten()
}
