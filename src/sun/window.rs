//! A study's window: its instants and how many seconds each stands for.

use super::clock::When;
use super::position::{Air, check_year, delta_t_secs};
use super::{Day, Instant, Place, Reading, SunError, SunTrack, Zone};
use chrono::{DateTime, Datelike, NaiveDate, TimeDelta, Utc};
use rayon::prelude::*;

/// Beyond this a step is a slip of the pen.
pub(super) const MOST_INSTANTS: i64 = 1_000_000;
/// Ten years: weights and their sums stay far inside their integers.
pub const MOST_DAYS: i64 = 3660;

/// The window of a study as asked: from one reading to another, in steps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Window {
    /// The local date on which it begins; not needed where `from` has its own.
    pub date: Option<NaiveDate>,
    /// Its first instant.
    pub from: Reading,
    /// Its last instant; where it is earlier than `from`, on the next day.
    pub to: Reading,
    /// Elapsed seconds between instants.
    pub step_secs: u32,
}

impl Window {
    /// Its first and last instant at a place.
    ///
    /// # Errors
    /// No date, two dates, readings that are no instants, or a window that is empty or runs backwards.
    pub fn bounds(&self, place: &Place) -> Result<[DateTime<Zone>; 2], SunError> {
        let date = date_of(&self.from, self.date)?;
        let from = self.from.at(place, date)?;
        if self.to.date.is_some() {
            let to = self.to.at(place, date)?;
            return match to.cmp(&from) {
                std::cmp::Ordering::Less => Err(SunError::Backwards { from, to }),
                std::cmp::Ordering::Equal => Err(self.empty(date)),
                std::cmp::Ordering::Greater => Ok([from, to]),
            };
        }
        match self.to.when(place, date)? {
            When::At(to) if to > from => return Ok([from, to]),
            When::At(to) if to == from => return Err(self.empty(date)),
            // The hour that clocks skip or repeat matters only where the window ends in it.
            When::Not(meant, error) if meant.iter().any(|to| *to >= from) => return Err(error),
            When::At(_) | When::Not(..) => {}
        }
        let next = date.succ_opt().unwrap_or(date);
        let to = self.to.at(place, next)?;
        if to > from { Ok([from, to]) } else { Err(SunError::Backwards { from, to }) }
    }

    fn empty(&self, date: NaiveDate) -> SunError {
        let next = date.succ_opt().unwrap_or(date);
        let plain = self.to.date.is_none();
        SunError::EmptyWindow {
            from: self.from.to_string(),
            to: self.to.to_string(),
            example: if plain { format!("{next}T{}", self.to) } else { format!("{next}T12:00") },
        }
    }
}

/// The date on which a reading lies.
fn date_of(reading: &Reading, date: Option<NaiveDate>) -> Result<NaiveDate, SunError> {
    match (reading.date, date) {
        (Some(own), Some(date)) if own != date => Err(SunError::TwoDates { reading: reading.to_string(), date }),
        (Some(date), _) | (None, Some(date)) => Ok(date),
        (None, None) => Err(SunError::NoDate { reading: reading.to_string() }),
    }
}

impl SunTrack {
    /// The instants of a window: from, from + step, …, to, which is added where the last step misses it.
    ///
    /// Weights are the trapezoid rule's in whole seconds; they add up to the window.
    ///
    /// # Errors
    /// What [`Window::bounds`] says, a step of 0 or one that makes too many instants,
    /// and a year outside 1600 to 2999.
    pub fn window(place: &Place, window: &Window, refraction: bool) -> Result<SunTrack, SunError> {
        if window.step_secs == 0 {
            return Err(SunError::ZeroStep);
        }
        let [from, to] = window.bounds(place)?;
        let seconds = (to - from).num_seconds();
        if seconds > MOST_DAYS * 86_400 {
            return Err(SunError::WindowTooLong { days: seconds / 86_400, most: MOST_DAYS });
        }
        let step = i64::from(window.step_secs);
        let instants = seconds / step + 1 + i64::from(seconds % step != 0);
        if instants > MOST_INSTANTS {
            return Err(SunError::TooManyInstants {
                step_secs: window.step_secs,
                window_secs: seconds,
                instants,
                most: MOST_INSTANTS,
                least_secs: (seconds + MOST_INSTANTS - 2) / (MOST_INSTANTS - 1),
            });
        }
        let elapsed = elapsed_secs(seconds, window.step_secs);
        let times: Vec<_> = elapsed.iter().map(|elapsed| from + TimeDelta::seconds(*elapsed)).collect();
        let weights = weights_secs(&elapsed);
        track(place, &times, &weights, window.step_secs, refraction)
    }

    /// One instant alone, of weight and step 0. A reading without a date takes `date`.
    ///
    /// # Errors
    /// No date or two, a reading that is no instant, a year outside 1600 to 2999.
    pub fn at(
        place: &Place,
        reading: &Reading,
        date: Option<NaiveDate>,
        refraction: bool,
    ) -> Result<SunTrack, SunError> {
        let time = reading.at(place, date_of(reading, date)?)?;
        track(place, &[time], &[0], 0, refraction)
    }
}

/// 0, step, …, and the window's end.
pub(super) fn elapsed_secs(window_secs: i64, step_secs: u32) -> Vec<i64> {
    let step = i64::from(step_secs);
    let mut elapsed: Vec<i64> = (0..=window_secs / step).map(|index| index * step).collect();
    if window_secs % step != 0 {
        elapsed.push(window_secs);
    }
    elapsed
}

/// The trapezoid rule in whole seconds: each gap between instants is shared by its two ends,
/// and a half second goes to the later one. `elapsed_secs` increases.
pub(super) fn weights_secs(elapsed_secs: &[i64]) -> Vec<u32> {
    let mut weights = vec![0_u32; elapsed_secs.len()];
    for (index, pair) in elapsed_secs.windows(2).enumerate() {
        // A window is at most ten years, 3.2e8 s.
        let gap = u32::try_from(pair[1] - pair[0]).unwrap_or(0);
        weights[index] += gap / 2;
        weights[index + 1] += gap - gap / 2;
    }
    weights
}

pub(super) fn track(
    place: &Place,
    times: &[DateTime<Zone>],
    weights: &[u32],
    step_secs: u32,
    refraction: bool,
) -> Result<SunTrack, SunError> {
    let (Some(first), Some(last)) = (times.first(), times.last()) else {
        return Err(SunError::ZeroStep);
    };
    let delta_t_secs = delta_t_secs(first.with_timezone(&Utc))?;
    check_year(last.year())?;
    let air = refraction.then(|| Air::standard(place.elevation_m));
    let instants = times
        .par_iter()
        .zip(weights)
        .map(|(time, weight_secs)| Instant::at(place, *time, *weight_secs, delta_t_secs, air))
        .collect::<Result<Vec<_>, SunError>>()?;
    let days = first
        .date_naive()
        .iter_days()
        .take_while(|date| *date <= last.date_naive())
        .collect::<Vec<_>>()
        .into_par_iter()
        .map(|date| Day::of(place, date))
        .collect::<Result<_, _>>()?;
    Ok(SunTrack { instants, days, each_day: None, step_secs, refraction, delta_t_secs })
}
