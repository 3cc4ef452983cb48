//! What can be wrong with a place, a clock reading or a window.

use super::Zone;
use crate::message::{Field, Message, Piece, Worded, pieces, plain_display};
use chrono::{DateTime, NaiveDate, NaiveDateTime};

/// Why a place, a reading or a window has no sun track.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SunError {
    /// A coordinate outside the earth, or not a number.
    OutOfRange {
        /// `latitude`, `longitude` or `elevation`.
        what: &'static str,
        /// What was given.
        value: f64,
        /// Smallest value taken.
        low: f64,
        /// Largest value taken.
        high: f64,
        /// Of all three numbers.
        unit: &'static str,
    },
    /// A name that the time zone database does not know.
    UnknownZone {
        /// What was given.
        name: String,
        /// What was meant, and a hint.
        hint: String,
    },
    /// No zone could be found from the coordinates.
    NoZone {
        /// Degrees, north positive.
        latitude_deg: f64,
        /// Degrees, east positive.
        longitude_deg: f64,
    },
    /// Not a date.
    BadDate {
        /// What was given.
        text: String,
    },
    /// Not a clock reading.
    BadReading {
        /// What was given.
        text: String,
    },
    /// Not a duration.
    BadDuration {
        /// What was given.
        text: String,
    },
    /// A step of nothing.
    ZeroStep,
    /// More instants than anyone wants.
    TooManyInstants {
        /// The requested step.
        step_secs: u32,
        /// The requested window.
        window_secs: i64,
        /// How many that makes.
        instants: i64,
        /// How many are taken.
        most: i64,
        /// The smallest step that fits.
        least_secs: i64,
    },
    /// A window of more days than can be summed.
    WindowTooLong {
        /// Whole days asked.
        days: i64,
        /// How many are taken.
        most: i64,
    },
    /// A day's window begins before that of the day before ends.
    Overlap {
        /// The later date.
        date: NaiveDate,
    },
    /// On none of several days there is anything between `from` and `to`.
    NoWindow {
        /// The first date.
        first: NaiveDate,
        /// The last date.
        last: NaiveDate,
    },
    /// On a date there is nothing between `from` and `to`, which are bound to the sun.
    NothingAsked {
        /// As written.
        from: String,
        /// As written.
        to: String,
        /// The local date.
        date: NaiveDate,
        /// What the sun does then.
        why: &'static str,
    },
    /// `from` and `to` are the same.
    EmptyWindow {
        /// As written.
        from: String,
        /// As written.
        to: String,
        /// The next day's `to` with its date.
        example: String,
    },
    /// `to` names its own day and lies before `from`.
    Backwards {
        /// Start.
        from: DateTime<Zone>,
        /// End.
        to: DateTime<Zone>,
    },
    /// The reading has no date and nothing else gives one.
    NoDate {
        /// As written.
        reading: String,
    },
    /// The date is said twice, differently.
    TwoDates {
        /// As written.
        reading: String,
        /// The study's.
        date: NaiveDate,
    },
    /// Skipped when clocks went forward.
    NoSuchTime {
        /// What was asked.
        local: NaiveDateTime,
        /// The time zone of that clock.
        zone: Zone,
        /// The clock at the jump, before it.
        before: String,
        /// The clock at the jump, after it.
        after: String,
        /// What the new clock's offset makes of it.
        earlier: String,
        /// What the old clock's offset makes of it.
        later: String,
    },
    /// Read twice when clocks went back.
    TwoReadings {
        /// What was asked.
        local: NaiveDateTime,
        /// The time zone of that clock.
        zone: Zone,
        /// The first one, with its offset.
        earlier: String,
        /// The second one, with its offset.
        later: String,
        /// What to write for the second.
        example: String,
    },
    /// The offset is none that the clock has at that time.
    WrongOffset {
        /// What was asked.
        local: NaiveDateTime,
        /// The time zone of that clock.
        zone: Zone,
        /// What was given.
        offset: String,
        /// The readings that exist, with their offsets.
        choices: String,
    },
    /// A reading counts from a sunrise or sunset that does not happen.
    NoEvent {
        /// `sunrise` or `sunset`.
        event: &'static str,
        /// The local date.
        date: NaiveDate,
        /// Polar day, polar night or a day between.
        why: &'static str,
        /// As written.
        reading: String,
    },
    /// Outside the years for which the earth's rotation is known well enough.
    Year {
        /// What was asked.
        year: i32,
        /// First year taken.
        first: i32,
        /// Last year taken.
        last: i32,
    },
    /// The solar position library refused.
    Position(String),
}

plain_display!(SunError);

/// As the site file has it.
const FROM: Piece = Piece::Key(Field::From);
const TO: Piece = Piece::Key(Field::To);

impl Worded for SunError {
    fn message(&self) -> Message {
        Message { what: self.what(), hint: self.hint() }
    }
}

impl SunError {
    /// What is wrong.
    fn what(&self) -> Vec<Piece> {
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
            SunError::Backwards { from, to } => format!("the window ends at {to}, before it begins at {from}"),
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

    /// What can be done; nothing where the error says it all.
    fn hint(&self) -> Vec<Piece> {
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
            SunError::Year { .. } => pieces!["take a date within"],
            SunError::ZeroStep => pieces!["give at least 1s, for example 30min"],
            SunError::TooManyInstants { least_secs, .. } => pieces![format!("take a step of at least {least_secs}s")],
            SunError::WindowTooLong { .. } => pieces!["take a shorter one"],
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
