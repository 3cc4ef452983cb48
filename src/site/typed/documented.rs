//! Values with one documented spelling: those of site files and options.

use super::TypedError;
use super::date::INSTANTS_ALONE;
use crate::message::Field;
use crate::sun::parse_duration_secs;

/// Reads `N` finite numbers, separated by commas; `example` is a hint for the error.
///
/// # Errors
/// [`TypedError::Numbers`]
pub fn numbers<const N: usize>(text: &str, example: (Field, &'static str)) -> Result<[f64; N], TypedError> {
    let read: Option<Vec<f64>> =
        text.split(',').map(|number| number.trim().parse().ok().filter(|number: &f64| number.is_finite())).collect();
    let bad = || TypedError::Numbers { text: text.to_owned(), count: N, example };
    read.and_then(|numbers| numbers.try_into().ok()).ok_or_else(bad)
}

/// Reads the precision of times of change in seconds: a duration above 0, or `step` for the instants alone, which is 0.
///
/// # Errors
/// [`TypedError::Resolution`]
pub fn resolution_secs(text: &str) -> Result<u32, TypedError> {
    if text.trim() == INSTANTS_ALONE {
        return Ok(0);
    }
    let secs = parse_duration_secs(text).ok().filter(|secs| *secs > 0);
    secs.ok_or_else(|| TypedError::Resolution(text.to_owned()))
}
