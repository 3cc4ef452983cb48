//! Why a typed value is not accepted.

use super::Axis;
use crate::message::{Field, Message, Worded, message, plain_display};
use crate::sun::SunError;
use chrono::NaiveDate;

/// Why a typed value is not accepted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TypedError {
    /// Not a number.
    Number(String),
    /// A number outside of its range.
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
    /// Not so many numbers.
    Numbers {
        /// What was typed.
        text: String,
        /// How many are meant.
        count: usize,
        /// What to write, and for which field.
        example: (Field, &'static str),
    },
    /// Not an angle on the globe.
    Degrees {
        /// What was typed.
        text: String,
        /// For what.
        axis: Axis,
    },
    /// Not two of them.
    Place(String),
    /// A coordinate off the globe, or a step of 0.
    Sun(#[from] SunError),
    /// Not a date.
    Date(String),
    /// A date that can be read in two ways.
    TwoDates {
        /// What was typed.
        text: String,
        /// The day first, the month first.
        dates: [NaiveDate; 2],
    },
    /// Not a time of day.
    Clock(String),
    /// The end of a day, which belongs to the next one.
    DayEnd,
    /// Not a duration.
    Step(String),
    /// Neither a duration nor `step`.
    Resolution(String),
}

plain_display!(TypedError);

impl Worded for TypedError {
    fn message(&self) -> Message {
        match self {
            TypedError::Number(text) => message![format!("\"{text}\" is no number"); "write for example 0.5 or 0,5"],
            TypedError::Outside { value, low, high, unit } => {
                format!("{value} is not between {low} and {high} {unit}").into()
            }
            TypedError::Numbers { text, count, example } => message![
                format!("\"{text}\" is not {count} numbers with commas between them");
                "write for example ", *example
            ],
            TypedError::Degrees { text, axis } => message![
                format!("\"{text}\" is no {axis}");
                format!("write degrees, for example {}", axis.example())
            ],
            TypedError::Place(text) => message![
                format!("\"{text}\" is no place");
                "write latitude and longitude in degrees, for example 48.2082, 16.3738 or 48°12'30\" N 16°22'26\" E"
            ],
            TypedError::Sun(error) => error.message(),
            TypedError::Date(text) => message![format!("\"{text}\" is no date"); "write 2026-12-21 or 21.12.2026"],
            TypedError::TwoDates { text, dates: [first, second] } => message![
                format!("\"{text}\" can be {} or {}", long(*first), long(*second));
                format!("write {first} or {second}")
            ],
            TypedError::Clock(text) => message![
                format!("\"{text}\" is no time");
                "write 16:30, 16.30, 4 pm, sunrise or sunset-1h30"
            ],
            TypedError::DayEnd => message!["a day has no 24 o'clock"; "write 0:00 for its end"],
            TypedError::Step(text) => message![format!("\"{text}\" is no step"); "write 30min, 1h, 1h30 or 90s"],
            TypedError::Resolution(text) => message![
                format!("\"{text}\" is no resolution");
                "write 1min, 10s, or step for the instants alone"
            ],
        }
    }
}

/// A date in words that nobody reads otherwise.
fn long(date: NaiveDate) -> String {
    date.format("%-d %B %Y").to_string()
}
