//! The lines of a sun-path chart: the sun's ways on days of a year, and its positions at each hour of the clock and of
//! the sundial. All of them show the sun as it is seen, above the horizon.

use super::{Interval, SunDay, SunPath};
use crate::sun::{Air, DayWindow, Place, Sky, SunError, Zone, delta_t_secs, true_solar};
use chrono::{DateTime, Datelike, Days, NaiveDate, NaiveTime, TimeDelta, TimeZone, Timelike};
use glam::DVec3;

/// The lines that all points of a place share.
#[derive(Clone, Debug)]
pub struct SkyLines {
    /// The year.
    pub year: i32,
    /// The ways on the 21st of each month; a way has no run if the sun stays down.
    pub months: Vec<DayWay>,
    /// The sun's positions when the local clock shows a whole hour: figures of eight, which break off where clocks are
    /// put forward or back.
    pub clock_hours: Vec<HourLine>,
    /// The sun's positions when a sundial shows a whole hour, from June to December; in the other half of the year the
    /// lines are the same.
    pub solar_hours: Vec<HourLine>,
}

/// The sun's way on a day.
#[derive(Clone, Debug)]
pub struct DayWay {
    /// The day.
    pub date: NaiveDate,
    /// Directions in the order of time, in several runs if the sun sets in between.
    pub runs: Vec<Vec<DVec3>>,
}

/// The sun's way on a requested day, with the part of it that a probe sees.
#[derive(Clone, Debug)]
pub struct ProbeWay {
    /// The whole requested part with the sun up.
    pub way: DayWay,
    /// Each interval of the probe.
    pub intervals: Vec<Interval>,
    /// The way during each interval, from its start to its end.
    pub lit: Vec<Vec<DVec3>>,
}

/// The sun's positions at an hour, over the days.
#[derive(Clone, Debug)]
pub struct HourLine {
    /// 0 to 23.
    pub hour: u32,
    /// Days in their order, each with the direction, in several runs if the line leaves the sky or the clock is
    /// changed.
    pub runs: Vec<Vec<(NaiveDate, DVec3)>>,
}

/// The greatest time between two points of a way, seconds: one degree of the sky.
const STEP_SECS: i64 = 240;
/// The number of days between two points of an hour's line.
const DAYS_APART: u64 = 5;

impl SkyLines {
    /// The lines of a year.
    ///
    /// # Errors
    /// A year outside 1600 to 2999.
    pub fn of_year(place: &Place, year: i32, air: Option<Air>) -> Result<SkyLines, SunError> {
        let middle = NaiveDate::from_ymd_opt(year, 7, 1).unwrap_or_default();
        // one value for the whole year: within it ΔT changes by less than 10 s, in which the sun moves among the stars as far
        // as it does across the sky in 0.03 s
        let delta_t_secs = delta_t_secs(middle.and_time(NaiveTime::MIN).and_utc())?;
        let sky = Sky { place, delta_t_secs, air };
        let months = (1..=12).filter_map(|month| NaiveDate::from_ymd_opt(year, month, 21));
        let months = months.map(|date| month_way(place, date, air)).collect::<Result<_, _>>()?;
        Ok(SkyLines {
            year,
            months,
            clock_hours: (0..24).map(|hour| clock_hour(&sky, year, hour)).collect::<Result<_, _>>()?,
            solar_hours: (0..24).map(|hour| solar_hour(&sky, year, hour)).collect::<Result<_, _>>()?,
        })
    }
}

impl ProbeWay {
    /// The sun's way on a searched day, and during a probe's intervals on it.
    ///
    /// # Errors
    /// A year outside 1600 to 2999.
    pub fn of(place: &Place, day: &SunDay, found: &[Interval], air: Option<Air>) -> Result<ProbeWay, SunError> {
        let between = |interval: &Interval| between(place, [interval.start, interval.end], air);
        Ok(ProbeWay {
            way: DayWay { date: day.window.day.date, runs: day.up.iter().map(between).collect::<Result<_, _>>()? },
            intervals: found.to_vec(),
            lit: found.iter().map(between).collect::<Result<_, _>>()?,
        })
    }
}

fn month_way(place: &Place, date: NaiveDate, air: Option<Air>) -> Result<DayWay, SunError> {
    let window = DayWindow::on(place, date, None, None)?;
    let up = SunPath::new(place, &window, air)?.up;
    let runs = up.iter().map(|interval| between(place, [interval.start, interval.end], air));
    Ok(DayWay { date, runs: runs.collect::<Result<_, _>>()? })
}

/// Directions from one time to another.
fn between(place: &Place, [from, to]: [DateTime<Zone>; 2], air: Option<Air>) -> Result<Vec<DVec3>, SunError> {
    let sky = Sky { place, delta_t_secs: delta_t_secs(from.to_utc())?, air };
    let secs = (to - from).num_seconds().max(0);
    let count = (secs + STEP_SECS - 1) / STEP_SECS;
    let at = |index: i64| Ok(sky.at(from + TimeDelta::seconds(secs * index / count.max(1)))?.to_sun);
    (0..=count).map(at).collect()
}

/// The line of an hour of the clock over a year.
fn clock_hour(sky: &Sky<'_>, year: i32, hour: u32) -> Result<HourLine, SunError> {
    let Some(first) = NaiveDate::from_ymd_opt(year, 1, 1) else { return Ok(HourLine { hour, runs: Vec::new() }) };
    let dates = first.iter_days().take_while(|date| date.year() == year);
    let time = |date: NaiveDate| {
        // if the clock shows the hour twice, the first time
        sky.place.time_zone.from_local_datetime(&date.and_time(NaiveTime::from_hms_opt(hour, 0, 0)?)).earliest()
    };
    let all: Vec<(NaiveDate, Option<DateTime<Zone>>)> = dates.map(|date| (date, time(date))).collect();
    // days with the same offset have the hour at the same time of UTC
    let of_day = |time: DateTime<Zone>| i64::from(time.to_utc().num_seconds_from_midnight());
    let mut runs: Vec<Vec<(NaiveDate, DVec3)>> = Vec::new();
    let mut run: Vec<(NaiveDate, DVec3)> = Vec::new();
    let mut last = None;
    for (index, (date, time)) in all.iter().enumerate() {
        let utc = time.map(of_day);
        if utc != last {
            runs.extend(above_horizon(&std::mem::take(&mut run)));
        }
        last = utc;
        let Some(time) = *time else { continue };
        let goes_on = all.get(index + 1).is_some_and(|(_, next)| next.map(of_day) == utc);
        if run.is_empty() || !goes_on || (date.ordinal0() as u64).is_multiple_of(DAYS_APART) || is_solstice(*date) {
            run.push((*date, sky.at(time)?.to_sun));
        }
    }
    runs.extend(above_horizon(&run));
    Ok(HourLine { hour, runs })
}

/// Whether an hour has its number on that day.
fn is_solstice(date: NaiveDate) -> bool {
    date.day() == 21 && matches!(date.month(), 6 | 12)
}

/// The line of an hour of the sundial, from 21 June to 21 December.
fn solar_hour(sky: &Sky<'_>, year: i32, hour: u32) -> Result<HourLine, SunError> {
    let ends = [6, 12].map(|month| NaiveDate::from_ymd_opt(year, month, 21));
    let [Some(first), Some(last)] = ends else { return Ok(HourLine { hour, runs: Vec::new() }) };
    let mut dates: Vec<NaiveDate> = Vec::new();
    let mut date = first;
    while date < last {
        dates.push(date);
        date = date.checked_add_days(Days::new(2 * DAYS_APART)).unwrap_or(last);
    }
    dates.push(last);
    let mut run = Vec::new();
    for date in dates {
        if let Some(time) = true_solar(sky.place, date, i64::from(hour) * 3600)? {
            run.push((date, sky.at(time)?.to_sun));
        }
    }
    Ok(HourLine { hour, runs: above_horizon(&run) })
}

/// The parts of a line above the horizon, each of which ends on the horizon if the line crosses it there.
fn above_horizon(line: &[(NaiveDate, DVec3)]) -> Vec<Vec<(NaiveDate, DVec3)>> {
    let mut runs: Vec<Vec<(NaiveDate, DVec3)>> = Vec::new();
    let mut run: Vec<(NaiveDate, DVec3)> = Vec::new();
    for (index, &(date, to)) in line.iter().enumerate() {
        let before = index.checked_sub(1).map(|before| line[before].1);
        let crossing = before.filter(|before| (before.z < 0.0) != (to.z < 0.0)).map(|before| {
            let share = before.z / (before.z - to.z);
            before.lerp(to, share).with_z(0.0).normalize_or(to)
        });
        run.extend(crossing.map(|at| (date, at)));
        if to.z >= 0.0 {
            run.push((date, to));
        } else if !run.is_empty() {
            runs.push(std::mem::take(&mut run));
        }
    }
    runs.push(run);
    runs.retain(|run| run.len() > 1);
    runs
}
