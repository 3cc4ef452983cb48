//! When points lie in the sun: rays at the instants of a grid, and halving between two of them that differ.
//!
//! A probe lies in sunlight where the sun is above the horizon, in front of the probe's plane if it has one, and a ray
//! to the sun's centre meets no caster; not below the ground. An interval of sun or of shade that is at least one step long holds an instant
//! of the grid, and so cannot be missed; a shorter one may be. Each change that is found is exact to the second.

use super::{Event, OnEvent, StudyError, note_models, tell};
use crate::mesh::Mesh;
use crate::shadow::JUDGED_ABOVE_M;
use crate::shadow::ray_cast::RayCaster;
use crate::site::{GroundKind, ProbeSite};
use crate::sun::{Air, DayWindow, Instant, Place, Sky, SunError, Zone, delta_t_secs};
use crate::sunlight::{Interval, IntervalBound, ProbeIntervals, SunDay, Sunlight, judged};
use crate::view::Probe;
use chrono::{DateTime, TimeDelta};
use glam::DVec3;
use rayon::prelude::*;

/// The intervals in sunlight of all probes, on all days.
///
/// # Errors
/// [`StudyError`].
pub fn probe(asked: &ProbeSite, on_event: &mut OnEvent<'_>) -> Result<Sunlight, StudyError> {
    note_models(&asked.notes, on_event)?;
    let search = ProbeSearch::new(asked);
    let empty = |(probe, at): (&Probe, &JudgedPoint)| ProbeIntervals {
        probe: probe.clone(),
        below_ground_m: at.below_ground_m,
        days: Vec::new(),
    };
    let mut sunlight = Sunlight {
        step_secs: asked.step_secs,
        refraction: asked.refraction,
        days: Vec::new(),
        probes: asked.probes.iter().zip(&search.points).map(empty).collect(),
        components: search.casters.components.iter().map(|component| component.name.clone()).collect(),
    };

    let count = asked.days.len();
    tell(on_event, Event::Started { instants: count, tiles: 1 })?;
    // as many at a time as all processors have work for between two looks at the listener
    for windows in asked.days.chunks(4 * rayon::current_num_threads()) {
        let days: Vec<_> = windows.par_iter().map(|window| search.day(window)).collect::<Result<_, _>>()?;
        for (window, (up, found)) in windows.iter().zip(days) {
            let index = sunlight.days.len();
            sunlight.days.push(SunDay { window: window.clone(), up });
            sunlight.probes.iter_mut().zip(found).for_each(|(probed, intervals)| probed.days.push(intervals));
            tell(on_event, Event::Drawn { index, count, time: window.from, mask: None, bits: None })?;
        }
    }
    Ok(sunlight)
}

/// Where a probe is judged.
#[derive(Clone, Copy)]
struct JudgedPoint {
    point: DVec3,
    /// How far it lies below the ground, metres; none where it does not.
    below_ground_m: Option<f64>,
}

/// Where probes are judged: one on the terrain, as exactly as its heights are, a millimetre above it, as all receivers are.
fn judged_points(asked: &ProbeSite) -> Vec<JudgedPoint> {
    let terrain: Vec<bool> = match asked.ground.kind {
        GroundKind::Plane => Vec::new(),
        GroundKind::Terrain => asked.mesh.components.iter().map(|component| component.is_terrain).collect(),
    };
    let terrain = asked.mesh.of_components(&terrain);
    let top = terrain.top() + 1.0;
    let points = || asked.probes.iter().map(judged);
    let reach = points().map(|point| (point.with_z(top) - terrain.origin).abs().max_element());
    let rays = (!terrain.faces.is_empty()).then(|| RayCaster::new(&terrain, reach.fold(0.0, f64::max)));
    let height = |point: DVec3| {
        let (_, below) = rays.as_ref()?.first_hit(point.with_z(top) - terrain.origin, DVec3::NEG_Z)?;
        // a plane above the terrain hides it
        Some(top - below).filter(|height| *height >= asked.ground.level)
    };
    let judge = |point: DVec3| match height(point) {
        Some(height) if (point.z - height).abs() <= JUDGED_ABOVE_M => {
            JudgedPoint { point: point.with_z(height + JUDGED_ABOVE_M), below_ground_m: None }
        }
        height => {
            let below = height.unwrap_or(asked.ground.level) - point.z;
            JudgedPoint { point, below_ground_m: Some(below).filter(|below| *below > 0.0) }
        }
    };
    points().map(judge).collect()
}

/// What a day is searched with.
struct ProbeSearch<'a> {
    place: &'a Place,
    probes: &'a [Probe],
    step: TimeDelta,
    air: Option<Air>,
    /// Where the probes are judged.
    points: Vec<JudgedPoint>,
    casters: Mesh,
    rays: RayCaster,
}

impl ProbeSearch<'_> {
    fn new(asked: &ProbeSite) -> ProbeSearch<'_> {
        let casters = asked.mesh.of_components(&asked.casts);
        let points = judged_points(asked);
        let reach = points.iter().map(|at| (at.point - casters.origin).abs().max_element());
        let rays = RayCaster::new(&casters, reach.fold(0.0, f64::max));
        ProbeSearch {
            place: &asked.place,
            probes: &asked.probes,
            step: TimeDelta::seconds(asked.step_secs.into()),
            air: asked.refraction.then(|| Air::standard(asked.place.elevation_m)),
            points,
            casters,
            rays,
        }
    }

    /// When the sun is up within a window, and each probe's intervals.
    fn day(&self, window: &DayWindow) -> Result<(Vec<Interval>, Vec<Vec<Interval>>), SunError> {
        let delta_t_secs = delta_t_secs(window.from.to_utc())?;
        let sky = Sky { place: self.place, delta_t_secs, air: self.air };
        let grid = self.grid(window, &sky)?;
        let up = intervals(&grid, &sky, |instant| instant.night.then_some(IntervalBound::Horizon))?;
        let of_probe = |(probe, at)| intervals(&grid, &sky, |instant| self.blocked(probe, at, instant));
        Ok((up, self.probes.iter().zip(&self.points).map(of_probe).collect::<Result<_, _>>()?))
    }

    /// The window's instants, a step apart, and its end; those deep in the night are left out. Where the sun rises and
    /// sets between two of them there is one more, so that no sunlight and no night is missed.
    fn grid(&self, window: &DayWindow, sky: &Sky<'_>) -> Result<Vec<Instant>, SunError> {
        let mut last = sky.at(window.from)?;
        let mut grid = vec![last.clone()];
        while last.time < window.to {
            let night_secs = if last.night { sky.least_secs_to_horizon(&last) as i64 } else { 0 };
            let steps = (night_secs / self.step.num_seconds()).max(1) as i32;
            let next = sky.at((last.time + self.step * steps).min(window.to))?;
            grid.extend(sky.cut(&last, &next)?.into_iter().flat_map(|cut| cut.between));
            grid.push(next.clone());
            last = next;
        }
        Ok(grid)
    }

    /// What keeps the sun from a probe; nothing in sunlight.
    fn blocked(&self, probe: &Probe, at: &JudgedPoint, instant: &Instant) -> Option<IntervalBound> {
        if instant.night {
            return Some(IntervalBound::Horizon);
        }
        if probe.normal.is_some_and(|normal| normal.dot(instant.to_sun) <= 0.0) {
            return Some(IntervalBound::Behind);
        }
        if at.below_ground_m.is_some() {
            return Some(IntervalBound::Ground);
        }
        let (face, _) = self.rays.first_hit(at.point - self.casters.origin, instant.to_sun)?;
        Some(IntervalBound::Component(self.casters.components.partition_point(|component| component.faces.end <= face)))
    }
}

/// The intervals in which nothing blocks. Between instants of the grid that agree there is no change; between two that do
/// not the one that halving finds.
fn intervals(
    grid: &[Instant],
    sky: &Sky<'_>,
    blocked: impl Fn(&Instant) -> Option<IntervalBound>,
) -> Result<Vec<Interval>, SunError> {
    let mut found = Vec::new();
    // since when there is sun, and what blocked before
    let mut open = None;
    let mut before: Option<(DateTime<Zone>, Option<IntervalBound>)> = None;
    for instant in grid {
        let now = (instant.time, blocked(instant));
        match before {
            None => open = now.1.is_none().then_some((now.0, IntervalBound::Window)),
            Some((time, state)) if state.is_none() != now.1.is_none() => {
                let (mut low, mut high) = ((time, state), now);
                while high.0 - low.0 > TimeDelta::seconds(1) {
                    let middle = sky.at(low.0 + TimeDelta::seconds((high.0 - low.0).num_seconds() / 2))?;
                    let state = blocked(&middle);
                    let half = if state.is_none() == low.1.is_none() { &mut low } else { &mut high };
                    *half = (middle.time, state);
                }
                if let Some(before) = low.1 {
                    open = Some((high.0, before));
                } else if let (Some((start, before)), Some(after)) = (open.take(), high.1) {
                    found.push(Interval { start, end: high.0, before, after });
                }
            }
            Some(_) => {}
        }
        before = Some(now);
    }
    if let (Some((start, why)), Some((end, _))) = (open, before)
        && start < end
    {
        found.push(Interval { start, end, before: why, after: IntervalBound::Window });
    }
    Ok(found)
}
