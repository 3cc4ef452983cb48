//! The instant of a reading at a place, by its clock or the sun.

use super::day::light;
use super::zone::Jump;
use super::{Day, Place, Reading, SunError, TimeOfDay, Zone};
use chrono::{DateTime, FixedOffset, NaiveDate, NaiveDateTime, Offset, TimeDelta, TimeZone};

/// When a reading is on one date: an instant, or why there is none.
pub(super) enum ReadingTime {
    /// An instant.
    At(DateTime<Zone>),
    /// A sunrise or sunset that does not happen: the time that a window uses instead, and the error for everything
    /// else.
    Instead(DateTime<Zone>, SunError),
    /// No single instant: the two instants that the reading could mean, and the error.
    Not([DateTime<Zone>; 2], SunError),
}

impl Reading {
    /// The instant of this reading at the place on a date. The reading's own date has priority.
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

    /// As [`Reading::at`], for the beginning or end of a window: with the date's light, and with the replacement for a
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

    /// As [`Reading::at`], but also returns the replacement for an event, and what an impossible clock time could mean.
    pub(super) fn when(&self, place: &Place, date: NaiveDate) -> Result<ReadingTime, SunError> {
        let date = self.date.unwrap_or(date);
        let event = |event, shift_secs, of: fn(&Day) -> Option<DateTime<Zone>>| {
            let day = Day::of(place, date)?;
            Ok(match of(&day) {
                // no overflow: shifts are at most 366 days, and years have four digits
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

/// A local time that clocks skip: its two interpretations, and the jump.
fn gap(zone: Zone, local: NaiveDateTime, jump: &Jump) -> ReadingTime {
    let by = |offset: FixedOffset| zone.from_utc_datetime(&(local - offset));
    let [before, after] = [jump.before, jump.after].map(|offset| jump.at + offset);
    // if a whole date is skipped, a time without its date would be ambiguous
    let two_dates = before.date() != after.date();
    let [before, after] =
        [before, after].map(|clock| if two_dates { format!("{clock:?}") } else { clock.time().to_string() });
    // with the new offset it is before the jump, with the old offset after it
    let meant = [by(jump.after), by(jump.before)];
    ReadingTime::Not(
        meant,
        SunError::NoSuchTime { local, zone, before, after, earlier: written(meant[0]), later: written(meant[1]) },
    )
}

/// A time as it can be typed again.
fn written(time: DateTime<Zone>) -> String {
    let seconds = if chrono::Timelike::second(&time) == 0 { "%Y-%m-%dT%H:%M" } else { "%Y-%m-%dT%H:%M:%S" };
    format!("{}{}", time.format(seconds), time.offset().fix())
}
