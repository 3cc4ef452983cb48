//! What a rule needs and a site does not have: one error that lists all of it.

use super::open_spaces::of_dwellings;
use crate::judgement::{CountedParts, needed_of_window};
use crate::message::few;
use crate::rules::{
    CompareWith, CountedTime, Criterion, DwellingShare, Grouping, HeightOver, OpenSpaces, ResolvedRule, Rule,
    RuleError, RuleNeed, RuleReceiver,
};
use crate::site::{JudgedArea, JudgedSite};
use std::collections::BTreeMap;

/// The most names that are listed.
const MOST_NAMES: usize = 30;

/// Refuses a site that lacks what a rule needs.
///
/// # Errors
/// [`RuleError::Needs`] with all of it.
pub(super) fn check(rule: &ResolvedRule, site: &JudgedSite) -> Result<(), RuleError> {
    let needs = lacking(rule, site);
    if needs.is_empty() { Ok(()) } else { Err(RuleError::Needs { rule: rule.id.clone(), needs }) }
}

/// Adds to the error of options that nobody chose what a site lacks whatever is chosen, so that one error lists all of
/// it. Other errors stay as they are.
pub fn with_needs(error: RuleError, rule: &Rule, given: &[(&str, &str)], site: &JudgedSite) -> RuleError {
    let RuleError::Unsaid { rule: id, missing, .. } = error else { return error };
    let open = rule.resolve_open(given).unwrap_or_default();
    let of_each: Vec<Vec<RuleNeed>> = open.iter().map(|rule| lacking(rule, site)).collect();
    let (first, others) = of_each.split_first().map_or((&[][..], &[][..]), |(first, others)| (first, others));
    let needs = first.iter().filter(|need| others.iter().all(|other| other.contains(need))).cloned().collect();
    RuleError::Unsaid { rule: id, missing, needs }
}

/// What a rule needs and a site lacks.
pub(super) fn lacking(rule: &ResolvedRule, site: &JudgedSite) -> Vec<RuleNeed> {
    let mut needs = Vec::new();
    match &rule.receiver {
        receiver @ RuleReceiver::Area { .. } => of_areas(site, receiver, &mut needs),
        RuleReceiver::Facade if site.facades.is_empty() => needs.push(RuleNeed::of_key("a façade", "[[facade]]", "")),
        RuleReceiver::Facade => {}
        RuleReceiver::Window { .. } => of_windows(rule, site, &mut needs),
        RuleReceiver::Lines { over, .. } => of_plot(*over, site, &mut needs),
    }
    let compares = rule.counting.what == CountedTime::NewShadow || rule.criteria.iter().any(Criterion::needs_before);
    if compares && rule.compare == Some(CompareWith::Before) && site.before.is_none() {
        needs.push(RuleNeed::of_key("the state before, with which it compares", "[before]", ""));
    }
    needs
}

fn of_areas(site: &JudgedSite, receiver: &RuleReceiver, needs: &mut Vec<RuleNeed>) {
    if site.areas.is_empty() {
        needs.push(RuleNeed::of_key("an area", "[[area]]", ""));
    }
    let RuleReceiver::Area { least_width_m } = receiver else { return };
    if *least_width_m <= 0.0 {
        return;
    }
    let has_none = |area: &&JudgedArea| CountedParts::of(receiver, area).triangles.is_empty();
    let narrow: Vec<String> = site.areas.iter().filter(has_none).map(|area| format!("{:?}", area.name)).collect();
    if !narrow.is_empty() {
        let of = if narrow.len() <= MOST_NAMES { narrow.join(", ") } else { few(narrow) };
        needs.push(RuleNeed::without_key(format!("a part that is at least {least_width_m} m wide in area {of}")));
    }
}

fn of_plot(over: HeightOver, site: &JudgedSite, needs: &mut Vec<RuleNeed>) {
    match &site.plot {
        None => needs.push(RuleNeed::of_key("the plot", "[plot]", "")),
        Some(plot) if over == HeightOver::MeanGround && plot.mean_ground.is_none() => {
            needs.push(RuleNeed::of_key("the mean level of the ground at the building", "[plot]", "mean_ground"));
        }
        Some(_) => {}
    }
    if over == HeightOver::Floor {
        needs.push(RuleNeed::without_key("a plane over the ground: a plot has no floor"));
    }
}

fn of_windows(rule: &ResolvedRule, site: &JudgedSite, needs: &mut Vec<RuleNeed>) {
    if site.windows.is_empty() {
        needs.push(RuleNeed::of_key("a window", "[[window]]", ""));
        return;
    }
    let RuleReceiver::Window { group, all_of, open_spaces, .. } = &rule.receiver else { return };
    let mut lacking: BTreeMap<[&'static str; 2], Vec<String>> = BTreeMap::new();
    for window in &site.windows {
        let mut needed = needed_of_window(&rule.receiver, window);
        let of_dwellings = rule.dwelling.is_some() || *group == Some(Grouping::Dwelling);
        if (rule.dwelling.is_some() || *group == Some(Grouping::Room)) && window.room.is_none() {
            needed.push(["the room", "room"]);
        }
        if of_dwellings && window.dwelling.is_none() {
            needed.push(["the dwelling", "dwelling"]);
        }
        if !all_of.is_empty() && window.usage.is_none() {
            needed.push(["the use of the room", "usage"]);
        }
        if matches!(rule.dwelling, Some(DwellingShare::FloorArea(_))) && window.room_m2.is_none() {
            needed.push(["the floor area of the room", "room_area"]);
        }
        for what in needed {
            lacking.entry(what).or_default().push(format!("{:?}", window.name));
        }
    }
    for ([what, key], windows) in lacking {
        let of = if windows.len() <= MOST_NAMES { windows.join(", ") } else { few(windows) };
        needs.push(RuleNeed::of_key(format!("{what} of window {of}"), "[[window]]", key));
    }
    let spaces = of_dwellings(&rule.receiver, site);
    of_uses((all_of, open_spaces.as_ref()), (site, &spaces), needs);
}

/// A dwelling that lacks one of the uses is an error; it does not pass.
fn of_uses(
    (all_of, open_spaces): (&[String], Option<&OpenSpaces>),
    (site, spaces): (&JudgedSite, &[&JudgedArea]),
    needs: &mut Vec<RuleNeed>,
) {
    let mut dwellings: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for window in &site.windows {
        if let (Some(dwelling), Some(usage)) = (&window.dwelling, &window.usage) {
            dwellings.entry(dwelling).or_default().push(usage);
        }
    }
    let of_spaces = spaces.iter().filter_map(|area| area.dwelling.as_ref().zip(open_spaces));
    for (dwelling, OpenSpaces { usage, .. }) in of_spaces {
        dwellings.entry(dwelling).or_default().push(usage);
    }
    for usage in all_of {
        let without = dwellings.iter().filter(|(_, uses)| !uses.contains(&usage.as_str()));
        let without: Vec<String> = without.map(|(name, _)| format!("{name:?}")).collect();
        if !without.is_empty() {
            let of = if without.len() <= MOST_NAMES { without.join(", ") } else { few(without) };
            let is_open_space = open_spaces.is_some_and(|spaces| spaces.usage == *usage);
            let what = if is_open_space { "a window or area" } else { "a window" };
            needs.push(RuleNeed::of_key(format!("{what} of use {usage:?} in dwelling {of}"), "[[window]]", "usage"));
        }
    }
}
