//! Rules: reading them, their days and windows, and their verdicts on either side of each threshold.

mod areas;
mod built_in;
mod counting;
mod day_sun;
mod days;
mod files;
mod groups;
mod reading;
mod receivers;
mod seasons;
mod verdicts;
mod worked;

use gnomon::rules::{DayLight, ResolvedRule, Rule, RuleDay, Ruling, Spell, built_in_text};
use gnomon::sun::Place;

/// A built-in rule with options.
fn rule(id: &str, given: &[(&str, &str)]) -> ResolvedRule {
    let rule = Rule::parse(id, built_in_text(id).expect("built in")).expect("a rule");
    rule.resolve(given).expect("options")
}

fn place(latitude_deg: f64, longitude_deg: f64, zone: &str) -> Place {
    Place::new("", latitude_deg, longitude_deg, 0.0, Some(zone)).expect("a place")
}

/// The days of a rule where it is in force.
fn calendar(rule: &ResolvedRule) -> Vec<RuleDay> {
    let place = match rule.id.split('-').next().unwrap_or_default() {
        "au" => place(-33.87, 151.21, "Australia/Sydney"),
        "ca" => place(45.51, -73.57, "America/Toronto"),
        "cn" => place(39.9, 116.4, "Asia/Shanghai"),
        "jp" => place(35.0, 135.5, "Asia/Tokyo"),
        "kr" => place(37.57, 126.98, "Asia/Seoul"),
        "pl" => place(52.23, 21.01, "Europe/Warsaw"),
        "ru" => place(55.75, 37.62, "Europe/Moscow"),
        "uk" => place(51.5, -0.13, "Europe/London"),
        "us" if rule.id.contains("sf") => place(37.77, -122.42, "America/Los_Angeles"),
        "us" => place(40.7128, -74.006, "America/New_York"),
        _ => place(50.1, 8.7, "Europe/Berlin"),
    };
    rule.calendar(&place, 2026).expect("days")
}

const fn hours(hours: i64) -> i64 {
    hours * 3600
}

const fn minutes(minutes: i64) -> i64 {
    minutes * 60
}

/// Spells of such lengths from the beginning of the day's window on, with 20 minutes between them.
fn spells(day: &RuleDay, lengths: &[i64]) -> Vec<Spell> {
    let mut start = day.windows[0].start;
    let mut spells = Vec::new();
    for secs in lengths {
        spells.push(Spell::new(start, start + secs));
        start += secs + minutes(20);
    }
    spells
}

/// The ruling on a receiver that is lit for so long on all days, and before for so long.
fn lit(rule: &ResolvedRule, secs: i64, before: Option<i64>) -> Ruling {
    lit_in(rule, &[secs], before)
}

/// The same of spells with 20 minutes between them.
fn lit_in(rule: &ResolvedRule, lengths: &[i64], before: Option<i64>) -> Ruling {
    let days = calendar(rule);
    let spells_of: Vec<_> =
        days.iter().map(|day| (spells(day, lengths), before.map(|before| spells(day, &[before])))).collect();
    let lights: Vec<_> = days
        .iter()
        .zip(&spells_of)
        .map(|(day, (lit, before))| DayLight {
            day,
            open: &day.windows,
            lit,
            before: before.as_deref(),
            newly_shaded: None,
        })
        .collect();
    rule.judge_time(None, &lights).expect("a ruling")
}
