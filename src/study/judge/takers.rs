//! Who takes the sun: the shade of each component on a day, and the part of it that no other component shades.

use super::super::StudyError;
use super::days::{JudgedDays, time};
use super::judging::RuleOnSite;
use super::state_search::{StateSearch, WallPlane};
use crate::judgement::{Taker, spells_of};
use crate::rules::{Spell, common, merged, total_secs, without};
use crate::sun::{Air, Sky, SunError, delta_t_secs};
use crate::sunlight::JudgedPoint;
use glam::DVec3;
use rayon::prelude::*;
use std::collections::HashMap;

/// The time between the suns towards which components are sought, seconds.
const STEP_SECS: usize = 60;

/// More than the sun moves in half of that time, radians; boxes are widened by it.
const HALF_STEP_RAD: f64 = 0.0025;

/// A receiver on a day, lit while all of its points are.
pub(super) struct ShadedPoints {
    pub(super) points: Vec<JudgedPoint>,
    /// For each point, when a sun that counts would shine with nothing in its way.
    pub(super) open: Vec<Vec<Spell>>,
    /// The wall in front of which components can take the sun, if there is one.
    pub(super) wall: Option<WallPlane>,
}

/// A day with its suns.
pub(super) struct TakerDay<'a> {
    day: JudgedDays<'a>,
    suns: Vec<(i64, DVec3)>,
}

/// The components that may take the sun.
pub(super) struct TakerSearch<'a> {
    judging: &'a RuleOnSite<'a>,
    /// The casting components, each with its box.
    boxes: Vec<(u32, [DVec3; 2])>,
    reach: Vec<DVec3>,
    /// The searches made so far, by component.
    searches: HashMap<u32, StateSearch>,
}

impl<'a> TakerDay<'a> {
    /// The suns of one day.
    pub(super) fn new(judging: &RuleOnSite<'_>, day: JudgedDays<'a>) -> Result<TakerDay<'a>, SunError> {
        let site = judging.site;
        let air = site.refraction.then(|| Air::standard(site.place.elevation_m));
        let mut suns = Vec::new();
        for window in &day.windows[0] {
            let from = time(&site.place, window.start);
            let sky = Sky { place: &site.place, delta_t_secs: delta_t_secs(from.to_utc())?, air };
            for secs in (window.start..window.end).step_by(STEP_SECS) {
                suns.push((secs, sky.at(time(&site.place, secs))?.to_sun));
            }
        }
        Ok(TakerDay { day, suns })
    }
}

impl<'a> TakerSearch<'a> {
    /// A search for points within the bounds of these.
    pub(super) fn new(judging: &'a RuleOnSite<'a>, reach: Vec<DVec3>) -> TakerSearch<'a> {
        let site = judging.site;
        let mesh = &*site.now.mesh;
        let boxes = (0u32..)
            .zip(&mesh.components)
            .zip(&site.now.casts)
            .filter(|(_, casts)| **casts)
            .filter_map(|((at, component), _)| {
                let (low, high) = mesh.bounds_of(component.faces.clone())?;
                Some((at, [low, high]))
            })
            .collect();
        TakerSearch { judging, boxes, reach, searches: HashMap::new() }
    }

    /// Finds who takes the sun of a receiver on a day, the greatest taker first.
    pub(super) fn takers(
        &mut self,
        day: &TakerDay<'_>,
        of: &ShadedPoints,
        shaded: &[Spell],
    ) -> Result<Vec<Taker>, StudyError> {
        let candidates = self.candidates(day, of, shaded);
        let missing: Vec<u32> = candidates.iter().copied().filter(|at| !self.searches.contains_key(at)).collect();
        let state = &self.judging.site.now;
        let built: Vec<_> =
            missing.par_iter().map(|at| (*at, StateSearch::of_component(state, *at, &self.reach))).collect();
        self.searches.extend(built);
        // for each point, the shade of each candidate by itself
        let shades: Vec<Vec<Vec<Spell>>> = of
            .points
            .iter()
            .zip(&of.open)
            .map(|(point, open)| {
                candidates
                    .par_iter()
                    .map(|at| self.shade(day, (*at, of.wall), point, open))
                    .collect::<Result<_, SunError>>()
            })
            .collect::<Result<_, _>>()?;
        let mut takers = Vec::new();
        for (number, component) in candidates.iter().enumerate() {
            let all = merged(shades.iter().flat_map(|point| point[number].iter().copied()));
            let taken = common(&all, shaded);
            if taken.is_empty() {
                continue;
            }
            // still dark where other components shade any of the points
            let others = |point: &Vec<Vec<Spell>>| -> Vec<Spell> {
                let others = point.iter().enumerate().filter(|(at, _)| *at != number);
                others.flat_map(|(_, spells)| spells.iter().copied()).collect()
            };
            let others = merged(shades.iter().flat_map(others));
            let alone_secs = total_secs(&without(&taken, &others)) as f64;
            let with_others_secs = total_secs(&taken) as f64 - alone_secs;
            takers.push(Taker { component: *component, alone_secs, with_others_secs });
        }
        sort(&mut takers);
        Ok(takers)
    }

    /// The spells in which a point would be in a component's shade if nothing else stood.
    fn shade(
        &self,
        day: &TakerDay<'_>,
        (component, wall): (u32, Option<WallPlane>),
        point: &JudgedPoint,
        open: &[Spell],
    ) -> Result<Vec<Spell>, SunError> {
        let lit = self.searches[&component].lit_before((point, wall), &day.day, &[open.to_vec()])?;
        Ok(without(open, &spells_of(&lit[0])))
    }

    /// The components whose boxes stand in front of the sun in these spells.
    fn candidates(&self, day: &TakerDay<'_>, of: &ShadedPoints, shaded: &[Spell]) -> Vec<u32> {
        let step = STEP_SECS as i64;
        let is_shaded = |secs: i64| shaded.iter().any(|spell| spell.start - step <= secs && secs < spell.end + step);
        let suns: Vec<DVec3> =
            day.suns.iter().filter(|(secs, _)| is_shaded(*secs)).map(|(_, to_sun)| *to_sun).collect();
        let stands = |(_, bounds): &&(u32, [DVec3; 2])| {
            of.points.iter().any(|at| {
                let wide = widened(bounds, at.point);
                suns.iter().any(|to_sun| meets(&wide, at.point, *to_sun))
            })
        };
        self.boxes.par_iter().filter(stands).map(|(at, _)| *at).collect()
    }
}

/// Sorts takers, the greatest first: by what each takes alone, then by what it takes in all.
pub(super) fn sort(takers: &mut [Taker]) {
    let all = |taker: &Taker| taker.alone_secs + taker.with_others_secs;
    takers.sort_by(|one, other| {
        other
            .alone_secs
            .total_cmp(&one.alone_secs)
            .then(all(other).total_cmp(&all(one)))
            .then(one.component.cmp(&other.component))
    });
}

fn widened([low, high]: &[DVec3; 2], point: DVec3) -> [DVec3; 2] {
    let far = (low - point).abs().max((high - point).abs()).length();
    let by = DVec3::splat(far * HALF_STEP_RAD + 0.01);
    [low - by, high + by]
}

/// Whether a ray meets a box.
fn meets([low, high]: &[DVec3; 2], from: DVec3, along: DVec3) -> bool {
    let (one, other) = ((low - from) / along, (high - from) / along);
    // if the ray runs within a side's plane, the quotient is not a number, and that side cuts nothing off
    let near = one.min(other).to_array().into_iter().filter(|at| !at.is_nan()).fold(0.0, f64::max);
    let far = one.max(other).to_array().into_iter().filter(|at| !at.is_nan()).fold(f64::INFINITY, f64::min);
    near <= far
}
