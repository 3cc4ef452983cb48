//! Open spaces of dwellings: areas that a rule counts beside windows. One is lit while enough of it is.

use super::super::StudyError;
use super::area_light::{AreaPlace, reach_of};
use super::judging::{RuleOnSite, Steps};
use super::point_light::PointLight;
use super::samples::{AreaSpot, Samples};
use crate::judgement::{AreaSize, CountedParts, JudgedThing, LitSpell, ReceiverRuling};
use crate::rules::{OpenSpaces, RuleReceiver, Spell, merged};
use crate::site::{JudgedArea, JudgedSite};
use crate::sun::SunError;
use glam::DVec3;
use rayon::prelude::*;

/// The greatest side of the triangles, as a part of the side of a square with the area's size.
const SIDES_ACROSS: f64 = 16.0;

/// An open space, judged.
pub(super) struct OpenSpace {
    pub(super) dwelling: String,
    pub(super) light: PointLight,
    pub(super) receiver: ReceiverRuling,
}

/// The areas of a site that a rule for windows counts as open spaces of dwellings.
pub(super) fn of_dwellings<'s>(receiver: &RuleReceiver, site: &'s JudgedSite) -> Vec<&'s JudgedArea> {
    match receiver {
        RuleReceiver::Window { open_spaces: Some(_), .. } => {
            site.areas.iter().filter(|area| area.dwelling.is_some()).collect()
        }
        _ => Vec::new(),
    }
}

/// When each open space is lit.
pub(super) fn open_spaces(judging: &RuleOnSite<'_>, steps: &mut Steps<'_, '_>) -> Result<Vec<OpenSpace>, StudyError> {
    let RuleReceiver::Window { open_spaces: Some(of), .. } = &judging.rule.receiver else { return Ok(Vec::new()) };
    let areas = of_dwellings(&judging.rule.receiver, judging.site);
    if areas.is_empty() {
        return Ok(Vec::new());
    }
    let states: Vec<_> = std::iter::once(&judging.site.now).chain(judging.before).collect();
    let searches = judging.states(&reach_of(&judging.site.areas, &states));
    let mut found = Vec::new();
    for area in areas {
        let parts = CountedParts::of(&judging.rule.receiver, area);
        let place = AreaPlace::new(judging, &searches, &area.surface, &parts.triangles);
        found.push(open_space(judging, (of, area), (&parts, &place), steps)?);
        steps.done(1)?;
    }
    Ok(found)
}

fn open_space(
    judging: &RuleOnSite<'_>,
    (of, area): (&OpenSpaces, &JudgedArea),
    (parts, place): (&CountedParts, &AreaPlace<'_>),
    steps: &mut Steps<'_, '_>,
) -> Result<OpenSpace, StudyError> {
    const TOGETHER: usize = 256;
    let m2 = parts.m2();
    let samples = Samples::new(&parts.triangles, (m2.sqrt() / SIDES_ACROSS).max(1e-3));
    let (spots, shares_m2) = samples.spot_in_each();
    let mut lights: Vec<PointLight> = Vec::with_capacity(spots.len());
    for some in spots.chunks(TOGETHER) {
        let light = |spot: &AreaSpot| place.light(spot);
        lights.extend(some.par_iter().map(light).collect::<Result<Vec<_>, SunError>>()?);
        steps.poll()?;
    }
    let light = together(&shares_m2, &lights, of.least_lit_m2.min(m2), judging.days.days.len());
    let counted = light.counted();
    let middle = spots.iter().zip(&shares_m2).map(|(spot, m2)| spot.at * *m2).sum::<DVec3>() / m2;
    let away = |spot: &&AreaSpot| spot.at.distance(middle);
    let spot = spots.iter().min_by(|one, other| away(one).total_cmp(&away(other)));
    let receiver = ReceiverRuling {
        name: area.name.clone(),
        kind: JudgedThing::Area,
        ruling: counted.ruling(judging.rule, None, judging.days.days)?,
        area: Some(AreaSize {
            m2,
            narrow_m2: parts.narrow_m2,
            points: lights.len(),
            error_m2: 0.0,
            error_m2_secs: None,
            apart_m: None,
        }),
        points: spot.iter().map(|spot| place.judged_now(spot).point).collect(),
        normal: spot.and_then(|spot| spot.normal),
        room: None,
        dwelling: area.dwelling.clone(),
        usage: Some(of.usage.clone()),
        counts: counted.counts(judging.rule, judging.days.days),
        spells: Vec::new(),
        takers: Vec::new(),
    };
    Ok(OpenSpace { dwelling: area.dwelling.clone().unwrap_or_default(), light, receiver })
}

/// The light of an area: while at least so many of its square metres are lit.
fn together(shares_m2: &[f64], lights: &[PointLight], least_m2: f64, days: usize) -> PointLight {
    let lit = |of: &dyn Fn(&PointLight) -> &[Vec<LitSpell>]| -> Vec<Vec<LitSpell>> {
        let on = |day: usize| {
            let spells =
                shares_m2.iter().zip(lights).flat_map(|(m2, light)| of(light)[day].iter().map(move |of| (*m2, of)));
            lit_while(spells.collect(), least_m2)
        };
        (0..days).map(on).collect()
    };
    let open = |day: usize| -> Vec<Spell> { merged(lights.iter().flat_map(|light| light.open[day].iter().copied())) };
    let has_before = lights.iter().all(|light| light.before.is_some());
    PointLight {
        open: (0..days).map(open).collect(),
        now: lit(&|light| &light.now),
        before: has_before.then(|| lit(&|light| light.before.as_deref().unwrap_or_default())),
    }
}

/// The spells in which the sum of what is lit reaches a number of square metres, each bounded by what bounds the spell
/// that completes the sum, and the one without which it is incomplete.
fn lit_while(spells: Vec<(f64, &LitSpell)>, least_m2: f64) -> Vec<LitSpell> {
    let whole: f64 = spells.iter().map(|(m2, _)| m2).sum();
    // sums of many numbers are rounded
    let least_m2 = (least_m2 - 1e-9 * whole).max(1e-9 * whole);
    let starts = spells.iter().map(|(m2, of)| (of.spell.start, *m2, of.before));
    let ends = spells.iter().map(|(m2, of)| (of.spell.end, -*m2, of.after));
    let mut changes: Vec<_> = starts.chain(ends).collect();
    // at one time what begins comes before what ends: neighbours that take turns leave no gap
    changes.sort_by(|one, other| one.0.cmp(&other.0).then(other.1.total_cmp(&one.1)));
    let (mut sum, mut open, mut found) = (0.0, None, Vec::new());
    for (secs, m2, bound) in changes {
        sum += m2;
        match open {
            None if m2 > 0.0 && sum >= least_m2 => open = Some((secs, bound)),
            Some((start, before)) if m2 < 0.0 && sum < least_m2 => {
                open = None;
                if start < secs {
                    found.push(LitSpell { spell: Spell::new(start, secs), before, after: bound });
                }
            }
            _ => {}
        }
    }
    found
}
