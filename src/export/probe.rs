//! The result of `gnomon probe`: tables, JSON, and a CSV file with one line per interval.

use super::names::{field, plain};
use super::report::{GroundReport, PlaceReport, ground_report, place_report, stamp, tz_version};
use super::{ExportError, report};
use crate::message::{Message, Words};
use crate::site::{Ground, metres};
use crate::sun::{Place, Polar, Zone};
use crate::sunlight::{Interval, ProbeIntervals, SunDay, Sunlight, longest, secs};
use crate::view::Probe;
use chrono::{DateTime, NaiveDate};
use glam::DVec3;
use serde::Serialize;
use std::fmt::Write;

#[derive(Serialize)]
struct SunlightReport<'a> {
    gnomon: &'static str,
    place: PlaceReport<'a>,
    tz_version: String,
    #[serde(flatten)]
    ground: GroundReport,
    refraction: bool,
    probes: Vec<ProbeReport<'a>>,
    shortest_found_secs: u32,
    notes: Vec<String>,
}

#[derive(Serialize)]
struct ProbeReport<'a> {
    name: &'a str,
    point: [f64; 3],
    normal: Option<[f64; 3]>,
    below_ground_m: Option<f64>,
    days: Vec<ProbeDayReport>,
    seconds: i64,
    longest_seconds: i64,
}

#[derive(Serialize)]
struct ProbeDayReport {
    date: String,
    sunrise: Option<String>,
    sunset: Option<String>,
    seconds: i64,
    longest_seconds: i64,
    intervals: Vec<IntervalReport>,
}

#[derive(Serialize)]
struct IntervalReport {
    start: String,
    end: String,
    seconds: i64,
    blocked_before: String,
    blocked_after: String,
}

/// The JSON of `gnomon probe`: `gnomon`, `place`, `tz_version`, the ground and `refraction` as in `profile.json`, then
///
/// - `probes`: for each probe its `name`, its `point` in metres, its `normal` (of length 1, or null), how far it lies
///   below the ground (`below_ground_m`, null if it does not), and its `days`: each with `date`, `sunrise` and `sunset`
///   (null if there is none), and `intervals`: the first second in sunlight (`start`), the first second after it
///   (`end`), the `seconds` between them, and what blocks the sun one second before the start and at the end
///   (`blocked_before`, `blocked_after`): the nearest component, `horizon` (the sun is down), `behind` (the sun is behind
///   the probe's own plane) or `window` (the requested time begins or ends there);
/// - for each day and each probe the `seconds` in sunlight, and those of the longest interval (`longest_seconds`);
/// - `shortest_found_secs`: 1, since every second is decided and nothing between two seconds is missed;
/// - `notes` as in `profile.json`.
///
/// # Errors
/// [`ExportError::Encode`] if the encoder fails.
pub fn json(
    sunlight: &Sunlight,
    place: &Place,
    ground: &Ground,
    (notes, words): (&[Message], &dyn Words),
) -> Result<String, ExportError> {
    let day = |(day, intervals): (&SunDay, &Vec<Interval>)| ProbeDayReport {
        date: day.window.day.date.to_string(),
        sunrise: day.window.day.sunrise.as_ref().map(stamp),
        sunset: day.window.day.sunset.as_ref().map(stamp),
        seconds: secs(intervals),
        longest_seconds: longest(intervals).map_or(0, Interval::secs),
        intervals: intervals.iter().map(|interval| interval_report(sunlight, interval)).collect(),
    };
    report::json(&SunlightReport {
        gnomon: env!("CARGO_PKG_VERSION"),
        place: place_report(place),
        tz_version: tz_version(place),
        ground: ground_report(ground),
        refraction: sunlight.refraction,
        probes: sunlight
            .probes
            .iter()
            .map(|probed| ProbeReport {
                name: &probed.probe.name,
                point: probed.probe.point.to_array(),
                normal: probed.probe.normal.map(|normal| normal.to_array()),
                below_ground_m: probed.below_ground_m,
                days: sunlight.days.iter().zip(&probed.days).map(day).collect(),
                seconds: probed.secs(),
                longest_seconds: probed.longest().map_or(0, Interval::secs),
            })
            .collect(),
        shortest_found_secs: 1,
        notes: report::said(notes, words),
    })
}

fn interval_report(sunlight: &Sunlight, interval: &Interval) -> IntervalReport {
    IntervalReport {
        start: stamp(&interval.start),
        end: stamp(&interval.end),
        seconds: interval.secs(),
        blocked_before: sunlight.name(interval.before),
        blocked_after: sunlight.name(interval.after),
    }
}

/// A table in CSV with one line per interval, ordered by probe and time, as in RFC 4180: lines end in CR LF, and fields
/// that contain a comma, a quote or a line break are quoted.
pub fn csv(sunlight: &Sunlight) -> String {
    let mut text = "probe,start,end,seconds,blocked_before,blocked_after\r\n".to_owned();
    for probed in &sunlight.probes {
        for interval in probed.days.iter().flatten() {
            let told = interval_report(sunlight, interval);
            let [name, before, after] =
                [&probed.probe.name, &told.blocked_before, &told.blocked_after].map(|it| field(it));
            // Writing to a String cannot fail.
            let _ = write!(text, "{name},{},{},{},{before},{after}\r\n", told.start, told.end, told.seconds);
        }
    }
    text
}

/// If there are more probes, there is one table for all of them.
const MOST_TABLES: usize = 20;

/// A table and a summary for each probe: the intervals of a single day, or a line for each of several days. Then the
/// ground, and how exact the times are. Ends with a line break.
pub fn table(sunlight: &Sunlight, place: &Place, ground: &Ground) -> String {
    let mut table = String::new();
    let is_long = sunlight.probes.len() > MOST_TABLES;
    if is_long {
        probes_table(&mut table, sunlight);
    }
    for probed in sunlight.probes.iter().filter(|_| !is_long) {
        // Writing to a String cannot fail.
        let _ = writeln!(table, "{}: {}", plain(&probed.probe.name), lies(&probed.probe));
        let below = probed.below_ground_m;
        if let Some(below) = below {
            let _ = writeln!(table, "{} below the ground: no sun reaches it", metres(below));
        }
        match (sunlight.days.as_slice(), probed.days.as_slice()) {
            ([day], [intervals]) => day_table(&mut table, sunlight, (day, intervals), below.is_some(), place),
            _ => range_table(&mut table, sunlight, probed),
        }
        table.push('\n');
    }
    let _ = writeln!(
        table,
        "To the second, nothing left out; start: the first second in sunlight, end: the first not in it\nground at {}\n\
         clock: {}, tz {}",
        ground.said(),
        place.time_zone,
        place.time_zone.version()
    );
    table
}

fn day_table(
    table: &mut String,
    sunlight: &Sunlight,
    (day, intervals): (&SunDay, &[Interval]),
    is_buried: bool,
    place: &Place,
) {
    let event =
        |time: Option<DateTime<Zone>>| time.map_or_else(|| "-".to_owned(), |time| time.format("%H:%M:%S").to_string());
    let of_day = &day.window.day;
    // Writing to a String cannot fail.
    let _ = writeln!(
        table,
        "{}, {}: sunrise {}, sunset {}",
        of_day.date,
        place.time_zone.name(),
        event(of_day.sunrise),
        event(of_day.sunset)
    );
    let rows: Vec<_> = intervals.iter().map(|interval| interval_report(sunlight, interval)).collect();
    let width = rows.iter().map(|row| plain(&row.blocked_before).chars().count()).fold(14, usize::max);
    if !rows.is_empty() {
        let _ = writeln!(
            table,
            "\n  {:<8}  {:<8}  {:>8}  {:<width$}  blocked after",
            "start", "end", "duration", "blocked before"
        );
    }
    for (interval, row) in intervals.iter().zip(&rows) {
        let _ = writeln!(
            table,
            "  {}  {}  {:>8}  {:<width$}  {}",
            interval.start.format("%H:%M:%S"),
            interval.end.format("%H:%M:%S"),
            clock(interval.secs()),
            plain(&row.blocked_before),
            plain(&row.blocked_after)
        );
    }
    if let Some(longest) = longest(intervals) {
        let total = clock(secs(intervals));
        let _ = writeln!(table, "\n  {total} of sun in {}, the longest {}", counted(rows.len()), clock(longest.secs()));
    } else {
        let _ = writeln!(table, "\n  no sun: {}", why_none(day, is_buried));
    }
}

/// The reason why a day has no interval.
fn why_none(day: &SunDay, is_buried: bool) -> &'static str {
    match day.up.is_empty() {
        true if day.window.from == day.window.to && day.window.day.polar != Some(Polar::Night) => {
            "no time of this day was requested"
        }
        true => "it stays below the horizon",
        false if is_buried => "the point lies below the ground",
        false => "it stays behind what casts, or behind the probe's own plane",
    }
}

fn range_table(table: &mut String, sunlight: &Sunlight, probed: &ProbeIntervals) {
    // Writing to a String cannot fail.
    let _ = writeln!(table, "\n  {:<10}  {:>8}  {:>8}  {:>9}", "date", "sun", "longest", "intervals");
    for (day, intervals) in sunlight.days.iter().zip(&probed.days) {
        let _ = writeln!(
            table,
            "  {:<10}  {:>8}  {:>8}  {:>9}",
            day.window.day.date.to_string(),
            clock(secs(intervals)),
            clock(longest(intervals).map_or(0, Interval::secs)),
            intervals.len()
        );
    }
    let _ = write!(table, "\n  {} of sun in {} days", clock(probed.secs()), sunlight.days.len());
    if let Some(longest) = probed.longest() {
        let from = longest.start.format("%Y-%m-%d %H:%M:%S");
        let _ = write!(table, "; the longest interval {} from {from}", clock(longest.secs()));
    }
    if let Some([(least_on, least), (most_on, most)]) = sunlight.least_and_most(probed) {
        let equals = probed.days.iter().filter(|day| secs(day) == least).count() - 1;
        let more = if equals > 0 { format!(" (and on {equals} more)") } else { String::new() };
        let _ = write!(table, "\n  least on {least_on}{more}: {}; most on {most_on}: {}", clock(least), clock(most));
    }
    table.push('\n');
}

/// One line per probe.
fn probes_table(table: &mut String, sunlight: &Sunlight) {
    let names = || sunlight.probes.iter().map(|probed| plain(&probed.probe.name));
    let width = names().map(|name| name.chars().count()).fold(5, usize::max).min(40);
    // Writing to a String cannot fail.
    let _ = writeln!(
        table,
        "{} probes, {} days\n\n  {:<width$}  {:>10}  {:>8}  {:>9}  {:<20}  most on",
        sunlight.probes.len(),
        sunlight.days.len(),
        "probe",
        "sun",
        "longest",
        "intervals",
        "least on"
    );
    for (probed, name) in sunlight.probes.iter().zip(names()) {
        let on = |(date, secs): (NaiveDate, i64)| format!("{date} {:>9}", clock(secs));
        let [least, most] = sunlight.least_and_most(probed).map_or_else(Default::default, |both| both.map(on));
        let _ = writeln!(
            table,
            "  {name:<width$}  {:>10}  {:>8}  {:>9}  {least}  {most}",
            clock(probed.secs()),
            clock(probed.longest().map_or(0, Interval::secs)),
            probed.days.iter().map(Vec::len).sum::<usize>()
        );
    }
    table.push('\n');
}

/// The position of a probe, and the direction in which it faces.
pub(super) fn lies(probe: &Probe) -> String {
    match probe.normal {
        Some(normal) => format!("at {}, facing {}", triple(probe.point), facing(normal)),
        None => format!("at {}, free on all sides", triple(probe.point)),
    }
}

/// A direction in words and numbers: `south (180.0°), upright`.
pub(super) fn facing(normal: DVec3) -> String {
    const WINDS: [&str; 8] = ["north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west"];
    let tilt = normal.z.clamp(-1.0, 1.0).asin().to_degrees();
    let tilted = match tilt {
        up if up > 89.9 => return "upwards".to_owned(),
        down if down < -89.9 => return "downwards".to_owned(),
        level if level.abs() < 0.05 => String::new(),
        up if up > 0.0 => format!(", {up:.1}° upwards"),
        down => format!(", {:.1}° downwards", -down),
    };
    let azimuth = normal.x.atan2(normal.y).to_degrees().rem_euclid(360.0);
    let wind = WINDS[(azimuth / 45.0).round() as usize % WINDS.len()];
    format!("{wind} ({azimuth:.1}°{tilted})")
}

/// Metres east, north and up, to the millimetre, without trailing zeros.
pub(super) fn triple(point: DVec3) -> String {
    let number = |value: f64| ((value * 1000.0).round() / 1000.0 + 0.0).to_string();
    format!("({}, {}, {})", number(point.x), number(point.y), number(point.z))
}

/// `2:05:30`.
pub(super) fn clock(secs: i64) -> String {
    format!("{}:{:02}:{:02}", secs / 3600, secs / 60 % 60, secs % 60)
}

/// `1 interval`, `3 intervals`.
pub(super) fn counted(intervals: usize) -> String {
    if intervals == 1 { "1 interval".to_owned() } else { format!("{intervals} intervals") }
}
