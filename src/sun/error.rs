//! What can be wrong with a place, a clock reading or a window.

use super::Zone;
use crate::message::{Field, Message, MessagePart, Worded, pieces, plain_display};
use chrono::{DateTime, NaiveDate, NaiveDateTime};

/// Why a place, a reading or a window is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SunError {
    /// A coordinate out of range, or not a number.
    OutOfRange {
        /// `latitude`, `longitude` or `elevation`.
        what: &'static str,
        /// The given value.
        value: f64,
        /// The least allowed value.
        low: f64,
        /// The greatest allowed value.
        high: f64,
        /// The unit of all three.
        unit: &'static str,
    },
    /// A name that is not in the time zone database.
    UnknownZone {
        /// The given name.
        name: String,
        /// What it probably means, and a hint.
        hint: String,
    },
    /// The coordinates have no time zone.
    NoZone {
        /// Degrees, north positive.
        latitude_deg: f64,
        /// Degrees, east positive.
        longitude_deg: f64,
    },
    /// Not a date.
    BadDate {
        /// The given text.
        text: String,
    },
    /// Not a clock reading.
    BadReading {
        /// The given text.
        text: String,
    },
    /// Not a duration.
    BadDuration {
        /// The given text.
        text: String,
    },
    /// A step of 0.
    ZeroStep,
    /// Too many instants.
    TooManyInstants {
        /// The requested step.
        step_secs: u32,
        /// The requested window.
        window_secs: i64,
        /// The number of instants.
        instants: i64,
        /// The greatest number.
        most: i64,
        /// The least step that is possible.
        least_secs: i64,
    },
    /// A window that is too long to be summed.
    WindowTooLong {
        /// The length in whole days.
        days: i64,
        /// The greatest length.
        most: i64,
    },
    /// A day's window begins before the previous day's window ends.
    Overlap {
        /// The later date.
        date: NaiveDate,
    },
    /// No day of several has any time between `from` and `to`.
    NoWindow {
        /// The first date.
        first: NaiveDate,
        /// The last date.
        last: NaiveDate,
    },
    /// A date has no time between `from` and `to`, which are bound to the sun.
    NothingAsked {
        /// As written.
        from: String,
        /// As written.
        to: String,
        /// The local date.
        date: NaiveDate,
        /// What the sun does on that date.
        why: &'static str,
    },
    /// `from` and `to` are the same.
    EmptyWindow {
        /// As written.
        from: String,
        /// As written.
        to: String,
        /// `to` on the next day, with its date.
        example: String,
    },
    /// `to` has its own date, and is before `from`.
    Backwards {
        /// The beginning.
        from: DateTime<Zone>,
        /// The end.
        to: DateTime<Zone>,
    },
    /// The reading has no date, and the request has none.
    NoDate {
        /// As written.
        reading: String,
    },
    /// Two different dates are given.
    TwoDates {
        /// As written.
        reading: String,
        /// The study's date.
        date: NaiveDate,
    },
    /// A time that clocks skip when they go forward.
    NoSuchTime {
        /// The given time.
        local: NaiveDateTime,
        /// The time zone of that clock.
        zone: Zone,
        /// The clock at the jump, before it.
        before: String,
        /// The clock at the jump, after it.
        after: String,
        /// Its instant by the new offset.
        earlier: String,
        /// Its instant by the old offset.
        later: String,
    },
    /// A time that happens twice when clocks go back.
    TwoReadings {
        /// The given time.
        local: NaiveDateTime,
        /// The time zone of that clock.
        zone: Zone,
        /// The first one, with its offset.
        earlier: String,
        /// The second one, with its offset.
        later: String,
        /// How to write the second.
        example: String,
    },
    /// An offset that the clock does not have at that time.
    WrongOffset {
        /// The given time.
        local: NaiveDateTime,
        /// The time zone of that clock.
        zone: Zone,
        /// The given offset.
        offset: String,
        /// The times that exist, with their offsets.
        choices: String,
    },
    /// A reading relative to a sunrise or sunset that does not happen.
    NoEvent {
        /// `sunrise` or `sunset`.
        event: &'static str,
        /// The local date.
        date: NaiveDate,
        /// Polar day, polar night, or a day between them.
        why: &'static str,
        /// As written.
        reading: String,
    },
    /// A year for which the Earth's rotation is not known well enough.
    Year {
        /// The given year.
        year: i32,
        /// The first allowed year.
        first: i32,
        /// The last allowed year.
        last: i32,
    },
    /// An error of the solar position library.
    Position(String),
}

plain_display!(SunError);

/// As in the site file.
const FROM: MessagePart = MessagePart::Key(Field::From);
const TO: MessagePart = MessagePart::Key(Field::To);

impl Worded for SunError {
    fn message(&self) -> Message {
        Message { what: self.what(), hint: self.hint() }
    }
}

impl SunError {
    fn what(&self) -> Vec<MessagePart> {
        let text = match self {
            SunError::OutOfRange { what, value, low, high, unit } => {
                format!("{what} {value} is not between {low} and {high} {unit}")
            }
            SunError::UnknownZone { name, .. } => format!("time zone \"{name}\" is not in the IANA list"),
            SunError::NoZone { latitude_deg, longitude_deg } => {
                format!("no time zone is known at latitude {latitude_deg}, longitude {longitude_deg}")
            }
            SunError::BadDate { text } => format!("\"{text}\" is not a date"),
            SunError::BadReading { text } => format!("\"{text}\" is not a time"),
            SunError::BadDuration { text } => format!("\"{text}\" is not a duration"),
            SunError::Year { year, first, last } => {
                format!("the year {year} is outside {first} to {last}, for which ΔT is known")
            }
            SunError::Position(why) => format!("the sun's position cannot be computed: {why}"),
            SunError::ZeroStep => "a step of 0 never reaches the window's end".to_owned(),
            SunError::TooManyInstants { step_secs, window_secs, instants, most, .. } => format!(
                "a step of {step_secs} s in a window of {window_secs} s makes {instants} instants, more than {most}"
            ),
            SunError::WindowTooLong { days, most } => format!("the window of {days} days is longer than {most} days"),
            SunError::Overlap { date } => format!("the window of {date} begins before that of the day before ends"),
            SunError::NoWindow { first, last } => {
                let no_day = format!("from {first} to {last} no day has a time between `");
                return pieces![no_day, FROM, "` and `", TO, "`"];
            }
            SunError::NothingAsked { from, to, date, why } => {
                format!("on {date} there is nothing from {from} to {to}: {why}")
            }
            SunError::EmptyWindow { from, to, .. } => format!("the window from {from} to {to} is empty"),
            SunError::Backwards { from, to } => format!("the window ends at {to}, before its beginning at {from}"),
            SunError::NoDate { reading } => format!("{reading} needs a date"),
            SunError::TwoDates { reading, date } => format!("{reading} is not on the study's date {date}"),
            SunError::NoSuchTime { local, zone, before, after, .. } => {
                format!("{local} does not exist in {zone}: clocks jump from {before} to {after}")
            }
            SunError::TwoReadings { local, zone, earlier, later, .. } => {
                format!("{local} exists twice in {zone}: {earlier} and {later}")
            }
            SunError::WrongOffset { local, zone, offset, .. } => format!("{local} in {zone} is never at {offset}"),
            SunError::NoEvent { event, date, why, .. } => format!("there is no {event} on {date}: {why}"),
        };
        pieces![text]
    }

    /// What to do; empty if the error already says it.
    fn hint(&self) -> Vec<MessagePart> {
        match self {
            SunError::OutOfRange { .. } | SunError::Position(_) => pieces![],
            SunError::UnknownZone { hint, .. } => pieces![hint.clone()],
            SunError::NoZone { .. } => pieces!["give it, for example time_zone = \"Europe/Paris\""],
            SunError::BadDate { .. } => pieces!["write year-month-day, for example 2026-09-18"],
            SunError::BadReading { .. } => pieces![
                "write 10:00, 10:00:30, sunrise+1h30, sunset-1h30 or 2026-09-18T15:00, the day's end as 0:00 and an \
                 offset from UTC as in 02:30+01:00"
            ],
            SunError::BadDuration { .. } => pieces!["write 30min, 1h, 1h30 or 90s, at most 366 days"],
            SunError::Year { .. } => pieces!["choose a date in these years"],
            SunError::ZeroStep => pieces!["give at least 1s, for example 30min"],
            SunError::TooManyInstants { least_secs, .. } => pieces![format!("choose a step of at least {least_secs}s")],
            SunError::WindowTooLong { .. } => pieces!["choose a shorter one"],
            SunError::Overlap { .. } => pieces!["give an earlier `", TO, "`"],
            SunError::NoWindow { .. } => pieces!["give an earlier `", FROM, "` or a later `", TO, "`"],
            SunError::NothingAsked { .. } => pieces!["give clock times, or `", TO, "` with its own date"],
            SunError::EmptyWindow { example, .. } => {
                let with_date = format!("` with its date, as in {example}");
                pieces!["give a later `", TO, "`, or for a whole day a `", TO, with_date]
            }
            SunError::Backwards { .. } => pieces!["exchange them or give a later date"],
            SunError::NoDate { .. } => {
                pieces!["write it with one, for example 2026-09-18T15:00, or give date = 2026-09-18"]
            }
            SunError::TwoDates { .. } => pieces!["leave one of the two dates out"],
            SunError::NoSuchTime { earlier, later, .. } => {
                pieces![format!("choose by the offset: {earlier} or {later}")]
            }
            SunError::TwoReadings { example, .. } => {
                pieces![format!("choose one by its offset, for example {example}")]
            }
            SunError::WrongOffset { choices, .. } => {
                pieces![format!("there it is {choices}, or leave the offset out")]
            }
            SunError::NoEvent { reading, .. } => pieces![format!("give a clock time instead of {reading}")],
        }
    }
}
