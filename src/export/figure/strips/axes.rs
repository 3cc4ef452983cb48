//! The chart's axes: whole hours of the local clock across, and the days that have a line and a label.

use crate::sun::Zone;
use crate::sunlight::SunDay;
use chrono::{DateTime, Datelike, NaiveDate, NaiveTime};

/// The hours of the horizontal axis, counted from midnight at the start of the local date; beyond 24 on the next day.
pub(super) struct HourAxis {
    pub(super) first: i64,
    pub(super) last: i64,
}

impl HourAxis {
    /// The whole hours that enclose sunrise, sunset and all time with sun on the given days.
    pub(super) fn of(days: &[SunDay]) -> HourAxis {
        let times = |day: &SunDay| {
            let of_day = [day.window.day.sunrise, day.window.day.sunset].into_iter().flatten();
            let up = day.up.iter().flat_map(|up| [up.start, up.end]);
            of_day.chain(up).map(|time| clock_secs(day, time)).collect::<Vec<_>>()
        };
        let times: Vec<i64> = days.iter().flat_map(times).collect();
        let (Some(low), Some(high)) = (times.iter().min(), times.iter().max()) else {
            return HourAxis { first: 0, last: 24 };
        };
        let first = low.div_euclid(3600);
        HourAxis { first, last: (high + 3599).div_euclid(3600).max(first + 1) }
    }

    /// The position of a time in seconds after midnight: 0 at the left, 1 at the right.
    pub(super) fn at(&self, secs: i64) -> f64 {
        (secs - self.first * 3600) as f64 / ((self.last - self.first) * 3600) as f64
    }

    /// The position of a time on a day by the local clock, even if the clock is put forward or back in between.
    pub(super) fn of_time(&self, day: &SunDay, time: DateTime<Zone>) -> f64 {
        self.at(clock_secs(day, time))
    }
}

/// The reading of the local clock, in seconds after the midnight that begins the date.
fn clock_secs(day: &SunDay, time: DateTime<Zone>) -> i64 {
    (time.naive_local() - day.window.day.date.and_time(NaiveTime::MIN)).num_seconds()
}

/// A day that has a line above it and a label.
pub(super) struct Tick {
    /// The index of the day.
    pub(super) row: usize,
    pub(super) label: String,
    /// Whether the label stands in the middle of the day's own row, or below its line.
    pub(super) within: bool,
}

/// The least distance between labels, page pixels.
const PITCH: f64 = 42.0;

/// Every day, every seventh, or the first days of months, quarters or years, depending on the height of a row.
pub(super) fn ticks(days: &[NaiveDate], row: f64) -> Vec<Tick> {
    let each = |begins: &dyn Fn(usize, NaiveDate) -> bool, format: &dyn Fn(NaiveDate) -> &'static str| -> Vec<Tick> {
        let room = |at: usize| (days.len() - at) as f64 * row >= PITCH - 8.0;
        let begin = days.iter().enumerate().filter(|(at, date)| begins(*at, **date) && (row >= PITCH || room(*at)));
        let label = |date: NaiveDate| date.format(format(date)).to_string();
        begin.map(|(row_of, date)| Tick { row: row_of, label: label(*date), within: row >= PITCH }).collect()
    };
    let of_month =
        |months: u32| move |_: usize, date: NaiveDate| date.day() == 1 && date.month0().is_multiple_of(months);
    let by_month = |date: NaiveDate| if date.month() == 1 { "%b %Y" } else { "%b" };
    let mut ticks = match row {
        row if row >= PITCH => each(&|_, _| true, &|_| "%-d %b"),
        row if 7.0 * row >= PITCH => each(&|at, _| at % 7 == 0, &|_| "%-d %b"),
        row if 28.0 * row >= PITCH => each(&of_month(1), &by_month),
        row if 90.0 * row >= PITCH => each(&of_month(3), &by_month),
        _ => each(&|_, date| date.ordinal() == 1, &|_| "%Y"),
    };
    // the first day, unless another label is in the way
    if let Some(first) = days.first()
        && ticks.first().is_none_or(|tick| tick.row as f64 * row >= PITCH)
    {
        let label = first.format(if 90.0 * row >= PITCH { "%-d %b" } else { "%Y" }).to_string();
        ticks.insert(0, Tick { row: 0, label, within: false });
    }
    ticks
}
