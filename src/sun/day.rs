//! Sunrise, noon and sunset of a local calendar day.

use super::position::{check_year, delta_t_secs, location};
use super::{Place, SunError, TimeOfDay, Zone};
use chrono::{DateTime, Datelike, DurationRound, NaiveDate, NaiveTime, TimeDelta, TimeZone};
use solar_positioning::{Events, Horizon, SolarEvents};

/// The definition of sunrise and sunset. Almanacs and some rules use different ones, which are minutes apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Sunrise {
    /// The upper limb appears in standard air: the centre is 0.833° below the horizon.
    #[default]
    Almanac,
    /// The centre is at the horizon, without refraction.
    Geometric,
}

impl Sunrise {
    /// The altitude of the sun's centre, without refraction, that defines it, degrees.
    fn altitude_deg(self) -> f64 {
        match self {
            Sunrise::Almanac => -0.833,
            Sunrise::Geometric => 0.0,
        }
    }
}

/// A calendar day at the place. Events that do not happen on it (polar day and night) are `None`.
#[derive(Clone, Debug, PartialEq)]
pub struct Day {
    /// The local date.
    pub date: NaiveDate,
    /// When the upper limb is at −0.833°, rising.
    pub sunrise: Option<DateTime<Zone>>,
    /// When the sun crosses the meridian.
    pub noon: Option<DateTime<Zone>>,
    /// When the upper limb is at −0.833°, setting.
    pub sunset: Option<DateTime<Zone>>,
    /// Set if the sun neither rises nor sets on this day.
    pub polar: Option<Polar>,
}

/// A day on which the sun neither rises nor sets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Polar {
    /// It stays up.
    Day,
    /// It stays down.
    Night,
}

impl Day {
    /// The events of one local date, to the second, at sea level's horizon.
    ///
    /// A date that a zone skipped has no events. At the beginning or end of polar day a date can have two sunrises or
    /// sunsets: `sunrise` is the first, `sunset` the first after it.
    ///
    /// # Errors
    /// A year outside 1600 to 2999.
    pub fn of(place: &Place, date: NaiveDate) -> Result<Day, SunError> {
        Day::by(place, date, Sunrise::Almanac)
    }

    /// As [`Day::of`], with a different definition of sunrise and sunset.
    ///
    /// # Errors
    /// A year outside 1600 to 2999.
    #[doc(hidden)]
    pub fn by(place: &Place, date: NaiveDate, sunrise: Sunrise) -> Result<Day, SunError> {
        let events = events(place, date, sunrise)?;
        let polar = match () {
            () if events.always_above() => Some(Polar::Day),
            () if events.always_below() => Some(Polar::Night),
            () => None,
        };
        let rise = events.rises.first();
        let set = events.sets.iter().find(|set| rise.is_none_or(|rise| *set > rise)).or(events.sets.last());
        let on_date = |time: Option<&DateTime<Zone>>| time.map(|time| to_second(*time));
        let noon = on_date(events.transits.first());
        Ok(Day { date, sunrise: on_date(rise), noon, sunset: on_date(set), polar })
    }

    /// Why it has no sunrise or sunset, in words.
    pub(crate) fn why_absent(&self) -> &'static str {
        match self.polar {
            Some(Polar::Day) => "the sun stays up all day (polar day)",
            Some(Polar::Night) => "the sun stays down all day (polar night)",
            None if self.noon.is_none() => "the clock leaves that date out",
            None => "near polar day and night it falls on another date",
        }
    }

    /// The replacement in a window for a sunrise or sunset that does not happen: if the sun is up, the first or last
    /// midnight of the day; if it is down, noon.
    pub(super) fn instead(&self, place: &Place, of: TimeOfDay) -> DateTime<Zone> {
        match (self.polar, of) {
            (Some(Polar::Night), _) => self.noon.unwrap_or_else(|| midnight(place, self.date)),
            (_, TimeOfDay::Sunset(_)) => midnight(place, self.date.succ_opt().unwrap_or(self.date)),
            _ => midnight(place, self.date),
        }
    }
}

/// The beginning or end of a day's light.
#[derive(Clone, Copy, Debug)]
pub(super) enum Bound {
    /// At a sunrise or sunset.
    Event(DateTime<Zone>),
    /// At the day's midnight, with the sun up before and after it.
    Midnight(DateTime<Zone>),
}

impl Bound {
    /// The same some seconds later. Midnight stays, as it is not an event to count from.
    pub(super) fn shifted(self, secs: i64) -> DateTime<Zone> {
        match self {
            // no overflow: shifts are at most 366 days, and years have four digits
            Bound::Event(time) => time + TimeDelta::seconds(secs),
            Bound::Midnight(time) => time,
        }
    }
}

/// The beginning and end of a date's light; `None` if it has none.
///
/// Light from a sunrise to its sunset belongs to the date of the sunrise, even if the sunset is on the next date. Light
/// longer than a day, as at midsummer near the poles, is cut at each midnight. So all light belongs to exactly one
/// date. If a date has two pieces of light, the night between them is included.
pub(super) fn light(place: &Place, date: NaiveDate) -> Result<Option<[Bound; 2]>, SunError> {
    const LONGEST: TimeDelta = TimeDelta::hours(24);
    let today = events(place, date, Sunrise::Almanac)?;
    let (first_set, last_rise) = (today.sets.first(), today.rises.last());
    let up_at_start = match first_set {
        Some(set) => today.rises.first().is_none_or(|rise| set < rise),
        None => today.always_above(),
    };
    let up_at_end = match last_rise {
        Some(rise) => today.sets.last().is_none_or(|set| set < rise),
        None => today.always_above(),
    };
    let is_of_yesterday = match first_set {
        Some(set) if up_at_start => {
            let yesterday = date.pred_opt().map(|date| events(place, date, Sunrise::Almanac)).transpose()?;
            let rise = yesterday.and_then(|events| events.rises.last().copied());
            rise.is_some_and(|rise| *set - rise <= LONGEST)
        }
        _ => false,
    };
    let begin = match today.rises.first() {
        _ if up_at_start && !is_of_yesterday => Bound::Midnight(midnight(place, date)),
        Some(rise) => Bound::Event(to_second(*rise)),
        None => return Ok(None),
    };
    let next = date.succ_opt().unwrap_or(date);
    let end = match (last_rise, today.sets.last()) {
        (Some(rise), _) if up_at_end => {
            let set = events(place, next, Sunrise::Almanac)?.sets.first().copied();
            set.filter(|set| *set - *rise <= LONGEST).map(|set| Bound::Event(to_second(set)))
        }
        (_, Some(set)) => Some(Bound::Event(to_second(*set))),
        _ => None,
    };
    Ok(Some([begin, end.unwrap_or_else(|| Bound::Midnight(midnight(place, next)))]))
}

/// The sun's events between one local midnight and the next.
fn events(place: &Place, date: NaiveDate, sunrise: Sunrise) -> Result<Events<DateTime<Zone>>, SunError> {
    check_year(date.year())?;
    let delta_t = delta_t_secs(date.and_time(NaiveTime::MIN).and_utc())?;
    SolarEvents::new()
        .for_date(date, &place.time_zone, location(place), delta_t, Horizon::Custom(sunrise.altitude_deg()))
        .map_err(|error| SunError::Position(error.to_string()))
}

/// Rounds to whole seconds within the same local date.
fn to_second(time: DateTime<Zone>) -> DateTime<Zone> {
    let second = TimeDelta::seconds(1);
    let near = time.duration_round(second).unwrap_or(time);
    if near.date_naive() == time.date_naive() {
        near
    } else {
        // half a second before midnight
        time.duration_trunc(second).unwrap_or(time)
    }
}

/// The first instant of a local date: midnight, or the end of the jump if clocks skip midnight.
pub(super) fn midnight(place: &Place, date: NaiveDate) -> DateTime<Zone> {
    match place.time_zone.readings(date.and_time(NaiveTime::MIN)) {
        Ok([first, _]) => first,
        Err(jump) => place.time_zone.from_utc_datetime(&jump.at),
    }
}
