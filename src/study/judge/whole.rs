//! The verdict over all receivers, and what is reported with it.

use super::super::StudyError;
use super::days::JudgedDays;
use super::judging::{RuleOnSite, Steps};
use super::open_spaces::of_dwellings;
use super::receivers::{ShadedReceiver, deciding_day};
use super::takers::{ShadedPoints, TakerDay, TakerSearch, sort};
use crate::judgement::{GroupKind, GroupRuling, JudgedThing, ReceiverRuling, Taker};
use crate::message::{Message, few};
use crate::rules::{CompareWith, Finding, ResolvedRule, RuleDay, RuleReceiver, Ruling, Verdict, without};
use crate::sun::DayWindow;
use glam::DVec3;
use std::collections::{BTreeMap, HashMap};

/// For each day, the verdict over everything that is judged on it.
pub(super) fn day_verdicts(
    rule: &ResolvedRule,
    days: &[RuleDay],
    receivers: &[ReceiverRuling],
    groups: &[GroupRuling],
) -> Vec<Verdict> {
    // where windows are added up, their rooms are judged in their place
    let of_rooms: Vec<&Ruling> =
        groups.iter().filter(|group| group.kind == GroupKind::Room).filter_map(|group| group.ruling.as_ref()).collect();
    let rulings: Vec<&Ruling> =
        if of_rooms.is_empty() { receivers.iter().map(|receiver| &receiver.ruling).collect() } else { of_rooms };
    let graded = rule.criteria.iter().any(|criterion| criterion.grade.is_some());
    let of_ruling = |ruling: &Ruling, day: &RuleDay| {
        let on_day: Vec<&Finding> = ruling.findings.iter().filter(|finding| finding.date == Some(day.date)).collect();
        match on_day.as_slice() {
            [] => Verdict::Report,
            [first, ..] if graded => first.verdict,
            findings if rule.any => Verdict::any(findings.iter().map(|finding| finding.verdict)),
            findings => Verdict::all(findings.iter().map(|finding| finding.verdict)),
        }
    };
    days.iter().map(|day| Verdict::all(rulings.iter().map(|ruling| of_ruling(ruling, day)))).collect()
}

/// The lowest grade of all; a dwelling has the grade of its best room.
pub(super) fn grade(
    rule: &ResolvedRule,
    verdict: Verdict,
    receivers: &[ReceiverRuling],
    groups: &[GroupRuling],
) -> Option<String> {
    if verdict != Verdict::Pass {
        return None;
    }
    let step = |ruling: &Ruling| {
        let grade = ruling.grade.as_ref()?;
        rule.criteria.iter().position(|criterion| criterion.grade.as_ref() == Some(grade))
    };
    let rooms = || groups.iter().filter(|group| group.kind == GroupKind::Room);
    let of_room = |group: &GroupRuling| group.ruling.as_ref().and_then(step);
    let dwellings = groups.iter().filter(|group| group.kind == GroupKind::Dwelling);
    let of_dwellings: Vec<Option<usize>> = dwellings
        .map(|dwelling| rooms().filter(|room| room.dwelling.as_ref() == Some(&dwelling.name)).filter_map(of_room).max())
        .collect();
    let steps: Vec<Option<usize>> = match (of_dwellings.is_empty(), rooms().count()) {
        (false, _) => of_dwellings,
        (true, 0) => receivers.iter().map(|receiver| step(&receiver.ruling)).collect(),
        (true, _) => rooms().map(of_room).collect(),
    };
    let lowest = steps.into_iter().collect::<Option<Vec<usize>>>()?.into_iter().min()?;
    rule.criteria[lowest].grade.clone()
}

/// Finds who takes the sun of the receivers that do not pass, on the deciding day.
pub(super) fn with_takers(
    judging: &RuleOnSite<'_>,
    hulls: &[DayWindow],
    receivers: &mut [(ReceiverRuling, ShadedReceiver)],
    steps: &mut Steps<'_, '_>,
) -> Result<(), StudyError> {
    let mut by_day: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    let mut reach: Vec<DVec3> = Vec::new();
    for (number, (receiver, shaded)) in receivers.iter().enumerate() {
        if receiver.ruling.verdict != Verdict::Pass {
            by_day.entry(deciding_day(judging, receiver)).or_default().push(number);
            reach.extend(shaded.parts.iter().flat_map(|part| &part.points).map(|at| at.point));
        }
    }
    let mut search = TakerSearch::new(judging, reach);
    for (day, numbers) in by_day {
        let of_day =
            JudgedDays::new(judging.site, judging.rule.cuts, &judging.days.days[day..=day], &hulls[day..=day])?;
        let of_day = TakerDay::new(judging, of_day)?;
        for number in numbers {
            let (receiver, shaded) = &mut receivers[number];
            receiver.takers = takers(&mut search, shaded, (day, &of_day))?;
            steps.poll()?;
        }
    }
    Ok(())
}

/// The takers of a receiver, with the mean over its parts.
fn takers(
    search: &mut TakerSearch<'_>,
    shaded: &ShadedReceiver,
    (day, of_day): (usize, &TakerDay<'_>),
) -> Result<Vec<Taker>, StudyError> {
    let mut sums: HashMap<u32, [f64; 2]> = HashMap::new();
    for part in &shaded.parts {
        let open = part.open[day].clone();
        let dark = without(&open, &part.lit[day]);
        let points =
            ShadedPoints { points: part.points.clone(), open: vec![open; part.points.len()], wall: shaded.wall };
        for taker in search.takers(of_day, &points, &dark)? {
            let sum = sums.entry(taker.component).or_default();
            sum[0] += taker.alone_secs;
            sum[1] += taker.with_others_secs;
        }
    }
    let parts = shaded.parts.len().max(1) as f64;
    let of = |(component, [alone, with]): (u32, [f64; 2])| Taker {
        component,
        alone_secs: alone / parts,
        with_others_secs: with / parts,
    };
    let mut takers: Vec<Taker> = sums.into_iter().map(of).collect();
    sort(&mut takers);
    Ok(takers)
}

/// Notes on how the site was judged.
pub(super) fn notes(judging: &RuleOnSite<'_>, receivers: &[ReceiverRuling], neighbours: &[String]) -> Vec<Message> {
    let mut notes: Vec<String> = Vec::new();
    let site = judging.site;
    match &judging.rule.receiver {
        RuleReceiver::Area { least_width_m } => {
            let narrow = |receiver: &ReceiverRuling| {
                let m2 = receiver.area.map_or(0.0, |area| area.narrow_m2);
                (m2 > 0.0).then(|| format!("{m2:.2} m² of {:?}", receiver.name))
            };
            let narrow: Vec<String> = receivers.iter().filter_map(narrow).collect();
            if !narrow.is_empty() {
                let of = few(narrow);
                notes.push(format!("parts narrower than {least_width_m} m do not count, and are left out: {of}"));
            }
        }
        receiver @ RuleReceiver::Window { open_spaces, .. } => {
            let others = site.areas.len() - of_dwellings(receiver, site).len();
            if open_spaces.is_some() && others > 0 {
                let areas = if others == 1 { "1 area has".to_owned() } else { format!("{others} areas have") };
                notes.push(format!("{areas} no dwelling, and this rule does not judge them"));
            }
            notes.extend(note_spaces(receivers));
            let inside = receivers.iter().any(|receiver| receiver.kind == JudgedThing::Window)
                && site.windows.iter().any(|window| is_inside(judging, window));
            if inside {
                notes.push(
                    "a point inside sees the sun through the rectangle of its glass, carried to the wall's outer plane; what \
                     the models have behind that plane casts no shadow on it"
                        .to_owned(),
                );
            }
        }
        RuleReceiver::Lines { .. } if !neighbours.is_empty() => {
            let count = neighbours.len();
            let of = if count == 1 { "1 component".to_owned() } else { format!("{count} components") };
            let names = few(neighbours.to_vec());
            notes.push(format!(
                "only what stands on the plot counts: the shadow of {of} beside it is left out ({names})"
            ));
        }
        RuleReceiver::Lines { .. } => {}
        RuleReceiver::Facade => {}
    }
    if judging.rule.compare == Some(CompareWith::Reference) {
        notes.push("no lawful body is compared, so no number is excused because of one".to_owned());
    }
    if receivers.iter().any(|receiver| receiver.ruling.verdict == Verdict::Close) {
        notes.push(
            "where a number differs from its limit by less than its error, the verdict is close: neither kept nor missed"
                .to_owned(),
        );
    }
    notes.into_iter().map(Message::from).collect()
}

/// How exactly the spells of open spaces are known.
fn note_spaces(receivers: &[ReceiverRuling]) -> Option<String> {
    let fewest = receivers.iter().filter_map(|receiver| receiver.area).map(|area| area.points).min()?;
    Some(format!(
        "when enough of an open space is lit is found at {fewest} points or more of it, about to a hundredth of its area: its \
         spells may be some seconds off"
    ))
}

fn is_inside(judging: &RuleOnSite<'_>, window: &crate::site::JudgedWindow) -> bool {
    crate::judgement::window_spot(&judging.rule.receiver, window).is_some_and(|spot| spot.through.is_some())
}
