//! True solar time.

use super::{Day, Place, SunError, Zone};
use chrono::{DateTime, NaiveDate, TimeDelta};

/// Returns when a sundial shows `secs` seconds after midnight on a local date; `None` if the clock skips that date or
/// an adjoining one.
///
/// A sundial shows noon when the sun crosses the meridian, and counts 24 hours from one noon to the next. The equation
/// of time changes by at most 30 s a day and nearly linearly, so time is interpolated linearly between two noons. The
/// error is far below the second to which noons are known.
///
/// # Errors
/// A year outside 1600 to 2999.
pub fn true_solar(place: &Place, date: NaiveDate, secs: i64) -> Result<Option<DateTime<Zone>>, SunError> {
    const NOON: i64 = 43_200;
    const DAY: i64 = 86_400;
    let noon = |date: Option<NaiveDate>| match date {
        Some(date) => Ok(Day::of(place, date)?.noon),
        None => Ok(None),
    };
    let Some(own) = noon(Some(date))? else { return Ok(None) };
    let after = secs - NOON;
    if after == 0 {
        return Ok(Some(own));
    }
    let beside = if after > 0 { date.succ_opt() } else { date.pred_opt() };
    let Some(beside) = noon(beside)? else { return Ok(None) };
    let length = (beside - own).num_seconds().abs();
    let elapsed = (after as f64 * length as f64 / DAY as f64).round() as i64;
    Ok(Some(own + TimeDelta::seconds(elapsed)))
}
