//! When points lie in the sun: rays at the instants of a grid, and halving between two of them that differ.
//!
//! A probe lies in sunlight where the sun is above the horizon, in front of the probe's plane if it has one, and a ray
//! to the sun's centre meets no caster; not below the ground. An interval of sun or of shade that is at least one step long holds an instant
//! of the grid, and so cannot be missed; a shorter one may be. Each change that is found is exact to the second.

use super::{Event, OnEvent, StudyError, note_models, tell};
use crate::mesh::Mesh;
use crate::shadow::JUDGED_ABOVE_M;
use crate::shadow::ray_cast::RayCaster;
use crate::site::ProbeSite;
use crate::sun::{Air, DayWindow, Instant, Place, Sky, SunError, Zone, delta_t_secs};
use crate::sunlight::{Interval, IntervalBound, ProbeIntervals, SunDay, Sunlight, below_ground_m, judged};
use crate::view::Probe;
use chrono::{DateTime, TimeDelta};
use rayon::prelude::*;

/// The intervals in sunlight of all probes, on all days.
///
/// # Errors
/// [`StudyError`].
pub fn probe(asked: &ProbeSite, on_event: &mut OnEvent<'_>) -> Result<Sunlight, StudyError> {
    note_models(&asked.notes, on_event)?;
    let search = ProbeSearch::new(asked);
    let empty = |probe: &Probe| ProbeIntervals { probe: probe.clone(), days: Vec::new() };
    let mut sunlight = Sunlight {
        step_secs: asked.step_secs,
        refraction: asked.refraction,
        days: Vec::new(),
        probes: asked.probes.iter().map(empty).collect(),
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

/// What a day is searched with.
struct ProbeSearch<'a> {
    place: &'a Place,
    probes: &'a [Probe],
    step: TimeDelta,
    air: Option<Air>,
    /// Height of the ground, below which there is no sun.
    ground: f64,
    casters: Mesh,
    rays: RayCaster,
}

impl ProbeSearch<'_> {
    fn new(asked: &ProbeSite) -> ProbeSearch<'_> {
        let casters = asked.mesh.of_components(&asked.casts);
        let reach = asked.probes.iter().map(|probe| (probe.point - casters.origin).abs().max_element());
        let rays = RayCaster::new(&casters, reach.fold(0.0, f64::max) + JUDGED_ABOVE_M);
        ProbeSearch {
            place: &asked.place,
            probes: &asked.probes,
            step: TimeDelta::seconds(asked.step_secs.into()),
            air: asked.refraction.then(|| Air::standard(asked.place.elevation_m)),
            ground: asked.ground.level,
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
        let of_probe = |probe| intervals(&grid, &sky, |instant| self.blocked(probe, instant));
        Ok((up, self.probes.iter().map(of_probe).collect::<Result<_, _>>()?))
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
    fn blocked(&self, probe: &Probe, instant: &Instant) -> Option<IntervalBound> {
        if instant.night {
            return Some(IntervalBound::Horizon);
        }
        if probe.normal.is_some_and(|normal| normal.dot(instant.to_sun) <= 0.0) {
            return Some(IntervalBound::Behind);
        }
        if below_ground_m(probe, self.ground).is_some() {
            return Some(IntervalBound::Ground);
        }
        let (face, _) = self.rays.first_hit(judged(probe) - self.casters.origin, instant.to_sun)?;
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
