//! What people type and paste for numbers, degrees, dates and times, in the ways in which they write them.
//!
//! The window's fields and `--place` read so. Site files and all other options keep to the one way that is documented.

mod date;
mod degrees;
mod number;

pub use date::{clock, date, step};
pub use degrees::{Axis, Degrees, degrees, place};
pub use number::{number, within};

use crate::sun::SunError;
use chrono::NaiveDate;

/// Why what was typed is not taken.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TypedError {
    /// Not a number.
    #[error("\"{0}\" is no number; write for example 0.5 or 0,5")]
    Number(String),
    /// A number that cannot be.
    #[error("{value} is not between {low} and {high} {unit}")]
    Outside {
        /// What was typed.
        value: f64,
        /// Smallest value taken.
        low: f64,
        /// Largest value taken.
        high: f64,
        /// Of all three numbers.
        unit: &'static str,
    },
    /// Not an angle on the globe.
    #[error("\"{text}\" is no {axis}; write degrees, for example {}", axis.example())]
    Degrees {
        /// What was typed.
        text: String,
        /// For what.
        axis: Axis,
    },
    /// Not two of them.
    #[error(
        "\"{0}\" is no place; write latitude and longitude in degrees, \
         for example 48.2082, 16.3738 or 48°12'30\" N 16°22'26\" E"
    )]
    Place(String),
    /// A coordinate outside the globe, a step of nothing.
    #[error(transparent)]
    Sun(#[from] SunError),
    /// Not a date.
    #[error("\"{0}\" is no date; write 2026-12-21 or 21.12.2026")]
    Date(String),
    /// A date that can be read in two ways.
    #[error("\"{text}\" can be {} or {}; write {} or {}", long(.dates[0]), long(.dates[1]), .dates[0], .dates[1])]
    TwoDates {
        /// What was typed.
        text: String,
        /// The day first, the month first.
        dates: [NaiveDate; 2],
    },
    /// Not a time of day.
    #[error("\"{0}\" is no time; write 16:30, 16.30, 4 pm, sunrise or sunset-1h30")]
    Clock(String),
    /// The end of a day, which belongs to the next one.
    #[error("a day has no 24 o'clock; write 0:00 for its end")]
    DayEnd,
    /// Not a duration.
    #[error("\"{0}\" is no step; write 30min, 1h, 1h30 or 90s")]
    Step(String),
}

/// A date in words that nobody reads otherwise.
fn long(date: NaiveDate) -> String {
    date.format("%-d %B %Y").to_string()
}
