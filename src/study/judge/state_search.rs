//! One state of a site, prepared for the search of points.

use super::super::ground_heights::GroundHeights;
use super::days::JudgedDays;
use crate::judgement::{LitSpell, SpellBound, clipped};
use crate::rules::Spell;
use crate::shadow::JUDGED_ABOVE_M;
use crate::site::JudgedState;
use crate::sun::SunError;
use crate::sunlight::{Interval, IntervalBound, JudgedPoint, ProbeSearch, WallFront};
use glam::DVec3;

/// A face that is no farther in front of a plane than this belongs to the wall in the plane, metres.
const IN_PLANE_M: f64 = 0.005;

/// The casters of a state, and its ground.
pub(super) struct StateSearch {
    search: ProbeSearch,
    /// For each component of the casters, its index in the state's mesh.
    components: Vec<u32>,
    ground: GroundHeights,
}

/// A plane of any slope: its normal, and its distance from the origin along the normal.
pub(super) type WallPlane = (DVec3, f64);

impl StateSearch {
    /// A search for points within the bounds of these.
    pub(super) fn of(state: &JudgedState, points: &[DVec3]) -> StateSearch {
        StateSearch::with(state, ProbeSearch::new(state.mesh.of_components(&state.casts), &reach(points)), points)
    }

    /// A search with a single component. It has no terrain, as its points have been placed already.
    pub(super) fn of_component(state: &JudgedState, component: u32, points: &[DVec3]) -> StateSearch {
        let keep: Vec<bool> = (0..state.mesh.components.len()).map(|at| at == component as usize).collect();
        let search = ProbeSearch::new(state.mesh.of_components(&keep), &reach(points));
        StateSearch { search, components: vec![component], ground: GroundHeights::plane(state.ground.level) }
    }

    /// Searches of two states, for points within the bounds of these.
    pub(super) fn of_both(states: [&JudgedState; 2], points: &[DVec3]) -> [StateSearch; 2] {
        let casters = states.map(|state| state.mesh.of_components(&state.casts));
        let [now, before] = ProbeSearch::two(casters, &reach(points));
        let [of_now, of_before] = states;
        [StateSearch::with(of_now, now, points), StateSearch::with(of_before, before, points)]
    }

    fn with(state: &JudgedState, search: ProbeSearch, points: &[DVec3]) -> StateSearch {
        let components = (0..).zip(&state.casts).filter(|(_, casts)| **casts).map(|(at, _)| at).collect();
        StateSearch { search, components, ground: GroundHeights::of(&state.mesh, &state.ground, points) }
    }

    /// A point on a plane, judged a millimetre in front of it.
    pub(super) fn in_plane(&self, point: DVec3, normal: DVec3) -> JudgedPoint {
        self.ground.judge(point + normal * JUDGED_ABOVE_M, Some(normal))
    }

    /// A point in the air or inside an opening, judged where it is.
    pub(super) fn free(&self, point: DVec3, normal: Option<DVec3>) -> JudgedPoint {
        self.ground.judge(point, normal)
    }

    /// A point on a level plane, judged a millimetre above it.
    pub(super) fn at_level(&self, point: DVec3) -> JudgedPoint {
        self.free(point + DVec3::Z * JUDGED_ABOVE_M, None)
    }

    /// A point at this height above the ground, judged a millimetre higher.
    pub(super) fn above_ground(&self, point: DVec3, above_m: f64) -> JudgedPoint {
        self.free(point.with_z(self.ground.height(point) + above_m + JUDGED_ABOVE_M), None)
    }

    /// When a point is in the sun within the spells of each day, with what bounds each stretch.
    pub(super) fn lit(
        &self,
        at: &JudgedPoint,
        days: &JudgedDays<'_>,
        open: &[Vec<Spell>],
    ) -> Result<Vec<Vec<LitSpell>>, SunError> {
        self.lit_before((at, None), days, open)
    }

    /// The same. If a wall is given, only what lies in front of it takes the sun: the wall, and what stands behind its
    /// outer side, are left out.
    pub(super) fn lit_before(
        &self,
        (at, wall): (&JudgedPoint, Option<WallPlane>),
        days: &JudgedDays<'_>,
        open: &[Vec<Spell>],
    ) -> Result<Vec<Vec<LitSpell>>, SunError> {
        let intervals = days.intervals(&self.search, (at, wall.map(front)))?;
        Ok(self.spells(intervals, days, open))
    }

    /// The same in two states.
    pub(super) fn lit_in_both(
        searches: [&StateSearch; 2],
        (at, wall): ([&JudgedPoint; 2], Option<WallPlane>),
        days: &JudgedDays<'_>,
        open: &[Vec<Spell>],
    ) -> Result<[Vec<Vec<LitSpell>>; 2], SunError> {
        let [now, before] = searches;
        let [of_now, of_before] = days.intervals_in_both([&now.search, &before.search], (at, wall.map(front)))?;
        Ok([now.spells(of_now, days, open), before.spells(of_before, days, open)])
    }

    fn spells(&self, intervals: Vec<Vec<Interval>>, days: &JudgedDays<'_>, open: &[Vec<Spell>]) -> Vec<Vec<LitSpell>> {
        let of_day = |((found, windows), open): ((Vec<Interval>, &Vec<Spell>), &Vec<Spell>)| {
            let lit: Vec<LitSpell> = found.iter().map(|interval| self.spell(interval)).collect();
            clipped(&clipped(&lit, windows, SpellBound::Window), open, SpellBound::Cut)
        };
        intervals.into_iter().zip(&days.windows).zip(open).map(of_day).collect()
    }

    fn spell(&self, interval: &Interval) -> LitSpell {
        let bound = |bound: IntervalBound| match bound {
            IntervalBound::Window => SpellBound::Window,
            IntervalBound::Horizon => SpellBound::Horizon,
            IntervalBound::Behind => SpellBound::Behind,
            IntervalBound::Ground => SpellBound::Ground,
            IntervalBound::Component(at) => SpellBound::Component(self.components[at]),
        };
        LitSpell {
            spell: Spell::new(interval.start.timestamp(), interval.end.timestamp()),
            before: bound(interval.before),
            after: bound(interval.after),
        }
    }
}

/// Points in the form from which a search takes their bounds.
fn reach(points: &[DVec3]) -> Vec<JudgedPoint> {
    points.iter().map(|point| JudgedPoint { point: *point, normal: None, below_ground_m: None }).collect()
}

fn front((normal, along_m): WallPlane) -> WallFront {
    WallFront { normal, along_m: along_m + IN_PLANE_M }
}
