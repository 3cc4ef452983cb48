//! The windows of a day in which the sun counts.

use super::clock::ClockRule;
use super::error::RuleError;
use super::reader::TableReader;
use super::spell::{Spell, merged};
use crate::sun::{Day, DayWindow, Place, Polar, Reading, SunError, TimeOfDay};
use chrono::{NaiveDate, NaiveTime, TimeDelta};
use toml::Value;

/// Where a window begins or ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WindowEdge {
    /// A time on the rule's clock.
    Clock(NaiveTime),
    /// Seconds after sunrise; negative before.
    Sunrise(i64),
    /// Seconds after sunset; negative before.
    Sunset(i64),
}

/// The windows of a day.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WindowRule {
    /// The whole local date, midnight to midnight: whenever the sun is up.
    WholeDay,
    /// Each from one edge to another.
    Parts(Vec<[WindowEdge; 2]>),
}

impl WindowRule {
    /// Reads the key `windows`; `None` if the table does not have it.
    pub(super) fn read(table: &TableReader) -> Result<Option<WindowRule>, RuleError> {
        let Some(value) = table.value("windows") else { return Ok(None) };
        let wrong = || {
            let what =
                "write windows as \"day\", or as pairs, [[\"09:00\", \"15:00\"]] or [[\"sunrise+1h\", \"sunset-1h\"]]";
            table.wrong("windows", format!("{value} cannot be read; {what}"))
        };
        if value.as_str() == Some("day") {
            return Ok(Some(WindowRule::WholeDay));
        }
        let pairs = value.as_array().filter(|pairs| !pairs.is_empty()).ok_or_else(wrong)?;
        let parts: Vec<[WindowEdge; 2]> = pairs.iter().map(pair).collect::<Option<_>>().ok_or_else(wrong)?;
        for part in &parts {
            if let [WindowEdge::Clock(from), WindowEdge::Clock(to)] = part
                && from >= to
            {
                return Err(table
                    .wrong("windows", format!("the window from {from} to {to} is empty, or ends before it begins")));
            }
        }
        Ok(Some(WindowRule::Parts(parts)))
    }

    /// Returns the windows on a date, in order of time. A window bound to the sun is left out if its edges leave no
    /// room between them, or if the sun stays down all day.
    ///
    /// # Errors
    /// A legal time that does not exist or exists twice, or a window bound to a sunrise or sunset on a day on which the
    /// sun is up throughout.
    pub fn on(&self, place: &Place, date: NaiveDate, clock: ClockRule) -> Result<Vec<Spell>, SunError> {
        let WindowRule::Parts(parts) = self else { return whole_day(place, date) };
        let mut spells = Vec::new();
        for [from, to] in parts {
            if let (Some(start), Some(end)) = (from.on(place, date, clock)?, to.on(place, date, clock)?) {
                spells.push(Spell::new(start, end));
            }
        }
        Ok(merged(spells))
    }
}

fn pair(value: &Value) -> Option<[WindowEdge; 2]> {
    let [from, to] = value.as_array()?.as_slice() else { return None };
    let edge = |value: &Value| {
        let reading: Reading = value.as_str()?.parse().ok()?;
        match (reading.date, reading.time) {
            (None, TimeOfDay::Clock(time, None)) => Some(WindowEdge::Clock(time)),
            (None, TimeOfDay::Sunrise(shift)) => Some(WindowEdge::Sunrise(shift)),
            (None, TimeOfDay::Sunset(shift)) => Some(WindowEdge::Sunset(shift)),
            _ => None,
        }
    };
    Some([edge(from)?, edge(to)?])
}

/// From midnight to midnight on the legal clock: dates are those of the calendar, whichever clock a rule uses.
fn whole_day(place: &Place, date: NaiveDate) -> Result<Vec<Spell>, SunError> {
    let day = DayWindow::on(place, date, None, None)?;
    Ok(merged([Spell::new(day.from.timestamp(), day.to.timestamp())]))
}

impl WindowEdge {
    /// `None` on a date on which the sun stays down.
    fn on(self, place: &Place, date: NaiveDate, clock: ClockRule) -> Result<Option<i64>, SunError> {
        let (event, shift) = match self {
            WindowEdge::Clock(time) => return Ok(Some(clock.clock.at(place, date, time)?.timestamp())),
            WindowEdge::Sunrise(shift) => ("sunrise", shift),
            WindowEdge::Sunset(shift) => ("sunset", shift),
        };
        let day = Day::by(place, date, clock.sunrise)?;
        let time = if event == "sunrise" { day.sunrise } else { day.sunset };
        match time {
            Some(time) => Ok(Some((time + TimeDelta::seconds(shift)).timestamp())),
            None if day.polar == Some(Polar::Night) => Ok(None),
            None => Err(SunError::NoEvent { event, date, why: day.why_absent(), reading: event.to_owned() }),
        }
    }
}
