//! What a rule needs and a site does not have: one error that lists all of it.

use crate::judgement::{narrow_place, needed_of_window};
use crate::message::few;
use crate::rules::{
    CompareWith, CountedTime, Criterion, DwellingShare, Grouping, HeightOver, ResolvedRule, RuleError, RuleNeed,
    RuleReceiver,
};
use crate::site::{AreaSurface, JudgedSite};
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

/// What a rule needs and a site lacks.
pub(super) fn lacking(rule: &ResolvedRule, site: &JudgedSite) -> Vec<RuleNeed> {
    let mut needs = Vec::new();
    match &rule.receiver {
        RuleReceiver::Area { least_width_m } => of_areas(site, *least_width_m, &mut needs),
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

fn of_areas(site: &JudgedSite, least_width_m: f64, needs: &mut Vec<RuleNeed>) {
    if site.areas.is_empty() {
        needs.push(RuleNeed::of_key("an area", "[[area]]", ""));
    }
    for area in &site.areas {
        if matches!(area.surface, AreaSurface::Faces(_)) {
            continue;
        }
        if let Some((at, wide)) = narrow_place(&area.rings, least_width_m) {
            needs.push(RuleNeed::without_key(format!(
                "area {:?} without the part around ({:.2}, {:.2}), where it is {wide:.2} m wide and parts narrower than \
                 {least_width_m} m do not count",
                area.name, at.x, at.y
            )));
        }
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
    let RuleReceiver::Window { group, all_of, .. } = &rule.receiver else { return };
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
    of_uses(all_of, site, needs);
}

/// A dwelling that lacks one of the uses is an error; it does not pass.
fn of_uses(all_of: &[String], site: &JudgedSite, needs: &mut Vec<RuleNeed>) {
    let mut dwellings: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for window in &site.windows {
        if let (Some(dwelling), Some(usage)) = (&window.dwelling, &window.usage) {
            dwellings.entry(dwelling).or_default().push(usage);
        }
    }
    for usage in all_of {
        let without = dwellings.iter().filter(|(_, uses)| !uses.contains(&usage.as_str()));
        let without: Vec<String> = without.map(|(name, _)| format!("{name:?}")).collect();
        if !without.is_empty() {
            let of = if without.len() <= MOST_NAMES { without.join(", ") } else { few(without) };
            needs.push(RuleNeed::of_key(format!("a window of use {usage:?} in dwelling {of}"), "[[window]]", "usage"));
        }
    }
}
