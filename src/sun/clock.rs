//! What people write for times and durations, and when that is at a place.

use super::day::light;
use super::zone::Jump;
use super::{Day, Place, SunError, Zone};
use chrono::{DateTime, FixedOffset, NaiveDate, NaiveDateTime, NaiveTime, Offset, TimeDelta, TimeZone};
use std::fmt;
use std::str::FromStr;

/// A time as written: a clock time, or one that counts from the sun's rise or set.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reading {
    /// Its own date, where it names one.
    pub date: Option<NaiveDate>,
    /// What it says of the day.
    pub time: TimeOfDay,
    text: String,
}

/// The part of a reading within its day.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TimeOfDay {
    /// Local clock time, whole seconds; the offset chooses where that exists twice.
    Clock(NaiveTime, Option<FixedOffset>),
    /// Seconds after the sunrise.
    Sunrise(i64),
    /// Seconds after the sunset.
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
        // A date ends at a T or, as TOML and people also write it, at a space.
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

/// When a reading is on one date: an instant, or why there is none.
pub(super) enum ReadingTime {
    /// One instant.
    At(DateTime<Zone>),
    /// A sunrise or sunset that does not happen: what stands for it in a window, and the error where nothing can.
    Instead(DateTime<Zone>, SunError),
    /// None that can be taken; both instants that it could mean, and the error that says so.
    Not([DateTime<Zone>; 2], SunError),
}

impl Reading {
    /// The instant that this reading is at the place on a date (its own date goes first).
    ///
    /// # Errors
    /// A clock time that does not exist or exists twice, an offset that fits neither,
    /// a sunrise or sunset that does not happen.
    pub fn at(&self, place: &Place, date: NaiveDate) -> Result<DateTime<Zone>, SunError> {
        match self.when(place, date)? {
            ReadingTime::At(time) => Ok(time),
            ReadingTime::Instead(_, error) | ReadingTime::Not(_, error) => Err(error),
        }
    }

    /// As [`Reading::at`], where a window begins or ends: with the date's light, and where it has none at what stands for a
    /// sunrise or sunset that does not happen.
    pub(super) fn bound(&self, place: &Place, date: NaiveDate) -> Result<DateTime<Zone>, SunError> {
        let of_light = |end: usize, shift_secs| {
            let light = light(place, self.date.unwrap_or(date))?;
            Ok(light.map(|light| light[end].shifted(shift_secs)))
        };
        let found = match self.time {
            TimeOfDay::Clock(..) => None,
            TimeOfDay::Sunrise(shift_secs) => of_light(0, shift_secs)?,
            TimeOfDay::Sunset(shift_secs) => of_light(1, shift_secs)?,
        };
        if let Some(time) = found {
            return Ok(time);
        }
        match self.when(place, date)? {
            ReadingTime::At(time) | ReadingTime::Instead(time, _) => Ok(time),
            ReadingTime::Not(_, error) => Err(error),
        }
    }

    /// As [`Reading::at`], but keeps what stands for an event, and what an impossible clock time could have meant.
    pub(super) fn when(&self, place: &Place, date: NaiveDate) -> Result<ReadingTime, SunError> {
        let date = self.date.unwrap_or(date);
        let event = |event, shift_secs, of: fn(&Day) -> Option<DateTime<Zone>>| {
            let day = Day::of(place, date)?;
            Ok(match of(&day) {
                // Shifts are at most 366 days and years four digits: no overflow.
                Some(time) => ReadingTime::At(time + TimeDelta::seconds(shift_secs)),
                None => {
                    let (why, reading) = (day.why_absent(), self.text.clone());
                    ReadingTime::Instead(day.instead(place, self.time), SunError::NoEvent { event, date, why, reading })
                }
            })
        };
        match self.time {
            TimeOfDay::Clock(clock, offset) => Ok(local(place.time_zone, date.and_time(clock), offset)),
            TimeOfDay::Sunrise(shift) => event("sunrise", shift, |day| day.sunrise),
            TimeOfDay::Sunset(shift) => event("sunset", shift, |day| day.sunset),
        }
    }
}

/// The instant of a local clock time in a zone.
fn local(zone: Zone, local: NaiveDateTime, offset: Option<FixedOffset>) -> ReadingTime {
    let readings = match zone.readings(local) {
        Ok(readings) => readings,
        Err(jump) => return gap(zone, local, &jump),
    };
    let [earlier, later] = readings;
    let twice = earlier != later;
    match offset {
        None if !twice => ReadingTime::At(earlier),
        None => ReadingTime::Not(
            readings,
            SunError::TwoReadings {
                local,
                zone,
                earlier: written(earlier),
                later: written(later),
                example: written(later),
            },
        ),
        Some(offset) => match readings.into_iter().find(|time| time.offset().fix() == offset) {
            Some(time) => ReadingTime::At(time),
            None => ReadingTime::Not(
                readings,
                SunError::WrongOffset {
                    local,
                    zone,
                    offset: offset.to_string(),
                    choices: if twice {
                        format!("{} or {}", written(earlier), written(later))
                    } else {
                        written(earlier)
                    },
                },
            ),
        },
    }
}

/// A local time that clocks jump over: both ways to read it, and the jump itself.
fn gap(zone: Zone, local: NaiveDateTime, jump: &Jump) -> ReadingTime {
    let by = |offset: FixedOffset| zone.from_utc_datetime(&(local - offset));
    let [before, after] = [jump.before, jump.after].map(|offset| jump.at + offset);
    // where a whole day is left out, the clock alone says nothing
    let two_dates = before.date() != after.date();
    let [before, after] =
        [before, after].map(|clock| if two_dates { format!("{clock:?}") } else { clock.time().to_string() });
    // by the new clock it is before the jump, by the old one after it
    let meant = [by(jump.after), by(jump.before)];
    ReadingTime::Not(
        meant,
        SunError::NoSuchTime { local, zone, before, after, earlier: written(meant[0]), later: written(meant[1]) },
    )
}

/// A time as it may be written again.
fn written(time: DateTime<Zone>) -> String {
    let seconds = if chrono::Timelike::second(&time) == 0 { "%Y-%m-%dT%H:%M" } else { "%Y-%m-%dT%H:%M:%S" };
    format!("{}{}", time.format(seconds), time.offset().fix())
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
        // `1h30`: minutes below 60 need no unit where hours stand before them and nothing after.
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

/// What follows `sunrise`: nothing, or a sign and a duration. In seconds.
fn parse_shift(text: &str) -> Option<i64> {
    if text.is_empty() {
        return Some(0);
    }
    if let Some(later) = text.strip_prefix('+') {
        return duration(later).map(i64::from);
    }
    // The true minus sign as well, which word processors write.
    let earlier = text.strip_prefix('-').or_else(|| text.strip_prefix('−'))?;
    duration(earlier).map(|seconds| -i64::from(seconds))
}

/// `10:00`, `10:00:30`, each with an offset or not.
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
