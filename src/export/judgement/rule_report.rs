//! A rule in the JSON of a judgement: its source, and what is chosen in it.

use crate::rules::{
    CompareWith, Counting, Criterion, Demand, DwellingShare, Extent, OptionValue, ResolvedRule, RuleClock, RuleSource,
};
use serde::Serialize;
use serde::ser::{SerializeMap, Serializer};

#[derive(Serialize)]
pub(in crate::export) struct RuleReport<'a> {
    id: &'a str,
    name: &'a str,
    region: &'a str,
    kind: String,
    edition: &'a str,
    confidence: String,
    confidence_means: &'static str,
    sources: &'a [String],
    assumes: &'a [String],
    /// `built-in`, or the file that was read.
    from: &'a str,
}

/// What is chosen in a rule.
#[derive(Serialize)]
pub(in crate::export) struct SettledReport<'a> {
    #[serde(serialize_with = "options")]
    options: &'a [(String, OptionValue)],
    clock: ClockReport,
    sun: CutsReport,
    counted: CountedReport,
    compared_with: Option<String>,
    one_is_enough: bool,
    criteria: Vec<CriterionReport<'a>>,
    rooms_needed: Option<Vec<[usize; 2]>>,
    floor_area_needed: Option<f64>,
}

#[derive(Serialize)]
struct ClockReport {
    kind: &'static str,
    offset: Option<String>,
    sunrise: String,
}

#[derive(Serialize)]
struct CutsReport {
    above_deg: f64,
    strict: bool,
    off_facade_deg: f64,
    off_facade_in: String,
}

#[derive(Serialize)]
struct CountedReport {
    what: String,
    how: String,
    shortest_secs: i64,
    bridge_secs: Option<i64>,
    bridge_counts: Option<bool>,
    step_secs: Option<i64>,
}

#[derive(Serialize)]
struct CriterionReport<'a> {
    on: Option<&'a str>,
    band: Option<usize>,
    grade: Option<&'a str>,
    how: String,
    at_least_secs: Option<i64>,
    longest_at_least_secs: Option<i64>,
    at_most_secs: Option<i64>,
    at_most_of_open: Option<f64>,
    share: Option<f64>,
    or_area_m2: Option<f64>,
    ratio: Option<f64>,
    of_dwellings: Option<f64>,
    sunless_at_most: Option<f64>,
    or_ratio: Option<f64>,
    no_worse_where_before_fails: bool,
}

fn options<S: Serializer>(chosen: &&[(String, OptionValue)], serializer: S) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(Some(chosen.len()))?;
    for (name, value) in *chosen {
        match value {
            OptionValue::Number(number) => map.serialize_entry(name, number)?,
            OptionValue::Flag(flag) => map.serialize_entry(name, flag)?,
            OptionValue::Duration(_) | OptionValue::Word(_) => map.serialize_entry(name, &value.text())?,
        }
    }
    map.end()
}

pub(in crate::export) fn rule_report(source: &RuleSource) -> RuleReport<'_> {
    RuleReport {
        id: &source.id,
        name: &source.name,
        region: &source.region,
        kind: source.kind.to_string(),
        edition: &source.edition,
        confidence: source.confidence.to_string(),
        confidence_means: source.confidence.meaning(),
        sources: &source.sources,
        assumes: &source.assumes,
        from: source.file.as_deref().unwrap_or("built-in"),
    }
}

/// A clock's word in rules.
pub(super) fn clock_word(clock: RuleClock) -> &'static str {
    match clock {
        RuleClock::Legal => "legal",
        RuleClock::Standard => "standard",
        RuleClock::Fixed(_) => "fixed",
        RuleClock::TrueSolar => "true-solar",
    }
}

pub(in crate::export) fn settled_report(rule: &ResolvedRule) -> SettledReport<'_> {
    let offset = if let RuleClock::Fixed(offset) = rule.clock.clock { Some(offset.to_string()) } else { None };
    let (rooms_needed, floor_area_needed) = match &rule.dwelling {
        Some(DwellingShare::Rooms(lines)) => (Some(lines.iter().map(|line| [line.from, line.needed]).collect()), None),
        Some(DwellingShare::FloorArea(share)) => (None, Some(*share)),
        None => (None, None),
    };
    SettledReport {
        options: &rule.chosen,
        clock: ClockReport { kind: clock_word(rule.clock.clock), offset, sunrise: rule.clock.sunrise.to_string() },
        sun: CutsReport {
            above_deg: rule.cuts.above_deg,
            strict: rule.cuts.is_strict,
            off_facade_deg: rule.cuts.off_facade_deg,
            off_facade_in: rule.cuts.off_facade_in.to_string(),
        },
        counted: counted_report(&rule.counting),
        compared_with: rule.compare.map(|with: CompareWith| with.to_string()),
        one_is_enough: rule.any,
        criteria: rule.criteria.iter().map(criterion_report).collect(),
        rooms_needed,
        floor_area_needed,
    }
}

fn counted_report(counting: &Counting) -> CountedReport {
    CountedReport {
        what: counting.what.to_string(),
        how: counting.how.to_string(),
        shortest_secs: counting.shortest_secs,
        bridge_secs: counting.bridge.map(|bridge| bridge.gap_secs),
        bridge_counts: counting.bridge.map(|bridge| bridge.counts),
        step_secs: Some(counting.step_secs).filter(|secs| *secs > 0),
    }
}

fn criterion_report(of: &Criterion) -> CriterionReport<'_> {
    let (least, longest) = match of.demand {
        Demand::AtLeast { secs, longest_secs } => (Some(secs), Some(longest_secs).filter(|secs| *secs > 0)),
        _ => (None, None),
    };
    let (share, or_area_m2) = match of.extent {
        Extent::Part { share, or_area_m2 } => (Some(share), or_area_m2),
        _ => (None, None),
    };
    CriterionReport {
        on: Some(of.on.as_str()).filter(|on| !on.is_empty()),
        band: of.band.map(|band| band + 1),
        grade: of.grade.as_deref(),
        how: of.how.to_string(),
        at_least_secs: least,
        longest_at_least_secs: longest,
        at_most_secs: if let Demand::AtMost(secs) = of.demand { Some(secs) } else { None },
        at_most_of_open: if let Demand::ShareOfOpen(share) = of.demand { Some(share) } else { None },
        share,
        or_area_m2,
        ratio: if let Extent::OfBefore(ratio) = of.extent { Some(ratio) } else { None },
        of_dwellings: if let Extent::Dwellings(share) = of.extent { Some(share) } else { None },
        sunless_at_most: if let Extent::Sunless { most, .. } = of.extent { Some(most) } else { None },
        or_ratio: of.or_ratio,
        no_worse_where_before_fails: of.no_worse,
    }
}
