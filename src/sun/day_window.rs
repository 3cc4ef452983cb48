//! The part of a day for questions about single days.

use super::day::midnight;
use super::{Day, Place, Reading, SunError, Window, Zone};
use chrono::{DateTime, NaiveDate};

/// A day, and the requested part of it.
#[derive(Clone, Debug, PartialEq)]
pub struct DayWindow {
    /// The date, and what the sun does on it.
    pub day: Day,
    /// The first instant of that part.
    pub from: DateTime<Zone>,
    /// The end of that part.
    pub to: DateTime<Zone>,
}

impl DayWindow {
    /// The whole local date, from midnight to midnight, or the part between two readings without dates. As in a study's
    /// window, a `to` earlier than `from` is on the next day. But if both are bound to the sun and the end is before
    /// the beginning, as with `sunrise+…` and `sunset-…` on a short day, the window is empty.
    ///
    /// # Errors
    /// Readings that are not instants on that date, or are equal; a year outside 1600 to 2999.
    pub fn on(
        place: &Place,
        date: NaiveDate,
        from: Option<&Reading>,
        to: Option<&Reading>,
    ) -> Result<DayWindow, SunError> {
        let day = Day::of(place, date)?;
        if let (Some(from), Some(to)) = (from, to) {
            let window = Window { date: Some(date), from: from.clone(), to: to.clone(), step_secs: 1 };
            let [from, to] = match window.light(place, date)? {
                Some(light) => light,
                None => match window.within_day(place, date)? {
                    Some(to) => [window.begin(place)?, to],
                    None => window.bounds(place)?,
                },
            };
            return Ok(DayWindow { day, from, to: to.max(from) });
        }
        let next = date.succ_opt().unwrap_or(date);
        let from = from.map_or_else(|| Ok(midnight(place, date)), |from| from.bound(place, date))?;
        let to = to.map_or_else(|| Ok(midnight(place, next)), |to| to.bound(place, date))?;
        Ok(DayWindow { day, from, to: to.max(from) })
    }
}
