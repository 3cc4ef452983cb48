//! Numbers with a decimal point or a decimal comma.

use super::TypedError;
use std::ops::RangeInclusive;

/// Reads a number as people write it: `0.5`, `0,5`, `1 234.5`, `1.234,5`, `1,234.5`, `1'234.5`, `−3`, `1e-3`.
///
/// A single point or comma is the decimal separator, whatever follows it: `1,234` is a little more than 1. If there are
/// both, the last one is. Thousands separators must have three digits between them.
///
/// # Errors
/// [`TypedError::Number`].
pub fn number(text: &str) -> Result<f64, TypedError> {
    read(text).ok_or_else(|| TypedError::Number(text.trim().to_owned()))
}

/// Reads a number within a range.
///
/// # Errors
/// [`TypedError::Number`], [`TypedError::Outside`].
pub fn within(text: &str, range: RangeInclusive<f64>, unit: &'static str) -> Result<f64, TypedError> {
    let value = number(text)?;
    let (low, high) = (*range.start(), *range.end());
    if range.contains(&value) { Ok(value) } else { Err(TypedError::Outside { value, low, high, unit }) }
}

fn read(text: &str) -> Option<f64> {
    let text = text.trim();
    let unsigned = text.strip_prefix(['-', '−', '+']).unwrap_or(text).trim_start();
    let sign = if text.starts_with(['-', '−']) { "-" } else { "" };
    let (digits, exponent) = unsigned.split_once(['e', 'E']).unwrap_or((unsigned, "0"));
    let exponent: i32 = exponent.parse().ok()?;
    let mark = digits.rfind(['.', ',']).filter(|at| {
        // a mark that occurs more than once separates thousands
        let mark = &digits[*at..=*at];
        digits.matches(mark).count() == 1
    });
    let (whole, decimals) = mark.map_or((digits, ""), |at| (&digits[..at], &digits[at + 1..]));
    let whole = without_thousands(whole)?;
    if (whole.is_empty() && decimals.is_empty()) || !decimals.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    let number = format!("{sign}{whole}.{decimals}e{exponent}").parse();
    number.ok().filter(|number: &f64| number.is_finite())
}

/// Removes the thousands separators from the digits before the decimals.
fn without_thousands(text: &str) -> Option<String> {
    let Some(mark) = text.chars().find(|char| !char.is_ascii_digit()) else { return Some(text.to_owned()) };
    if !mark.is_whitespace() && !matches!(mark, '.' | ',' | '\'' | '’') {
        return None;
    }
    let is_group = |(index, group): (usize, &str)| {
        let lengths = if index == 0 { 1..=3 } else { 3..=3 };
        lengths.contains(&group.len()) && group.bytes().all(|byte| byte.is_ascii_digit())
    };
    text.split(mark).enumerate().all(is_group).then(|| text.replace(mark, ""))
}
