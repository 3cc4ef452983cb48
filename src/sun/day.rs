//! Sunrise, noon and sunset of a local calendar day.

use super::position::{check_year, delta_t_secs, location};
use super::{Day, Place, SunError, Zone};
use chrono::{DateTime, Datelike, DurationRound, NaiveDate, NaiveTime, TimeDelta, TimeZone};
use solar_positioning::{Events, Horizon, SolarEvents};

/// Altitude of the sun's centre, without refraction, at which almanacs let its upper limb appear, degrees.
const RISE_DEG: f64 = -0.833;

/// Why a sunrise or sunset may be missing.
pub(super) const POLAR_DAY: &str = "the sun stays up all day (polar day)";
pub(super) const POLAR_NIGHT: &str = "the sun stays down all day (polar night)";
const BETWEEN: &str = "near polar day and night it falls on another date";

impl Day {
    /// The events of one local date, to the second, at sea level's horizon.
    ///
    /// A date that a zone skipped has none. Where polar day begins or ends a date can have two of one kind:
    /// the sunrise is the first, the sunset the first after it.
    ///
    /// # Errors
    /// A year outside 1600 to 2999.
    pub fn of(place: &Place, date: NaiveDate) -> Result<Day, SunError> {
        let events = events(place, date)?;
        let rise = events.rises.first();
        let set = events.sets.iter().find(|set| rise.is_none_or(|rise| *set > rise)).or(events.sets.last());
        let on_date = |time: Option<&DateTime<Zone>>| time.map(|time| to_second(*time));
        Ok(Day { date, sunrise: on_date(rise), noon: on_date(events.transits.first()), sunset: on_date(set) })
    }
}

/// Why the day lacks a sunrise or sunset, in words.
pub(super) fn why_absent(place: &Place, date: NaiveDate) -> Result<&'static str, SunError> {
    let events = events(place, date)?;
    Ok(if events.always_above() {
        POLAR_DAY
    } else if events.always_below() {
        POLAR_NIGHT
    } else {
        BETWEEN
    })
}

/// Everything that the sun does between one local midnight and the next.
fn events(place: &Place, date: NaiveDate) -> Result<Events<DateTime<Zone>>, SunError> {
    check_year(date.year())?;
    let delta_t = delta_t_secs(date.and_time(NaiveTime::MIN).and_utc())?;
    SolarEvents::new()
        .for_date(date, &place.time_zone, location(place), delta_t, Horizon::Custom(RISE_DEG))
        .map_err(|error| SunError::Position(error.to_string()))
}

/// The nearest whole second on the same local date.
fn to_second(time: DateTime<Zone>) -> DateTime<Zone> {
    let second = TimeDelta::seconds(1);
    let near = time.duration_round(second).unwrap_or(time);
    if near.date_naive() == time.date_naive() {
        near
    } else {
        // Half a second before midnight.
        time.duration_trunc(second).unwrap_or(time)
    }
}

/// The first instant of a local date: its first midnight or, where clocks skip that, the instant with which they go on.
pub(super) fn midnight(place: &Place, date: NaiveDate) -> DateTime<Zone> {
    match place.time_zone.readings(date.and_time(NaiveTime::MIN)) {
        Ok([first, _]) => first,
        Err(jump) => place.time_zone.from_utc_datetime(&jump.at),
    }
}
