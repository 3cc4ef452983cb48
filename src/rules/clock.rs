//! The clocks in which rules give the times of their windows.

use super::error::RuleError;
use super::reader::TableReader;
use crate::choice::words;
use crate::sun::{Place, Reading, SunError, Sunrise, Zone, true_solar};
use chrono::{DateTime, Datelike, FixedOffset, NaiveDate, NaiveTime, Offset, TimeDelta, TimeZone, Timelike};

/// A rule's word for a kind of clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ClockWord {
    Legal,
    Standard,
    Fixed,
    TrueSolar,
}

const CLOCK_WORDS: &[(&str, ClockWord)] = &[
    ("legal", ClockWord::Legal),
    ("standard", ClockWord::Standard),
    ("fixed", ClockWord::Fixed),
    ("true-solar", ClockWord::TrueSolar),
];

/// A clock that a rule reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RuleClock {
    /// The official time at the place, summer time included.
    Legal,
    /// The official time without summer time: the smaller of the offsets of 1 January and 1 July, all year.
    Standard,
    /// A fixed offset from UTC, all year.
    Fixed(FixedOffset),
    /// A sundial's time: it is noon when the sun crosses the meridian.
    TrueSolar,
}

/// A rule's clock, and its definition of sunrise and sunset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClockRule {
    /// The clock that its windows are written in.
    pub clock: RuleClock,
    /// The definition of sunrise and sunset for windows that begin or end there.
    pub sunrise: Sunrise,
}

words!(Sunrise, [
    "almanac" => Sunrise::Almanac,
    "geometric" => Sunrise::Geometric,
]);

impl ClockRule {
    /// The keys that `[clock]` may have.
    pub(super) const KEYS: &[&str] = &["kind", "offset", "sunrise"];

    pub(super) fn read(table: TableReader) -> Result<ClockRule, RuleError> {
        let kind = table.one_of("kind", CLOCK_WORDS)?.ok_or_else(|| table.wrong("kind", "it must be written"))?;
        let offset = table.text("offset")?;
        let clock = match (kind, offset) {
            (ClockWord::Fixed, Some(offset)) => RuleClock::Fixed(offset.parse().map_err(|_| {
                table.wrong("offset", format!("{offset:?} is not an offset from UTC; write it as \"-05:00\""))
            })?),
            (ClockWord::Fixed, None) => return Err(table.wrong("offset", "it is required with kind = \"fixed\"")),
            (_, Some(_)) => return Err(table.wrong("offset", "it is allowed only with kind = \"fixed\"")),
            (ClockWord::Legal, None) => RuleClock::Legal,
            (ClockWord::Standard, None) => RuleClock::Standard,
            (ClockWord::TrueSolar, None) => RuleClock::TrueSolar,
        };
        let sunrise = table.word("sunrise")?.unwrap_or_default();
        table.finish()?;
        Ok(ClockRule { clock, sunrise })
    }
}

impl RuleClock {
    /// Returns when the clock shows `time` on a date at a place.
    ///
    /// # Errors
    /// A legal time that does not exist or exists twice, or a year outside 1600 to 2999.
    pub fn at(self, place: &Place, date: NaiveDate, time: NaiveTime) -> Result<DateTime<Zone>, SunError> {
        let legal = || format!("{}", time.format("%H:%M:%S")).parse::<Reading>()?.at(place, date);
        let by = |offset: FixedOffset| {
            // no overflow: a date's year has four digits, and an offset is less than a day
            let utc = date.and_time(time) - TimeDelta::seconds(offset.local_minus_utc().into());
            place.time_zone.from_utc_datetime(&utc)
        };
        match self {
            RuleClock::Legal => legal(),
            RuleClock::Standard => Ok(by(standard_offset(place.time_zone, date.year()))),
            RuleClock::Fixed(offset) => Ok(by(offset)),
            RuleClock::TrueSolar => {
                let secs = i64::from(time.num_seconds_from_midnight());
                // a date without a solar noon has no such time; the error is the legal clock's
                true_solar(place, date, secs)?.map_or_else(legal, Ok)
            }
        }
    }
}

/// A zone's offset from UTC without summer time: the smaller of the offsets of January and July, whichever of them a
/// country calls its winter time.
fn standard_offset(zone: Zone, year: i32) -> FixedOffset {
    let on = |month: u32| {
        let noon = NaiveDate::from_ymd_opt(year, month, 1).and_then(|date| date.and_hms_opt(12, 0, 0));
        noon.map(|noon| zone.offset_from_utc_datetime(&noon).fix())
    };
    let offsets = [on(1), on(7)].into_iter().flatten();
    offsets.min_by_key(|offset| offset.local_minus_utc()).unwrap_or(chrono::Utc.fix())
}
