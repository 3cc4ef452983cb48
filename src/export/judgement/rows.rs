//! What is said of each receiver, group and taker, as texts: for the table of a face.

use super::super::names::plain;
use super::super::probe::{clock, triple};
use super::numbers::{component_name, date_of, deciding, excuse, worst_counted};
use crate::judgement::{GroupRuling, Judgement, ReceiverRuling, Taker};
use crate::rules::{AreaUnit, Finding, Quantity, Verdict};
use crate::site::JudgedSite;

/// What is said of a receiver; `-` where there is nothing to say.
#[derive(Clone, Debug, PartialEq)]
pub struct ReceiverRow {
    /// Its name.
    pub name: String,
    /// Its verdict.
    pub verdict: Verdict,
    /// The number that decides.
    pub value: String,
    /// Its limit.
    pub limit: String,
    /// By how much it keeps the limit, with a sign.
    pub margin: String,
    /// The number in the state before.
    pub before: String,
    /// The day that decides.
    pub day: String,
    /// The point that decides, metres.
    pub at: String,
    /// Why the number is accepted though it misses the limit.
    pub excuse: Option<String>,
}

/// What is said of a receiver.
pub fn receiver_row(judgement: &Judgement, receiver: &ReceiverRuling) -> ReceiverRow {
    let finding = deciding(&receiver.ruling);
    let unit = judgement.rule.counting.unit;
    let told = |quantity: Option<Quantity>| quantity.map_or_else(|| "-".to_owned(), |it| said(it, (receiver, unit)));
    let counted = || worst_counted(judgement, receiver).map(|(_, secs)| Quantity::Secs(secs));
    let of_finding = |of: fn(&Finding) -> Option<Quantity>| told(finding.and_then(of));
    let margin =
        finding.and_then(|finding| finding.margin.map(|margin| margin_said(finding, margin, (receiver, unit))));
    ReceiverRow {
        name: plain(&receiver.name),
        verdict: receiver.ruling.verdict,
        value: told(finding.map(|finding| finding.value).or_else(counted)),
        limit: of_finding(|finding| finding.limit),
        margin: margin.unwrap_or_else(|| "-".to_owned()),
        before: of_finding(|finding| finding.before),
        day: date_of(judgement, receiver).map_or_else(|| "-".to_owned(), |date| date.to_string()),
        at: receiver.points.first().map_or_else(|| "-".to_owned(), |point| triple(*point)),
        excuse: finding.and_then(|finding| finding.excuse).map(excuse),
    }
}

/// A component that takes the sun.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TakerRow {
    /// Its name.
    pub name: String,
    /// The time that it takes alone.
    pub alone: String,
    /// The time in which others stand before the sun, too.
    pub with_others: String,
}

/// What is said of a taker.
pub fn taker_row(site: &JudgedSite, taker: &Taker) -> TakerRow {
    let [alone, with_others] = [taker.alone_secs, taker.with_others_secs].map(|secs| clock(secs.round() as i64));
    TakerRow { name: plain(&component_name(&site.now, taker.component)), alone, with_others }
}

/// An area times time, in the rule's unit.
pub(super) fn area_hours(m2_secs: f64, unit: AreaUnit) -> String {
    const FOOT_M: f64 = 0.3048;
    let m2_hours = m2_secs / 3600.0;
    match unit {
        AreaUnit::SquareMetres => format!("{m2_hours:.1} m²h"),
        AreaUnit::SquareFeet => format!("{:.0} ft²h", m2_hours / (FOOT_M * FOOT_M)),
    }
}

/// A number with its unit; a part of an area as a share with its error.
fn said(quantity: Quantity, (receiver, unit): (&ReceiverRuling, AreaUnit)) -> String {
    match (quantity, receiver.area) {
        (Quantity::Secs(secs), _) => clock(secs),
        (Quantity::AreaM2(m2), Some(area)) => format!("{:.2} %", 100.0 * m2 / area.m2),
        (Quantity::AreaM2(m2), None) => format!("{m2:.2} m²"),
        (Quantity::Share(share), _) => format!("{:.2} %", 100.0 * share),
        (Quantity::AreaTime(m2_secs), _) => area_hours(m2_secs, unit),
        (Quantity::Count(count), _) => count.to_string(),
    }
}

fn margin_said(finding: &Finding, margin: f64, of: (&ReceiverRuling, AreaUnit)) -> String {
    let sign = if margin < 0.0 { "−" } else { "+" };
    let size = margin.abs();
    let quantity = match finding.value {
        Quantity::Secs(_) => Quantity::Secs(size as i64),
        Quantity::Share(_) => Quantity::Share(size),
        Quantity::AreaM2(_) => Quantity::AreaM2(size),
        Quantity::AreaTime(_) => Quantity::AreaTime(size),
        Quantity::Count(_) => Quantity::Count(size as usize),
    };
    format!("{sign}{}", said(quantity, of))
}

/// The numbers of a group after its verdict: `, 2 of 3 needed`; empty if there are none.
pub fn group_said(group: &GroupRuling) -> String {
    let number = |quantity: Quantity| match quantity {
        Quantity::Secs(secs) => clock(secs),
        Quantity::Share(share) => format!("{:.1} %", 100.0 * share),
        Quantity::AreaM2(m2) => format!("{m2:.2} m²"),
        Quantity::AreaTime(m2_secs) => area_hours(m2_secs, AreaUnit::default()),
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
