//! The instants of a window on each of several days.

use super::window::{MOST_INSTANTS, elapsed_secs, track, weights_secs};
use super::{DayWindow, Place, Reading, SunError, SunTrack, Zone};
use chrono::{DateTime, NaiveDate, TimeDelta};

/// The part of each day that a study of several days asks, as written; the whole day where nothing is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EachDay {
    /// Its beginning.
    pub from: Option<Reading>,
    /// Its end.
    pub to: Option<Reading>,
}

impl SunTrack {
    /// The instants of a window on each of some dates, which follow one another: as a window's of its own, one day after
    /// the other, and with the same weights. Where a day's window ends as the next begins, the instant between them is one.
    ///
    /// Where `sunrise+…` is later than `sunset-…` a day has none.
    ///
    /// # Errors
    /// What [`DayWindow::on`] says, a step of 0 or one that makes too many instants, dates without an instant at all.
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
        let mut times: Vec<DateTime<Zone>> = Vec::new();
        let mut weights: Vec<u32> = Vec::new();
        let mut days = Vec::with_capacity(dates.len());
        let (mut asked, mut window_secs) = (0, 0);
        for date in dates {
            let DayWindow { day, from, to } = DayWindow::on(place, *date, each.from.as_ref(), each.to.as_ref())?;
            days.push(day);
            let seconds = (to - from).num_seconds();
            if seconds == 0 {
                continue;
            }
            if times.last().is_some_and(|last| *last > from) {
                return Err(SunError::Overlap { date: *date });
            }
            window_secs += seconds;
            asked += seconds / i64::from(step_secs) + 2;
            if asked > MOST_INSTANTS {
                continue;
            }
            let elapsed = elapsed_secs(seconds, step_secs);
            let mut of_day = weights_secs(&elapsed).into_iter();
            if times.last() == Some(&from)
                && let (Some(last), Some(first)) = (weights.last_mut(), of_day.next())
            {
                *last += first;
            } else {
                times.push(from);
                weights.extend(of_day.next());
            }
            times.extend(elapsed[1..].iter().map(|elapsed| from + TimeDelta::seconds(*elapsed)));
            weights.extend(of_day);
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
        let mut track = match (dates.first(), dates.last()) {
            (Some(first), Some(last)) if times.is_empty() => {
                return Err(SunError::NoWindow { first: *first, last: *last });
            }
            _ => track(place, &times, &weights, step_secs, refraction)?,
        };
        track.days = days;
        track.each_day = Some(each);
        Ok(track)
    }
}
