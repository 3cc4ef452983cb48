//! The report on an envelope: a table for people, and the JSON.

use super::map::EnvelopeMap;
use crate::export::judgement::{CHECK, RuleReport, SettledReport, rule_report, settled_report};
use crate::export::names::plain;
use crate::export::report::{self, GroundReport, PlaceReport, ground_report, place_report, stamp, tz_version};
use crate::export::{ExportError, probe};
use crate::message::{Message, Words};
use crate::rules::{RuleDay, Spell, SunDemand, duration_text, total_secs};
use crate::sun::{Place, Zone};
use chrono::{DateTime, TimeZone};
use glam::DVec3;
use serde::Serialize;
use std::fmt::Write;
use std::path::PathBuf;

/// A thing that keeps its sun, as it is reported.
#[derive(Clone, Debug)]
pub struct KeptReceiver {
    /// Its name.
    pub name: String,
    /// The height of its lowest ray over the plot, metres above [`EnvelopeMap::foot_m`]; `None` if no ray passes over the
    /// plot.
    pub lowest_m: Option<f64>,
    /// Whether it has less sun than is asked, so that all of its sun is kept.
    pub lacks: bool,
    /// Its places whose sun is kept.
    pub places: Vec<KeptSpot>,
}

/// A place that keeps its sun.
#[derive(Clone, Debug)]
pub struct KeptSpot {
    /// The points where it is judged; it is lit while all of them are.
    pub points: Vec<DVec3>,
    /// For each of its days, the day's index and when the sun stays.
    pub days: Vec<(usize, Vec<Spell>)>,
}

/// Everything that is reported on an envelope.
#[derive(Clone, Copy, Debug)]
pub struct EnvelopeContext<'a> {
    /// The heights.
    pub map: &'a EnvelopeMap<'a>,
    /// What must keep its sun.
    pub demand: SunDemand<'a>,
    /// The days on which it must.
    pub days: &'a [RuleDay],
    /// What is kept.
    pub kept: &'a [KeptReceiver],
    /// What no choice of hours exceeds, cubic metres; `None` if there is no choice.
    pub most_m3: Option<f64>,
    /// The files that were written.
    pub files: &'a [PathBuf],
}

#[derive(Serialize)]
struct EnvelopeReport<'a> {
    gnomon: &'static str,
    place: PlaceReport<'a>,
    tz_version: String,
    #[serde(flatten)]
    ground: GroundReport,
    refraction: bool,
    rule: Option<RuleReport<'a>>,
    hours_secs: Option<i64>,
    days: Vec<EnvelopeDayReport>,
    check_with_your_authority: &'static str,
    #[serde(flatten)]
    settled: Option<SettledReport<'a>>,
    region: [f64; 4],
    cell: f64,
    width: u32,
    height: u32,
    heights_above: &'static str,
    foot_m: f64,
    highest_m: f32,
    least_m: Option<f32>,
    greatest_m: Option<f32>,
    volume_m3: f64,
    volume_at_most_m3: Option<f64>,
    kept: Vec<KeptReport<'a>>,
    files: Vec<String>,
    notes: Vec<String>,
}

/// A day, and when the sun counts on it.
#[derive(Serialize)]
struct EnvelopeDayReport {
    date: String,
    windows: Vec<[String; 2]>,
}

#[derive(Serialize)]
struct KeptReport<'a> {
    name: &'a str,
    lowest_m: Option<f64>,
    lacks: bool,
    places: Vec<PlacesReport>,
}

#[derive(Serialize)]
struct PlacesReport {
    points: Vec<[f64; 3]>,
    days: Vec<KeptDayReport>,
}

#[derive(Serialize)]
struct KeptDayReport {
    date: String,
    seconds: i64,
    spells: Vec<[String; 2]>,
}

/// The JSON: the rule as `judge` has it, the raster of the heights (`region`, `cell`, `width`, `height`), what heights are above (`heights_above`,
/// at `foot_m` over the place's point), `highest_m`, which
/// nothing exceeds, the `least_m` and `greatest_m` height and the `volume_m3` below them. Without a rule, `rule` is null and
/// `hours_secs` says how much sun stays. `days` has the windows of each day. If there is a choice of hours, none leaves more than `volume_at_most_m3`. For everything that is `kept`, it
/// has the height of the lowest ray above that (`lowest_m`, null if none passes over the plot), whether it `lacks`
/// sun, and when the sun stays at each of its places.
///
/// # Errors
/// [`ExportError::Encode`] if the encoder fails.
pub fn json(told: &EnvelopeContext, (notes, words): (&[Message], &dyn Words)) -> Result<String, ExportError> {
    let EnvelopeContext { map, demand, .. } = *told;
    let (rule, settled, hours_secs) = match demand {
        SunDemand::Rule(source, rule) => (Some(rule_report(source)), Some(settled_report(rule)), None),
        SunDemand::Hours(secs, _) => (None, None, Some(secs)),
    };
    let day = |(number, spells): &(usize, Vec<Spell>)| KeptDayReport {
        date: told.days[*number].date.to_string(),
        seconds: total_secs(spells),
        spells: spells.iter().map(|of| [of.start, of.end].map(|secs| stamp(&time(map.place, secs)))).collect(),
    };
    let window = |of: &Spell| [of.start, of.end].map(|secs| stamp(&time(map.place, secs)));
    let of_day = |day: &RuleDay| EnvelopeDayReport {
        date: day.date.to_string(),
        windows: day.windows.iter().map(window).collect(),
    };
    let place = |spot: &KeptSpot| PlacesReport {
        points: spot.points.iter().map(DVec3::to_array).collect(),
        days: spot.days.iter().map(day).collect(),
    };
    let range = map.range();
    report::json(&EnvelopeReport {
        gnomon: env!("CARGO_PKG_VERSION"),
        place: place_report(map.place),
        tz_version: tz_version(map.place),
        ground: ground_report(map.ground),
        refraction: map.refraction,
        rule,
        hours_secs,
        days: told.days.iter().map(of_day).collect(),
        check_with_your_authority: CHECK,
        settled,
        region: map.grid.region(),
        cell: map.grid.cell,
        width: map.grid.width,
        height: map.grid.height,
        heights_above: map.foot_said(),
        foot_m: map.foot_m,
        highest_m: map.cap_m,
        least_m: range.map(|[low, _]| low),
        greatest_m: range.map(|[_, high]| high),
        volume_m3: map.volume_m3(),
        volume_at_most_m3: told.most_m3,
        kept: told
            .kept
            .iter()
            .map(|of| KeptReport {
                name: &of.name,
                lowest_m: of.lowest_m,
                lacks: of.lacks,
                places: of.places.iter().map(place).collect(),
            })
            .collect(),
        files: told.files.iter().map(|file| file.display().to_string()).collect(),
        notes: report::said(notes, words),
    })
}

/// The most things whose names are listed.
const MOST_LINES: usize = 40;

/// The files, the heights, what is kept and when, and what that rests on. Ends with a line break.
pub fn table(told: &EnvelopeContext) -> String {
    let map = told.map;
    let mut text: String = told.files.iter().map(|file| format!("{}\n", file.display())).collect();
    // Writing to a String cannot fail.
    let _ = match map.range() {
        Some([low, high]) => writeln!(
            text,
            "\nfrom {low:.2} m to {high:.2} m above {}, {:.0} m³ in all; {:.2} m at most where no sun is in the way",
            map.foot_said(),
            map.volume_m3(),
            map.cap_m
        ),
        None => writeln!(text, "\nthe plot has no cell"),
    };
    if let Some(most_m3) = told.most_m3 {
        let _ = writeln!(text, "no choice of hours leaves more than {most_m3:.0} m³");
    }
    let width = told.kept.iter().map(|of| plain(&of.name).chars().count()).fold(8, usize::max).min(40);
    let _ = writeln!(text, "\n  {:<width$}  {:>10}  sun that stays", "keeps", "lowest ray");
    for of in told.kept.iter().take(MOST_LINES) {
        let lowest = of.lowest_m.map_or_else(|| "-".to_owned(), |lowest| format!("{lowest:.2} m"));
        let _ = writeln!(text, "  {:<width$}  {lowest:>10}  {}", plain(&of.name), stays(told, of));
    }
    if told.kept.len() > MOST_LINES {
        let _ = writeln!(text, "  and {} more; the JSON has all", told.kept.len() - MOST_LINES);
    }
    text += &demanded(told);
    let refraction = if map.refraction { "with refraction" } else { "without refraction" };
    let _ = writeln!(
        text,
        "ground at {}; {refraction}; clock: {}, tz {}",
        map.ground.said(),
        map.place.time_zone,
        map.place.time_zone.version()
    );
    text
}

/// `from 08:00 to 17:00`, or nothing where the sun of the whole day counts. Of several days the first one's times, which is
/// said.
pub fn window_said(place: &Place, days: &[RuleDay]) -> String {
    let Some(([window], day)) = days.first().map(|day| (day.windows.as_slice(), day)) else { return String::new() };
    let [from, to] = [window.start, window.end].map(|secs| time(place, secs).format("%H:%M").to_string());
    let on = if days.len() > 1 { format!(" on {}", day.date) } else { String::new() };
    if from == "00:00" && to == "00:00" { String::new() } else { format!("from {from} to {to}{on}") }
}

/// What must keep its sun, and what that rests on.
fn demanded(told: &EnvelopeContext) -> String {
    let (source, rule) = match told.demand {
        SunDemand::Rule(source, rule) => (source, rule),
        SunDemand::Hours(secs, _) => {
            let window = window_said(told.map.place, told.days);
            let gap = if window.is_empty() { "" } else { ", " };
            let hours = duration_text(secs);
            return format!("\nkeeps {hours} of sun on each day{gap}{window}, as given, by no rule\n{CHECK}\n");
        }
    };
    let known = format!("known as {}: {}", source.confidence, source.confidence.meaning());
    let head = format!("\nrule: {}, {} ({}), {known}\n{CHECK}\n", source.name, source.region, source.edition);
    let assumed = source.assumes.iter().map(|assumed| format!("assumes: {assumed}\n"));
    let chosen = rule.chosen.iter().map(|(name, value)| format!("chosen: {name} = {}\n", value.text()));
    std::iter::once(head).chain(assumed).chain(chosen).collect()
}

/// When a thing's sun stays: the spells if it is a single place on a single day, else how much stays.
fn stays(told: &EnvelopeContext, of: &KeptReceiver) -> String {
    let lacks = if of.lacks { "; less than is asked: all of it is kept" } else { "" };
    let clock = |secs: i64| time(told.map.place, secs).format("%H:%M:%S").to_string();
    match of.places.as_slice() {
        [KeptSpot { days, .. }] => match days.as_slice() {
            [(day, spells)] => {
                let said: Vec<_> = spells.iter().map(|it| format!("{} – {}", clock(it.start), clock(it.end))).collect();
                format!("{}: {}{lacks}", told.days[*day].date, said.join(", "))
            }
            days => format!("{} days{lacks}", days.len()),
        },
        places => {
            let secs = places.iter().flat_map(|place| &place.days).map(|(_, spells)| total_secs(spells)).max();
            format!("{} places, each at most {}{lacks}", places.len(), probe::clock(secs.unwrap_or(0)))
        }
    }
}

fn time(place: &Place, secs: i64) -> DateTime<Zone> {
    // a day's windows are within the years that chrono supports
    let utc = DateTime::from_timestamp(secs, 0).unwrap_or_default().naive_utc();
    place.time_zone.from_utc_datetime(&utc)
}
