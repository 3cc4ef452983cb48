//! The CSV of a judgement.

use super::super::names::field;
use super::numbers::{date_of, deciding, excuse, number, secs_of, share_of, worst_counted};
use crate::judgement::{Judgement, ReceiverRuling};
use crate::rules::{Finding, Ruling, Verdict};
use std::fmt::Write;

const HEAD: &str = "name,kind,dwelling,room,use,verdict,grade,date,x,y,z,unit,value,limit,margin,before,difference,share,\
                    share_limit,share_before,share_error,excuse\r\n";

/// A table with one line per receiver, in the site's order, as in RFC 4180; if the rule only reports and has several
/// days, with one line per receiver and day. `value`, `limit`, `margin`, `before` and `difference` are in the `unit`: s,
/// m2 or m2 s; shares are of the area. A field without a value is empty.
pub fn csv(judgement: &Judgement) -> String {
    let mut text = HEAD.to_owned();
    for receiver in &judgement.receivers {
        for finding in findings(&receiver.ruling) {
            let cells = cells(judgement, receiver, finding);
            // Writing to a String cannot fail.
            let _ = write!(text, "{}\r\n", cells.iter().map(|cell| field(cell)).collect::<Vec<_>>().join(","));
        }
    }
    text
}

/// What decides; where nothing does because the rule only reports, every finding, so that no day is left out.
fn findings(ruling: &Ruling) -> Vec<Option<&Finding>> {
    match ruling.verdict {
        Verdict::Report if !ruling.findings.is_empty() => ruling.findings.iter().map(Some).collect(),
        _ => vec![deciding(ruling)],
    }
}

fn cells(judgement: &Judgement, of: &ReceiverRuling, finding: Option<&Finding>) -> Vec<String> {
    let text = |text: &Option<String>| text.clone().unwrap_or_default();
    let written = |number: Option<f64>| number.map(|number| (number + 0.0).to_string()).unwrap_or_default();
    let value = finding.map(|finding| number(finding.value));
    let counted = worst_counted(judgement, of).map(|(_, secs)| (secs as f64, "s"));
    let (value, unit) = value.or(counted).map_or((None, ""), |(value, unit)| (Some(value), unit));
    let before = finding.and_then(|finding| finding.before);
    let limit = finding.and_then(|finding| finding.limit);
    let share = |quantity| of.area.and_then(|area| share_of(quantity, area.m2));
    let own_share = share(finding.map(|finding| finding.value));
    // the point is the one that decides
    let is_deciding = finding.is_none_or(|finding| deciding(&of.ruling) == Some(finding));
    let point = of.points.first().filter(|_| is_deciding);
    let at = |of: fn(&glam::DVec3) -> f64| written(point.map(of).map(|at| (at * 1000.0).round() / 1000.0));
    let difference = value.zip(before.map(|before| number(before).0)).map(|(now, before)| now - before);
    debug_assert!(finding.is_none() || secs_of(finding.map(|finding| finding.value)).is_none() || unit == "s");
    vec![
        of.name.clone(),
        of.kind.to_string(),
        text(&of.dwelling),
        text(&of.room),
        text(&of.usage),
        of.ruling.verdict.to_string(),
        text(&of.ruling.grade),
        finding
            .and_then(|finding| finding.date)
            .or(date_of(judgement, of))
            .map(|date| date.to_string())
            .unwrap_or_default(),
        at(|point| point.x),
        at(|point| point.y),
        at(|point| point.z),
        unit.to_owned(),
        written(value),
        written(limit.map(|limit| number(limit).0)),
        written(finding.and_then(|finding| finding.margin)),
        written(before.map(|before| number(before).0)),
        written(difference),
        written(own_share),
        written(share(limit)),
        written(share(before)),
        written(of.area.filter(|_| own_share.is_some()).map(|area| area.error_m2 / area.m2)),
        finding.and_then(|finding| finding.excuse).map(excuse).unwrap_or_default(),
    ]
}
