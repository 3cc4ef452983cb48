//! How long probes are in the sun per day, month and year, as CSV.

use super::names::field;
use crate::sunlight::{Interval, ProbeIntervals, Sunlight, longest, secs};
use chrono::Datelike;
use std::fmt::Write;

/// The totals of `gnomon probe`: for each probe a line per day, then one per month, then one per year, each over the
/// requested days: `probe,unit,date,days,seconds,longest_seconds,intervals`. The unit is `day`, `month` or `year`; the
/// date has the precision of the unit (2026-03-21, 2026-03, 2026); `days` is the number of days in the sum.
pub fn totals(sunlight: &Sunlight) -> String {
    let mut text = "probe,unit,date,days,seconds,longest_seconds,intervals\r\n".to_owned();
    for probed in &sunlight.probes {
        of_probe(sunlight, probed, &mut text);
    }
    text
}

fn of_probe(sunlight: &Sunlight, probed: &ProbeIntervals, text: &mut String) {
    let name = field(&probed.probe.name);
    let units: [(&str, usize); 3] = [("day", 10), ("month", 7), ("year", 4)];
    for (unit, letters) in units {
        let dated = sunlight.days.iter().zip(&probed.days).map(|(day, found)| {
            let date = day.window.day.date;
            let mut date = format!("{:04}-{:02}-{:02}", date.year(), date.month(), date.day());
            date.truncate(letters);
            (date, found)
        });
        let dated: Vec<(String, &Vec<Interval>)> = dated.collect();
        for same in dated.chunk_by(|one, other| one.0 == other.0) {
            let intervals = || same.iter().flat_map(|(_, found)| found.iter());
            let seconds: i64 = same.iter().map(|(_, found)| secs(found)).sum();
            let longest = longest(intervals()).map_or(0, Interval::secs);
            // Writing to a String cannot fail.
            let _ = write!(
                text,
                "{name},{unit},{},{},{seconds},{longest},{}\r\n",
                same[0].0,
                same.len(),
                intervals().count()
            );
        }
    }
}
