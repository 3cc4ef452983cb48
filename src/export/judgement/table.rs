//! A judgement as text for people.

use super::super::names::plain;
use super::super::probe::{clock, triple};
use super::numbers::{CHECK, component_name, date_of, deciding, excuse, least_counted};
use super::rule_report::clock_word;
use crate::judgement::{ERROR_ODDS, GroupRuling, Judgement, ReceiverRuling, Taker};
use crate::message::few;
use crate::rules::{Finding, Quantity, RuleReceiver, Verdict};
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
    groups(&mut text, judgement);
    takers(&mut text, judgement, site);
    rests_on(&mut text, judgement, site);
    text
}

fn receivers(text: &mut String, judgement: &Judgement) {
    let names = || judgement.receivers.iter().map(|receiver| plain(&receiver.name));
    let width = names().map(|name| name.chars().count()).fold(8, usize::max).min(40);
    // Writing to a String cannot fail.
    let _ = writeln!(
        text,
        "\n  {:<width$}  {:<7}  {:>14}  {:>14}  {:>14}  {:>14}  {:<10}  worst at",
        "receiver", "verdict", "value", "limit", "margin", "before", "day"
    );
    for (receiver, name) in judgement.receivers.iter().zip(names()) {
        let finding = deciding(&receiver.ruling);
        let told = |quantity: Option<Quantity>| quantity.map_or_else(|| "-".to_owned(), |it| said(it, receiver));
        let counted = || least_counted(receiver).map(|(_, secs)| Quantity::Secs(secs));
        let value = finding.map(|finding| finding.value).or_else(counted);
        let of_finding = |of: fn(&Finding) -> Option<Quantity>| told(finding.and_then(of));
        let margin = finding.and_then(|finding| finding.margin.map(|margin| margin_said(finding, margin, receiver)));
        let day = date_of(judgement, receiver).map_or_else(|| "-".to_owned(), |date| date.to_string());
        let at = receiver.points.first().map_or_else(|| "-".to_owned(), |point| triple(*point));
        let excused =
            finding.and_then(|finding| finding.excuse).map_or_else(String::new, |why| format!("  ({})", excuse(why)));
        let _ = writeln!(
            text,
            "  {name:<width$}  {:<7}  {:>14}  {:>14}  {:>14}  {:>14}  {day:<10}  {at}{excused}",
            receiver.ruling.verdict.to_string(),
            told(value),
            of_finding(|finding| finding.limit),
            margin.unwrap_or_else(|| "-".to_owned()),
            of_finding(|finding| finding.before),
        );
    }
}

/// A number with its unit; a part of an area as a share with its error.
fn said(quantity: Quantity, receiver: &ReceiverRuling) -> String {
    match (quantity, receiver.area) {
        (Quantity::Secs(secs), _) => clock(secs),
        (Quantity::AreaM2(m2), Some(area)) => format!("{:.2} %", 100.0 * m2 / area.m2),
        (Quantity::AreaM2(m2), None) => format!("{m2:.2} m²"),
        (Quantity::Share(share), _) => format!("{:.2} %", 100.0 * share),
        (Quantity::AreaTime(m2_secs), _) => format!("{:.1} m²h", m2_secs / 3600.0),
        (Quantity::Count(count), _) => count.to_string(),
    }
}

fn margin_said(finding: &Finding, margin: f64, receiver: &ReceiverRuling) -> String {
    let sign = if margin < 0.0 { "−" } else { "+" };
    let size = margin.abs();
    let quantity = match finding.value {
        Quantity::Secs(_) => Quantity::Secs(size as i64),
        Quantity::Share(_) => Quantity::Share(size),
        Quantity::AreaM2(_) => Quantity::AreaM2(size),
        Quantity::AreaTime(_) => Quantity::AreaTime(size),
        Quantity::Count(_) => Quantity::Count(size as usize),
    };
    format!("{sign}{}", said(quantity, receiver))
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
            "  {} {}{of_dwelling}: {}{}",
            group.kind,
            plain(&group.name),
            group.verdict,
            group_said(group)
        );
    }
}

fn group_said(group: &GroupRuling) -> String {
    let number = |quantity: Quantity| match quantity {
        Quantity::Secs(secs) => clock(secs),
        Quantity::Share(share) => format!("{:.1} %", 100.0 * share),
        Quantity::AreaM2(m2) => format!("{m2:.2} m²"),
        Quantity::AreaTime(m2_secs) => format!("{:.1} m²h", m2_secs / 3600.0),
        Quantity::Count(count) => count.to_string(),
    };
    if let Some(by) = &group.by_rooms {
        return format!(", {} of {} needed", number(by.value), number(by.limit));
    }
    let uses: Vec<String> = group.uses.iter().map(|(usage, secs)| format!("{usage} {}", clock(*secs))).collect();
    let Some(ruling) = &group.ruling else {
        return if uses.is_empty() { String::new() } else { format!(", {}", uses.join(", ")) };
    };
    let grade = ruling.grade.as_ref().map_or_else(String::new, |grade| format!(", grade {grade}"));
    let of = |finding: &Finding| match finding.limit {
        Some(limit) => format!(", {} for a limit of {}", number(finding.value), number(limit)),
        None => format!(", {}", number(finding.value)),
    };
    deciding(ruling).map_or(grade.clone(), |finding| grade + &of(finding))
}

fn takers(text: &mut String, judgement: &Judgement, site: &JudgedSite) {
    let taken = || judgement.receivers.iter().filter(|receiver| !receiver.takers.is_empty());
    if taken().next().is_none() {
        return;
    }
    text.push_str("\nWho takes the sun on that day, alone and with others:\n");
    for receiver in taken() {
        let of = |taker: &Taker| {
            let [alone, with] = [taker.alone_secs, taker.with_others_secs].map(|secs| clock(secs.round() as i64));
            format!("{} {alone} (+ {with})", plain(&component_name(&site.now, taker.component)))
        };
        let mut named: Vec<String> = receiver.takers.iter().take(MOST_TAKERS).map(of).collect();
        let more = receiver.takers.len() - named.len();
        named.extend((more > 0).then(|| format!("{more} more")));
        // Writing to a String cannot fail.
        let _ = writeln!(text, "  {}: {}", plain(&receiver.name), named.join(", "));
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
    let is_of_areas = matches!(judgement.rule.receiver, RuleReceiver::Area { .. });
    let areas = judgement.receivers.iter().filter_map(|receiver| receiver.area).filter(|_| is_of_areas);
    let worst = areas.map(|area| area.error_m2 / area.m2);
    if let Some(error) = worst.max_by(f64::total_cmp) {
        let (percent, areas) = (100.0 * error, 1.0 / ERROR_ODDS);
        let _ = writeln!(
            text,
            "parts of areas are known to ±{percent:.2} % of the area (farther off once in {areas:.0e} areas); spells to the second"
        );
    } else {
        let _ = writeln!(text, "spells to the second");
    }
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
