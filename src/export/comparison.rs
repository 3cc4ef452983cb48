//! What a change does to sunlight, in numbers: `compare.json`, and the table of `gnomon compare`.

use super::ExportError;
use super::figure::{ChangeBands, duration};
use super::report::{self, DrawnReport, ReportContext};
use crate::profile::comparison::{Alteration, Change, Comparison};
use crate::sun::{Place, SunTrack};
use serde::Serialize;
use std::fmt::Write;

/// The greatest number of rows that compare the sun before and after.
const MOST_ROWS: u32 = 16;

#[derive(Serialize)]
struct CompareReport<'a> {
    before: &'a str,
    after: &'a str,
    compared_m2: f64,
    built_m2: f64,
    cleared_m2: f64,
    sun_lost: ChangeReport,
    sun_gained: ChangeReport,
    sun_at_least: Vec<SunlightChange>,
    #[serde(flatten)]
    head: DrawnReport<'a>,
}

#[derive(Serialize)]
struct ChangeReport {
    m2_hours: f64,
    most_hours: f64,
    most_at: Option<[f64; 2]>,
    more_than: Vec<AreaReport>,
}

#[derive(Serialize)]
struct AreaReport {
    hours: f64,
    area_m2: f64,
}

#[derive(Serialize)]
struct SunlightChange {
    hours: f64,
    before_m2: f64,
    after_m2: f64,
}

fn hours(secs: u32) -> f64 {
    f64::from(secs) / 3600.0
}

/// The lower bounds of the drawing's bands, in seconds, starting with 0.
fn thresholds(comparison: &Comparison, track: &SunTrack) -> Vec<u32> {
    let bands = ChangeBands::of(comparison, track.step_secs);
    (0..bands.count.max(1)).map(|band| band * bands.band_secs).collect()
}

/// The hours of sun that get a row, in seconds: whole hours up to the daylight, or multiples if those were too many
/// rows.
fn sun_rows(comparison: &Comparison) -> Vec<u32> {
    let day_secs = comparison.after().day_secs;
    let each = day_secs.div_ceil(MOST_ROWS * 3600).max(1) * 3600;
    (1..=MOST_ROWS).map(|row| row * each).take_while(|secs| *secs <= day_secs).collect()
}

fn change(comparison: &Comparison, change: Change, thresholds: &[u32]) -> ChangeReport {
    let most = comparison.most(change);
    let area = |&secs: &u32| AreaReport { hours: hours(secs), area_m2: comparison.more_than_m2(change, secs) };
    ChangeReport {
        m2_hours: comparison.total_m2_hours(change),
        most_hours: most.map_or(0.0, |most| most.hours),
        most_at: most.map(|most| most.at),
        more_than: thresholds.iter().map(area).collect(),
    }
}

/// `compare.json`: the areas, then what `profile.json` says about the study. `names` are those of the states before and
/// after.
///
/// # Errors
/// [`ExportError::Encode`] if the encoder fails.
pub fn json(
    comparison: &Comparison,
    names: &[String; 2],
    place: &Place,
    track: &SunTrack,
    told: &ReportContext<'_>,
) -> Result<String, ExportError> {
    let thresholds = thresholds(comparison, track);
    let sun = |secs| {
        let [before_m2, after_m2] = comparison.sun_at_least_m2(secs);
        SunlightChange { hours: hours(secs), before_m2, after_m2 }
    };
    report::json(&CompareReport {
        before: &names[0],
        after: &names[1],
        compared_m2: comparison.altered_m2(Alteration::No),
        built_m2: comparison.altered_m2(Alteration::Built),
        cleared_m2: comparison.altered_m2(Alteration::Cleared),
        sun_lost: change(comparison, Change::SunLost, &thresholds),
        sun_gained: change(comparison, Change::SunGained, &thresholds),
        sun_at_least: sun_rows(comparison).into_iter().map(sun).collect(),
        head: report::plan_report(comparison.grid(), place, track, told),
    })
}

/// The rows of the table: a label and two values each. Rows of column headings have an empty label.
pub fn rows(comparison: &Comparison, track: &SunTrack) -> Vec<[String; 3]> {
    let mut rows = Vec::new();
    let mut row = |what: &str, [first, second]: [String; 2]| rows.push([what.to_owned(), first, second]);
    let both = |of: &dyn Fn(Change) -> String| [Change::SunLost, Change::SunGained].map(of);
    row("", ["sun lost".to_owned(), "sun gained".to_owned()]);
    for secs in thresholds(comparison, track) {
        let what = if secs == 0 { "at all".to_owned() } else { format!("more than {}", duration(secs)) };
        row(&what, both(&|change| format!("{:.0} m²", comparison.more_than_m2(change, secs))));
    }
    row("in all", both(&|change| format!("{:.0} m²·h", comparison.total_m2_hours(change))));
    let most = |change| comparison.most(change);
    row("most", both(&|change| most(change).map_or("-".to_owned(), |most| format!("{:.2} h", most.hours))));
    let at = |change| most(change).map_or("-".to_owned(), |most| format!("{:.1}, {:.1}", most.at[0], most.at[1]));
    row("at, m east and north", both(&at));
    row("", ["before".to_owned(), "after".to_owned()]);
    for secs in sun_rows(comparison) {
        let areas = comparison.sun_at_least_m2(secs).map(|area| format!("{area:.0} m²"));
        row(&format!("at least {} of sun", duration(secs)), areas);
    }
    rows
}

/// How much of the plan was compared, as a sentence without its full stop.
pub fn extent(comparison: &Comparison) -> String {
    let [built, cleared] = [Alteration::Built, Alteration::Cleared].map(|altered| comparison.altered_m2(altered));
    format!(
        "{:.0} m² compared; not compared: {built:.0} m² with something new or higher, {cleared:.0} m² where it is gone",
        comparison.altered_m2(Alteration::No)
    )
}

/// The table of areas for people.
pub fn table(comparison: &Comparison, track: &SunTrack) -> String {
    let mut table = String::new();
    for [what, first, second] in rows(comparison, track) {
        // Writing to a String cannot fail.
        let _ = writeln!(table, "{what:<26}  {first:>16}  {second:>16}");
    }
    let _ = writeln!(table, "{}", extent(comparison));
    table
}
