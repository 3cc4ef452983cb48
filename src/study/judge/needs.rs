//! What a rule needs and a site does not have: one error that lists all of it.

use crate::judgement::{narrow_place, needed_of_window};
use crate::message::few;
use crate::rules::{
    CompareWith, CountedTime, Criterion, DwellingShare, Grouping, HeightOver, ResolvedRule, RuleError, RuleReceiver,
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
    let mut needs = Vec::new();
    match &rule.receiver {
        RuleReceiver::Area { least_width_m } => of_areas(site, *least_width_m, &mut needs),
        RuleReceiver::Facade if site.facades.is_empty() => needs.push("a façade".to_owned()),
        RuleReceiver::Facade => {}
        RuleReceiver::Window { .. } => of_windows(rule, site, &mut needs),
        RuleReceiver::Lines { over, .. } => of_plot(*over, site, &mut needs),
    }
    let compares = rule.counting.what == CountedTime::NewShadow || rule.criteria.iter().any(Criterion::needs_before);
    if compares && rule.compare == Some(CompareWith::Before) && site.before.is_none() {
        needs.push("the state before, with which it compares".to_owned());
    }
    if needs.is_empty() {
        return Ok(());
    }
    Err(RuleError::Needs { rule: rule.id.clone(), what: needs.join("; ") })
}

fn of_areas(site: &JudgedSite, least_width_m: f64, needs: &mut Vec<String>) {
    if site.areas.is_empty() {
        needs.push("an area".to_owned());
    }
    for area in &site.areas {
        if matches!(area.surface, AreaSurface::Faces(_)) {
            continue;
        }
        if let Some((at, wide)) = narrow_place(&area.rings, least_width_m) {
            needs.push(format!(
                "area {:?} without the part around ({:.2}, {:.2}), where it is {wide:.2} m wide and parts narrower than \
                 {least_width_m} m do not count",
                area.name, at.x, at.y
            ));
        }
    }
}

fn of_plot(over: HeightOver, site: &JudgedSite, needs: &mut Vec<String>) {
    match &site.plot {
        None => needs.push("the plot".to_owned()),
        Some(plot) if over == HeightOver::MeanGround && plot.mean_ground.is_none() => {
            needs.push("the mean level of the ground at the building (plot)".to_owned());
        }
        Some(_) => {}
    }
    if over == HeightOver::Floor {
        needs.push("a plane over the ground: a plot has no floor".to_owned());
    }
}

fn of_windows(rule: &ResolvedRule, site: &JudgedSite, needs: &mut Vec<String>) {
    if site.windows.is_empty() {
        needs.push("a window".to_owned());
        return;
    }
    let RuleReceiver::Window { group, all_of, .. } = &rule.receiver else { return };
    let mut lacking: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for window in &site.windows {
        let mut needed = needed_of_window(&rule.receiver, window);
        let of_dwellings = rule.dwelling.is_some() || *group == Some(Grouping::Dwelling);
        if (rule.dwelling.is_some() || *group == Some(Grouping::Room)) && window.room.is_none() {
            needed.push("the room");
        }
        if of_dwellings && window.dwelling.is_none() {
            needed.push("the dwelling");
        }
        if !all_of.is_empty() && window.usage.is_none() {
            needed.push("the use of the room");
        }
        if matches!(rule.dwelling, Some(DwellingShare::FloorArea(_))) && window.room_m2.is_none() {
            needed.push("the floor area of the room");
        }
        for what in needed {
            lacking.entry(what).or_default().push(format!("{:?}", window.name));
        }
    }
    for (what, windows) in lacking {
        let of = if windows.len() <= MOST_NAMES { windows.join(", ") } else { few(windows) };
        needs.push(format!("{what} of window {of}"));
    }
    of_uses(all_of, site, needs);
}

/// A dwelling that lacks one of the uses is an error; it does not pass.
fn of_uses(all_of: &[String], site: &JudgedSite, needs: &mut Vec<String>) {
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
            needs.push(format!("a window of use {usage:?} in dwelling {of}"));
        }
    }
}
