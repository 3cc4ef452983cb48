//! Why a typed value is refused.

use super::Axis;
use crate::message::{Field, Message, Worded, message, plain_display};
use crate::sun::SunError;
use chrono::NaiveDate;

/// Why a typed value is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TypedError {
    /// Not a number.
    Number(String),
    /// A number outside of its range.
    Outside {
        /// What was typed.
        value: f64,
        /// The least allowed value.
        low: f64,
        /// The greatest allowed value.
        high: f64,
        /// The unit of all three.
        unit: &'static str,
    },
    /// A different number of numbers.
    Numbers {
        /// What was typed.
        text: String,
        /// The number that is expected.
        count: usize,
        /// An example, and its field.
        example: (Field, &'static str),
    },
    /// Not an angle.
    Degrees {
        /// What was typed.
        text: String,
        /// Latitude or longitude.
        axis: Axis,
    },
    /// Not a latitude and a longitude.
    Place(String),
    /// A coordinate out of range, or a step of 0.
    Sun(#[from] SunError),
    /// Not a date.
    Date(String),
    /// An ambiguous date.
    TwoDates {
        /// What was typed.
        text: String,
        /// With the day first, and with the month first.
        dates: [NaiveDate; 2],
    },
    /// Not a time of day.
    Clock(String),
    /// 24 o'clock, which belongs to the next day.
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
            TypedError::Number(text) => message![format!("\"{text}\" is not a number"); "write for example 0.5 or 0,5"],
            TypedError::Outside { value, low, high, unit } => {
                format!("{value} is not between {low} and {high} {unit}").into()
            }
            TypedError::Numbers { text, count, example } => message![
                format!("\"{text}\" is not {count} numbers with commas between them");
                "write for example ", *example
            ],
            TypedError::Degrees { text, axis } => message![
                format!("\"{text}\" is not a {axis}");
                format!("write degrees, for example {}", axis.example())
            ],
            TypedError::Place(text) => message![
                format!("\"{text}\" is not a place");
                "write latitude and longitude in degrees, for example 48.2082, 16.3738 or 48°12'30\" N 16°22'26\" E"
            ],
            TypedError::Sun(error) => error.message(),
            TypedError::Date(text) => message![format!("\"{text}\" is not a date"); "write 2026-12-21 or 21.12.2026"],
            TypedError::TwoDates { text, dates: [first, second] } => message![
                format!("\"{text}\" can be {} or {}", long(*first), long(*second));
                format!("write {first} or {second}")
            ],
            TypedError::Clock(text) => message![
                format!("\"{text}\" is not a time");
                "write 16:30, 16.30, 4 pm, sunrise or sunset-1h30"
            ],
            TypedError::DayEnd => message!["a day has no 24 o'clock"; "write 0:00 for its end"],
            TypedError::Step(text) => message![format!("\"{text}\" is not a step"); "write 30min, 1h, 1h30 or 90s"],
            TypedError::Resolution(text) => message![
                format!("\"{text}\" is not a resolution");
                "write 1min, 10s, or step for the instants alone"
            ],
        }
    }
}

/// A date in words that can be read in only one way.
fn long(date: NaiveDate) -> String {
    date.format("%-d %B %Y").to_string()
}
