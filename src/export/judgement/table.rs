//! A judgement as text for people.

use super::super::names::plain;
use super::super::probe::clock;
use super::numbers::{CHECK, no_sun_left_limit};
use super::rows::{ReceiverRow, TakerRow, area_hours, group_said, receiver_row, taker_row};
use super::rule_report::clock_word;
use crate::judgement::{ERROR_ODDS, Judgement, Taker};
use crate::message::few;
use crate::rules::{Quantity, RuleReceiver, Verdict};
use crate::site::JudgedSite;
use std::fmt::Write;

/// The most takers whose names are listed.
const MOST_TAKERS: usize = 3;

/// The verdict, a line for each receiver and group, who takes the sun of what does not pass, and what the verdict rests
/// on. Ends with a line break.
pub fn table(judgement: &Judgement, site: &JudgedSite) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    let grade = judgement.grade.as_ref().map_or_else(String::new, |grade| format!(", grade {grade}"));
    let _ = writeln!(text, "{}{grade}: {}, {}", judgement.verdict, judgement.source.name, judgement.source.region);
    receivers(&mut text, judgement);
    losses(&mut text, judgement);
    groups(&mut text, judgement);
    takers(&mut text, judgement, site);
    rests_on(&mut text, judgement, site);
    text
}

fn receivers(text: &mut String, judgement: &Judgement) {
    let rows: Vec<ReceiverRow> = judgement.receivers.iter().map(|receiver| receiver_row(judgement, receiver)).collect();
    let width = rows.iter().map(|row| row.name.chars().count()).fold(8, usize::max).min(40);
    // Writing to a String cannot fail.
    let _ = writeln!(
        text,
        "\n  {:<width$}  {:<7}  {:>14}  {:>14}  {:>14}  {:>14}  {:<10}  worst at",
        "receiver", "verdict", "value", "limit", "margin", "before", "day"
    );
    for ReceiverRow { name, verdict, value, limit, margin, before, day, at, excuse } in rows {
        let excused = excuse.map_or_else(String::new, |why| format!("  ({why})"));
        let _ = writeln!(
            text,
            "  {name:<width$}  {:<7}  {value:>14}  {limit:>14}  {margin:>14}  {before:>14}  {day:<10}  {at}{excused}",
            verdict.to_string(),
        );
    }
}

/// On which days all sun is gone that was there before, if the rule asks for that.
fn losses(text: &mut String, judgement: &Judgement) {
    for receiver in &judgement.receivers {
        for finding in &receiver.ruling.findings {
            let lost = finding.no_sun_left_secs.zip(no_sun_left_limit(judgement, finding)).zip(finding.date);
            let Some(((secs, limit), date)) = lost.filter(|((secs, _), _)| *secs > 0) else { continue };
            let weight = if secs >= limit { "significant" } else { "not significant" };
            // Writing to a String cannot fail.
            let _ = writeln!(
                text,
                "  {}: on {date} all sun that was there before is gone for up to {}: {weight} by the limit of {}",
                plain(&receiver.name),
                clock(secs),
                clock(limit)
            );
        }
    }
}

fn groups(text: &mut String, judgement: &Judgement) {
    if judgement.groups.is_empty() {
        return;
    }
    text.push('\n');
    for group in &judgement.groups {
        let of_dwelling = group.dwelling.as_ref().map_or_else(String::new, |of| format!(" of {}", plain(of)));
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "  {}{of_dwelling}: {}{}",
            format!("{} {}", group.kind, plain(&group.name)).trim_end(),
            group.verdict,
            group_said(group)
        );
    }
}

fn takers(text: &mut String, judgement: &Judgement, site: &JudgedSite) {
    let taken = || judgement.receivers.iter().filter(|receiver| !receiver.takers.is_empty());
    if taken().next().is_none() {
        return;
    }
    let has_areas = taken().any(|receiver| receiver.area.is_some());
    let mean = if has_areas { " (of areas the mean over points that do not keep the rule)" } else { "" };
    // Writing to a String cannot fail.
    let _ = writeln!(text, "\nWho takes the sun on that day, alone and with others{mean}:");
    for receiver in taken() {
        let of = |taker: &Taker| {
            let TakerRow { name, alone, with_others } = taker_row(site, taker);
            format!("{name} {alone} (+ {with_others})")
        };
        let mut named: Vec<String> = receiver.takers.iter().take(MOST_TAKERS).map(of).collect();
        let more = receiver.takers.len() - named.len();
        named.extend((more > 0).then(|| format!("{more} more")));
        // Writing to a String cannot fail.
        let _ = writeln!(text, "  {}: {}", plain(&receiver.name), named.join(", "));
    }
}

/// How exact the numbers are.
fn exactness(text: &mut String, judgement: &Judgement) {
    // Writing to a String cannot fail.
    let is_of_areas = matches!(judgement.rule.receiver, RuleReceiver::Area { .. });
    let areas = || judgement.receivers.iter().filter_map(|receiver| receiver.area).filter(|_| is_of_areas);
    if let Some(apart_m) = areas().filter_map(|area| area.apart_m).max_by(f64::total_cmp) {
        let _ = writeln!(
            text,
            "new shadow on areas is looked for at points up to {apart_m:.1} m apart: narrower shadow may lie between them"
        );
    }
    if let Some(error) = areas().filter_map(|area| area.error_m2_secs).max_by(f64::total_cmp) {
        let error = area_hours(error, judgement.rule.counting.unit);
        let _ = writeln!(text, "area times time is known to about ±{error}");
    }
    let of_parts = judgement
        .receivers
        .iter()
        .filter(|receiver| receiver.ruling.findings.iter().any(|finding| matches!(finding.value, Quantity::AreaM2(_))));
    let worst =
        of_parts.filter_map(|receiver| receiver.area).filter(|_| is_of_areas).map(|area| area.error_m2 / area.m2);
    if let Some(error) = worst.max_by(f64::total_cmp) {
        let (percent, areas) = (100.0 * error, 1.0 / ERROR_ODDS);
        let _ = writeln!(
            text,
            "parts of areas are known to ±{percent:.2} % of the area (farther off once in {areas:.0e} areas); spells to the second"
        );
    } else if !is_of_areas && judgement.receivers.iter().any(|receiver| receiver.area.is_some()) {
        let _ = writeln!(text, "spells of windows to the second, those of open spaces to some seconds");
    } else {
        let _ = writeln!(text, "spells to the second");
    }
}

/// The rule's source, what is chosen and assumed, and what the models stand on.
fn rests_on(text: &mut String, judgement: &Judgement, site: &JudgedSite) {
    let source = &judgement.source;
    let options: Vec<String> =
        judgement.rule.chosen.iter().map(|(name, value)| format!("{name} = {}", value.text())).collect();
    let dates: Vec<String> = judgement.days.iter().map(|day| day.date.to_string()).collect();
    let days = match dates.as_slice() {
        [first, .., last] if dates.len() > 8 => format!("{} days, {first} to {last}", dates.len()),
        _ => dates.join(", "),
    };
    // Writing to a String cannot fail.
    let _ = writeln!(text, "\n{} ({}), {}: {}", source.id, source.kind, source.edition, source.sources.join(", "));
    if let Some(file) = &source.file {
        let _ = writeln!(text, "the rule was read from {file}");
    }
    let _ = writeln!(text, "known as {}: {}", source.confidence, source.confidence.meaning());
    if !options.is_empty() {
        let _ = writeln!(text, "options: {}", options.join(", "));
    }
    for assumed in &source.assumes {
        let _ = writeln!(text, "assumed: {assumed}");
    }
    let _ = writeln!(text, "judged: {days}; {} clock", clock_word(judgement.rule.clock.clock));
    let refraction = if site.refraction { "with" } else { "without" };
    let _ = writeln!(text, "the sun {refraction} the air's refraction; ground at {}", site.now.ground.said());
    exactness(text, judgement);
    let failing: Vec<String> = judgement
        .receivers
        .iter()
        .filter(|receiver| matches!(receiver.ruling.verdict, Verdict::Fail | Verdict::Close))
        .map(|receiver| plain(&receiver.name))
        .collect();
    if !failing.is_empty() {
        let _ = writeln!(text, "not kept, or too close to say: {}", few(failing));
    }
    let _ = writeln!(text, "{CHECK}");
}
