//! A study's window: its instants, and the seconds that each represents.

use super::clock::ReadingTime;
use super::day::{light, midnight};
use super::position::{Air, check_year, delta_t_secs};
use super::{Day, Instant, Place, Polar, Reading, Sky, SunError, SunTrack, TimeOfDay, Zone};
use chrono::{DateTime, Datelike, NaiveDate, SubsecRound, TimeDelta};
use rayon::prelude::*;
use std::cmp::Ordering;

/// A step that makes more instants than this is a mistake.
pub(super) const MOST_INSTANTS: i64 = 1_000_000;
/// Ten years: weights and their sums stay far within their integer types.
pub const MOST_DAYS: i64 = 3660;

/// The default precision of times of change on a single day, if the step is longer. For several days the search would
/// take as long as a study by the minute, so the default is to use the instants alone.
const RESOLUTION_SECS: u32 = 60;

/// The requested window of a study: from one reading to another, in steps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Window {
    /// The local date on which it begins; not used if `from` has its own.
    pub date: Option<NaiveDate>,
    /// Its first instant.
    pub from: Reading,
    /// Its last instant; if it is earlier than `from`, on the next day.
    pub to: Reading,
    /// Elapsed seconds between instants.
    pub step_secs: u32,
}

impl Window {
    /// Returns its first and last instant at a place.
    ///
    /// From a sunrise to a sunset it is the light of the date; without light both are noon. If it is bound to an event
    /// that does not happen, it begins or ends with the day's light, and both ends may be the same instant. From a
    /// clock time to the sunset, or from the sunrise to a clock time, it never extends to the next day.
    ///
    /// # Errors
    /// No date, two dates, readings that are not instants, or a window that is empty or ends before it begins.
    pub fn bounds(&self, place: &Place) -> Result<[DateTime<Zone>; 2], SunError> {
        let date = date_of(&self.from, self.date)?;
        if let Some([from, to]) = self.light(place, date)?
            && (from < to || from == to && Day::of(place, date)?.sunrise.is_none())
        {
            return Ok([from, to]);
        }
        let from = self.begin(place)?;
        if let Some(to) = self.within_day(place, date)? {
            return Ok([from, to.max(from)]);
        }
        if self.to.date.is_some() {
            let when = self.to.when(place, date)?;
            let may_be_empty = matches!(when, ReadingTime::Instead(..));
            let to = self.to.bound(place, date)?;
            return match to.cmp(&from) {
                Ordering::Less => Err(SunError::Backwards { from, to }),
                Ordering::Equal if !may_be_empty => Err(self.empty(date)),
                _ => Ok([from, to]),
            };
        }
        match self.to.when(place, date)? {
            ReadingTime::At(to) if to > from => return Ok([from, to]),
            ReadingTime::At(to) if to == from => return Err(self.empty(date)),
            ReadingTime::Instead(to, _) if to >= from => return Ok([from, to]),
            // an hour that clocks skip or repeat matters only if the window ends in it
            ReadingTime::Not(meant, error) if meant.iter().any(|to| *to >= from) => return Err(error),
            ReadingTime::At(_) | ReadingTime::Instead(..) | ReadingTime::Not(..) => {}
        }
        let next = date.succ_opt().unwrap_or(date);
        match self.to.when(place, next)? {
            ReadingTime::At(to) if to > from => Ok([from, to]),
            ReadingTime::At(to) => Err(SunError::Backwards { from, to }),
            // the next day's light belongs to the next day
            ReadingTime::Instead(..) => Ok([from, midnight(place, next).max(from)]),
            ReadingTime::Not(_, error) => Err(error),
        }
    }

    /// Returns its first instant, as [`Window::bounds`] does unless the window is the light of a date.
    ///
    /// # Errors
    /// No date, two dates, or a reading that is not an instant.
    pub fn begin(&self, place: &Place) -> Result<DateTime<Zone>, SunError> {
        self.from.bound(place, date_of(&self.from, self.date)?)
    }

    /// The end of a window that never extends to the next day's sun: from a clock time to the sunset, or from the
    /// sunrise to a clock time. It is before the beginning if the window is empty.
    pub(super) fn within_day(&self, place: &Place, date: NaiveDate) -> Result<Option<DateTime<Zone>>, SunError> {
        let ends = match (self.from.time, self.to.time) {
            (TimeOfDay::Clock(..), TimeOfDay::Sunset(_)) | (TimeOfDay::Sunrise(_), TimeOfDay::Clock(..)) => true,
            (TimeOfDay::Clock(..) | TimeOfDay::Sunrise(_) | TimeOfDay::Sunset(_), _) => false,
        };
        let ends = ends && self.to.date.is_none();
        ends.then(|| self.to.bound(place, date)).transpose()
    }

    /// Why the window is empty on a day.
    fn why_nothing(&self, day: &Day) -> &'static str {
        match (self.from.time, self.to.time) {
            (TimeOfDay::Clock(..), TimeOfDay::Sunset(_)) => "the sun has set by then",
            (TimeOfDay::Sunrise(_), TimeOfDay::Clock(..)) => "the sun rises later",
            _ => day.why_absent(),
        }
    }

    /// The light of a date with both ends shifted as written, if the window is from sunrise to sunset. Twice noon if
    /// the date has no light.
    pub(super) fn light(&self, place: &Place, date: NaiveDate) -> Result<Option<[DateTime<Zone>; 2]>, SunError> {
        let (TimeOfDay::Sunrise(after), TimeOfDay::Sunset(later)) = (self.from.time, self.to.time) else {
            return Ok(None);
        };
        if self.to.date.is_some_and(|own| own != date) {
            return Ok(None);
        }
        Ok(Some(match light(place, date)? {
            Some([begin, end]) => [begin.shifted(after), end.shifted(later)],
            None => [Day::of(place, date)?.noon.unwrap_or_else(|| midnight(place, date)); 2],
        }))
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

/// The date of a reading.
fn date_of(reading: &Reading, date: Option<NaiveDate>) -> Result<NaiveDate, SunError> {
    match (reading.date, date) {
        (Some(own), Some(date)) if own != date => Err(SunError::TwoDates { reading: reading.to_string(), date }),
        (Some(date), _) | (None, Some(date)) => Ok(date),
        (None, None) => Err(SunError::NoDate { reading: reading.to_string() }),
    }
}

impl SunTrack {
    /// Returns the instants of a window: from, from + step, …, and always `to`.
    ///
    /// Weights are those of the trapezoid rule in whole seconds; they add up to the window's length. An interval with a
    /// sunrise or sunset is split there: its daylight counts for the instant by day, the rest for the night. If the sun
    /// rises or sets several times between two instants, an instant is added in each stretch between.
    ///
    /// If the window is bound to the sun, its only instant in a polar night is noon.
    ///
    /// # Errors
    /// The errors of [`Window::bounds`], a step of 0 or one that makes too many instants, and a year outside 1600 to
    /// 2999.
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
        let date = date_of(&window.from, window.date)?;
        let day = Day::of(place, date)?;
        if from == to && day.polar != Some(Polar::Night) {
            let why = window.why_nothing(&day);
            let [from, to] = [&window.from, &window.to].map(Reading::to_string);
            return Err(SunError::NothingAsked { from, to, date, why });
        }
        track(place, &[[from, to]], window.step_secs, refraction)
    }

    /// A track with a single instant in whole seconds, with weight and step 0.
    ///
    /// # Errors
    /// A year outside 1600 to 2999.
    pub fn of_instant(place: &Place, time: DateTime<Zone>, refraction: bool) -> Result<SunTrack, SunError> {
        track(place, &[[time.trunc_subsecs(0); 2]], 0, refraction)
    }

    /// A track with a single instant, with weight and step 0. A reading without a date uses `date`.
    ///
    /// # Errors
    /// No date or two dates, a reading that is not an instant, or a year outside 1600 to 2999.
    pub fn at(
        place: &Place,
        reading: &Reading,
        date: Option<NaiveDate>,
        refraction: bool,
    ) -> Result<SunTrack, SunError> {
        let time = reading.at(place, date_of(reading, date)?)?;
        track(place, &[[time; 2]], 0, refraction)
    }
}

/// The times from a window's first instant in steps to its last.
fn times([from, to]: [DateTime<Zone>; 2], step_secs: u32) -> Vec<DateTime<Zone>> {
    let (seconds, step) = ((to - from).num_seconds(), i64::from(step_secs.max(1)));
    let mut times: Vec<_> = (0..=seconds / step).map(|index| from + TimeDelta::seconds(index * step)).collect();
    if seconds % step != 0 {
        times.push(to);
    }
    times
}

/// A window's instants with their weights in whole seconds. Two instants share the time between them, and a half second
/// goes to the later one. If the sun rises or sets between them, each gets the time that matches it: day or night.
fn instants(sky: &Sky<'_>, window: [DateTime<Zone>; 2], step_secs: u32) -> Result<Vec<Instant>, SunError> {
    // fits: a window is at most ten years, 3.2e8 s
    let secs = |from: DateTime<Zone>, to: DateTime<Zone>| u32::try_from((to - from).num_seconds()).unwrap_or(0);
    let times = times(window, step_secs);
    let mut instants = times.par_iter().map(|time| sky.at(*time)).collect::<Result<Vec<_>, _>>()?;
    let cuts = instants.par_windows(2).map(|pair| sky.cut(&pair[0], &pair[1])).collect::<Result<Vec<_>, _>>()?;
    let mut added = Vec::new();
    for (index, cut) in cuts.into_iter().enumerate() {
        let [before, after] = [times[index], times[index + 1]];
        let gap = secs(before, after);
        let [of_before, of_after] = match &cut {
            Some(cut) => [secs(before, cut.first), secs(cut.last, after)],
            None => [gap / 2, gap - gap / 2],
        };
        instants[index].weight_secs += of_before;
        instants[index + 1].weight_secs += of_after;
        if cut.is_none() && !instants[index].night {
            instants[index + 1].gap_secs = gap;
        }
        added.extend(cut.into_iter().flat_map(|cut| cut.between));
    }
    if !added.is_empty() {
        instants.append(&mut added);
        instants.sort_by_key(|instant| instant.time);
    }
    Ok(instants)
}

/// Joins the instants of consecutive windows. If one ends when the next begins, they share the instant.
pub(super) fn track(
    place: &Place,
    windows: &[[DateTime<Zone>; 2]],
    step_secs: u32,
    refraction: bool,
) -> Result<SunTrack, SunError> {
    let (Some([first, _]), Some([_, last])) = (windows.first(), windows.last()) else {
        return Err(SunError::ZeroStep);
    };
    let delta_t_secs = delta_t_secs(first.to_utc())?;
    check_year(last.year())?;
    let sky = Sky { place, delta_t_secs, air: refraction.then(|| Air::standard(place.elevation_m)) };
    let of_windows = windows.par_iter().map(|window| instants(&sky, *window, step_secs));
    let of_windows: Vec<_> = of_windows.collect::<Result<_, SunError>>()?;
    let joined = of_windows.into_iter().reduce(|mut all, next| {
        let mut next = next.into_iter().peekable();
        if let Some(last) = all.last_mut()
            && let Some(same) = next.next_if(|first| first.time == last.time)
        {
            last.weight_secs += same.weight_secs;
        }
        all.extend(next);
        all
    });
    let days = first
        .date_naive()
        .iter_days()
        .take_while(|date| *date <= last.date_naive())
        .collect::<Vec<_>>()
        .into_par_iter()
        .map(|date| Day::of(place, date))
        .collect::<Result<_, _>>()?;
    let instants = joined.unwrap_or_default();
    Ok(SunTrack {
        instants,
        days,
        each_day: None,
        step_secs,
        resolution_secs: if windows.len() == 1 { step_secs.min(RESOLUTION_SECS) } else { 0 },
        refraction,
        delta_t_secs,
    })
}
