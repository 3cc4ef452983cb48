//! Rooms, dwellings and the house.

use super::super::StudyError;
use super::point_light::{CountedLight, PointLight};
use super::windows::WindowLight;
use crate::judgement::{GroupKind, GroupRuling};
use crate::rules::{
    CountedTime, Criterion, Demand, DwellingSun, Extent, Grouping, ResolvedRule, RoomRuling, RuleDay, RuleReceiver,
    Ruling, Verdict,
};
use crate::site::JudgedWindow;

/// The rooms of all dwellings, in the order of their first windows.
struct Room<'a> {
    name: &'a str,
    dwelling: Option<&'a str>,
    windows: Vec<usize>,
}

/// All windows of a site, judged one by one.
pub(super) struct WindowRulings<'a> {
    pub(super) rule: &'a ResolvedRule,
    pub(super) days: &'a [RuleDay],
    pub(super) windows: &'a [JudgedWindow],
    pub(super) lights: &'a [WindowLight],
    /// The dwelling and the light of each open space.
    pub(super) open_spaces: &'a [(String, PointLight)],
    pub(super) rulings: &'a [Ruling],
}

/// The groups of a rule for windows; empty if it judges each window by itself.
pub(super) fn groups(judged: &WindowRulings<'_>) -> Result<Vec<GroupRuling>, StudyError> {
    let RuleReceiver::Window { group, all_of, .. } = &judged.rule.receiver else { return Ok(Vec::new()) };
    let mut groups = Vec::new();
    if *group == Some(Grouping::Room) || judged.rule.dwelling.is_some() {
        groups = rooms(judged)?;
    }
    if judged.rule.dwelling.is_some() {
        let dwellings = dwellings(judged, &groups)?;
        groups.extend(dwellings);
    }
    if judged.rule.criteria.iter().any(Criterion::is_of_dwellings) {
        groups.extend(house(judged, all_of)?);
    }
    Ok(groups)
}

/// The verdict over all groups of the widest kind.
pub(super) fn of_groups(groups: &[GroupRuling]) -> Option<Verdict> {
    let of = |kind: GroupKind| {
        let verdicts: Vec<Verdict> =
            groups.iter().filter(|group| group.kind == kind).map(|group| group.verdict).collect();
        (!verdicts.is_empty()).then(|| Verdict::all(verdicts))
    };
    of(GroupKind::House).or_else(|| of(GroupKind::Dwelling)).or_else(|| of(GroupKind::Room))
}

fn rooms(judged: &WindowRulings<'_>) -> Result<Vec<GroupRuling>, StudyError> {
    let is_union = matches!(&judged.rule.receiver, RuleReceiver::Window { group: Some(Grouping::Room), .. });
    let mut rooms: Vec<Room<'_>> = Vec::new();
    for (at, window) in judged.windows.iter().enumerate() {
        let Some(name) = window.room.as_deref() else { continue };
        let dwelling = window.dwelling.as_deref();
        match rooms.iter_mut().find(|room| room.name == name && room.dwelling == dwelling) {
            Some(room) => room.windows.push(at),
            None => rooms.push(Room { name, dwelling, windows: vec![at] }),
        }
    }
    let mut groups = Vec::new();
    for room in rooms {
        let ruling =
            is_union.then(|| union(judged, &room.windows).ruling(judged.rule, None, judged.days)).transpose()?;
        // if the rule does not add up windows, one of them is enough for the room
        let of_windows = || Verdict::any(room.windows.iter().map(|at| judged.rulings[*at].verdict));
        groups.push(GroupRuling {
            name: room.name.to_owned(),
            kind: GroupKind::Room,
            dwelling: room.dwelling.map(str::to_owned),
            verdict: ruling.as_ref().map_or_else(of_windows, |ruling| ruling.verdict),
            ruling,
            by_rooms: None,
            of: room.windows.iter().map(|at| judged.windows[*at].name.clone()).collect(),
            uses: Vec::new(),
        });
    }
    Ok(groups)
}

/// The light of several windows together: lit while any of them is.
fn union(judged: &WindowRulings<'_>, windows: &[usize]) -> CountedLight {
    together(judged, windows.iter().map(|at| &judged.lights[*at].light))
}

fn together<'l>(judged: &WindowRulings<'_>, lights: impl Iterator<Item = &'l PointLight>) -> CountedLight {
    let lights: Vec<CountedLight> = lights.map(PointLight::counted).collect();
    CountedLight::any(&lights.iter().collect::<Vec<_>>(), judged.days.len())
}

fn dwellings(judged: &WindowRulings<'_>, rooms: &[GroupRuling]) -> Result<Vec<GroupRuling>, StudyError> {
    let mut names: Vec<&str> = Vec::new();
    for room in rooms {
        if let Some(dwelling) = room.dwelling.as_deref()
            && !names.contains(&dwelling)
        {
            names.push(dwelling);
        }
    }
    let floor_m2 = |room: &GroupRuling| {
        let of_room = |window: &&JudgedWindow| {
            window.room.as_deref() == Some(&*room.name) && window.dwelling == room.dwelling && window.room_m2.is_some()
        };
        judged.windows.iter().find(of_room).and_then(|window| window.room_m2).unwrap_or(0.0)
    };
    let mut groups = Vec::new();
    for name in names {
        let own: Vec<&GroupRuling> = rooms.iter().filter(|room| room.dwelling.as_deref() == Some(name)).collect();
        let rulings: Vec<RoomRuling> =
            own.iter().map(|room| RoomRuling { verdict: room.verdict, floor_m2: floor_m2(room) }).collect();
        let by_rooms = judged.rule.judge_dwelling(&rulings)?;
        groups.push(GroupRuling {
            name: name.to_owned(),
            kind: GroupKind::Dwelling,
            dwelling: None,
            verdict: by_rooms.as_ref().map_or(Verdict::Report, |ruling| ruling.verdict),
            ruling: None,
            by_rooms,
            of: own.iter().map(|room| room.name.clone()).collect(),
            uses: Vec::new(),
        });
    }
    Ok(groups)
}

/// The dwellings that windows and open spaces belong to, in their order.
fn dwelling_names<'a>(judged: &WindowRulings<'a>) -> Vec<&'a str> {
    let mut names: Vec<&str> = Vec::new();
    let of_windows = judged.windows.iter().filter_map(|window| window.dwelling.as_deref());
    for dwelling in of_windows.chain(judged.open_spaces.iter().map(|(dwelling, _)| dwelling.as_str())) {
        if !names.contains(&dwelling) {
            names.push(dwelling);
        }
    }
    names
}

/// Judges the house by its dwellings, each with its uses.
fn house(judged: &WindowRulings<'_>, all_of: &[String]) -> Result<Vec<GroupRuling>, StudyError> {
    let names = dwelling_names(judged);
    let RuleReceiver::Window { open_spaces, .. } = &judged.rule.receiver else { return Ok(Vec::new()) };
    let criteria: Vec<usize> =
        (0..judged.rule.criteria.len()).filter(|number| judged.rule.criteria[*number].is_of_dwellings()).collect();
    let mut counted: Vec<Vec<DwellingSun>> = vec![Vec::new(); criteria.len()];
    let mut groups = Vec::new();
    for name in &names {
        let mut uses: Vec<Vec<(String, i64)>> = vec![Vec::new(); criteria.len()];
        let mut of = Vec::new();
        for usage in all_of {
            let is_own = |window: &JudgedWindow| {
                window.dwelling.as_deref() == Some(name) && window.usage.as_ref() == Some(usage)
            };
            let windows: Vec<usize> = (0..judged.windows.len()).filter(|at| is_own(&judged.windows[*at])).collect();
            of.extend(windows.iter().map(|at| judged.windows[*at].name.clone()));
            let is_open_space = open_spaces.as_ref().is_some_and(|spaces| spaces.usage == *usage);
            let spaces = judged.open_spaces.iter().filter(|(dwelling, _)| is_open_space && dwelling == name);
            let spaces: Vec<&PointLight> = spaces.map(|(_, light)| light).collect();
            if windows.is_empty() && spaces.is_empty() {
                continue;
            }
            let of_windows = windows.iter().map(|at| &judged.lights[*at].light);
            let light = together(judged, of_windows.chain(spaces));
            for (at, number) in criteria.iter().enumerate() {
                uses[at].push((usage.clone(), least_secs(judged, &light, *number)?));
            }
        }
        let [first, ..] = uses.as_slice() else { continue };
        groups.push(GroupRuling {
            name: (*name).to_owned(),
            kind: GroupKind::Dwelling,
            dwelling: None,
            verdict: of_uses(judged.rule, first),
            ruling: None,
            by_rooms: None,
            of,
            uses: first.clone(),
        });
        for (counted, uses) in counted.iter_mut().zip(uses) {
            counted.push(DwellingSun { name: (*name).to_owned(), uses });
        }
    }
    let ruling = judged.rule.judge_house(&counted)?;
    groups.push(GroupRuling {
        name: String::new(),
        kind: GroupKind::House,
        dwelling: None,
        verdict: ruling.verdict,
        ruling: Some(ruling),
        by_rooms: None,
        of: names.into_iter().map(str::to_owned).collect(),
        uses: Vec::new(),
    });
    Ok(groups)
}

/// The verdict on a dwelling by its uses: whether each has the sun that the rule asks of a share of the dwellings.
fn of_uses(rule: &ResolvedRule, uses: &[(String, i64)]) -> Verdict {
    let of = |criterion: &Criterion| match (&criterion.extent, &criterion.demand) {
        (Extent::Dwellings(_), Demand::AtLeast { secs, .. }) => Some(*secs),
        _ => None,
    };
    let Some(least) = rule.criteria.iter().find_map(of) else { return Verdict::Report };
    if uses.iter().all(|(_, secs)| *secs >= least) { Verdict::Pass } else { Verdict::Fail }
}

/// The number that a criterion counts, on the day with the least.
fn least_secs(judged: &WindowRulings<'_>, light: &CountedLight, number: usize) -> Result<i64, StudyError> {
    debug_assert!(judged.rule.counting.what == CountedTime::Sun);
    let mut least = i64::MAX;
    for day in light.days(judged.days) {
        if day.day.criteria[number].is_some() {
            least = least.min(judged.rule.tally(number, &day)?.secs);
        }
    }
    Ok(if least == i64::MAX { 0 } else { least })
}
