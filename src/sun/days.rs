//! The instants of a window on each of several days.

use super::window::{MOST_INSTANTS, track};
use super::{DayWindow, EachDay, Place, Polar, SunError, SunTrack, TimeOfDay, Zone};
use chrono::{DateTime, NaiveDate};
use rayon::prelude::*;

impl SunTrack {
    /// Returns the instants of the same window on each of several consecutive dates: those of each day's window, one
    /// after another, with the same weights. If a day's window ends when the next begins, they share one instant.
    ///
    /// A day has no instants if `sunrise+…` is later than `sunset-…`. If the window is bound to the sun, a polar night
    /// has only noon.
    ///
    /// # Errors
    /// The errors of [`DayWindow::on`], a step of 0 or one that makes too many instants, or dates without any instant.
    pub fn days(
        place: &Place,
        dates: &[NaiveDate],
        each: EachDay,
        step_secs: u32,
        refraction: bool,
    ) -> Result<SunTrack, SunError> {
        if step_secs == 0 {
            return Err(SunError::ZeroStep);
        }
        // time that the day before has used is not used again
        let is_bound = matches!(
            [&each.from, &each.to].map(|reading| reading.as_ref().map(|reading| reading.time)),
            [None | Some(TimeOfDay::Clock(..) | TimeOfDay::Sunrise(_)), Some(TimeOfDay::Sunset(_))]
                | [Some(TimeOfDay::Sunset(_)), Some(TimeOfDay::Sunrise(_))]
        );
        let found = dates.par_iter().map(|date| DayWindow::on(place, *date, each.from.as_ref(), each.to.as_ref()));
        let found: Vec<DayWindow> = found.collect::<Result<_, _>>()?;
        let mut windows: Vec<[DateTime<Zone>; 2]> = Vec::with_capacity(dates.len());
        let (mut asked, mut window_secs) = (0, 0);
        for DayWindow { day, mut from, to } in found.iter().cloned() {
            if let Some([_, last]) = windows.last()
                && *last > from
            {
                if !is_bound {
                    return Err(SunError::Overlap { date: day.date });
                }
                if *last > to {
                    continue;
                }
                from = *last;
            }
            let seconds = (to - from).num_seconds();
            if seconds == 0 && day.polar != Some(Polar::Night) {
                continue;
            }
            windows.push([from, to]);
            window_secs += seconds;
            asked += seconds / i64::from(step_secs) + 2;
        }
        if asked > MOST_INSTANTS {
            return Err(SunError::TooManyInstants {
                step_secs,
                window_secs,
                instants: asked,
                most: MOST_INSTANTS,
                least_secs: window_secs / (MOST_INSTANTS - 2 * dates.len() as i64).max(1) + 1,
            });
        }
        let track = match (dates.first(), dates.last()) {
            (Some(first), Some(last)) if windows.is_empty() => {
                return Err(SunError::NoWindow { first: *first, last: *last });
            }
            _ => track(place, &windows, step_secs, refraction)?,
        };
        let days = found.into_iter().map(|window| window.day).collect();
        Ok(SunTrack { days, each_day: Some(each), ..track })
    }
}
