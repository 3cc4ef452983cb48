//! When points lie in the sun: what the faces take away of each day's way of the sun.
//!
//! A probe lies in sunlight where the sun is above the horizon, in front of the probe's plane if it has one, and a ray
//! to the sun's centre meets no caster; not below the ground. The answer is that of such a ray at every second, however
//! short the sun or the shade.

use super::ground_heights::GroundHeights;
use super::openness::openness;
use super::{Event, OnEvent, StudyError, note_models, tell};
use crate::shadow::ray_cast::RayCaster;
use crate::site::ProbeSite;
use crate::sun::Air;
use crate::sunlight::{JudgedPoint, ProbeIntervals, ProbeSearch, SearchedDays, SunDay, Sunlight, judged};
use crate::view::Probe;
use glam::DVec3;
use rayon::prelude::*;

/// So many days are searched together, of all probes, between two looks at the listener.
const DAYS_TOGETHER: usize = 32;

/// The intervals in sunlight of all probes, on all days.
///
/// # Errors
/// [`StudyError`].
pub fn probe(asked: &ProbeSite, on_event: &mut OnEvent<'_>) -> Result<Sunlight, StudyError> {
    note_models(&asked.notes, on_event)?;
    let (probes, doubtful) = with_laid(asked);
    if doubtful > 0 {
        let note =
            format!("of {doubtful} points that are laid both sides are as open to the sky: the outer side is a guess");
        tell(on_event, Event::Note(note.into()))?;
    }
    let points = judged_points(asked, &probes);
    let search = ProbeSearch::new(asked.mesh.of_components(&asked.casts), &points);
    let empty = |(probe, at): (&Probe, &JudgedPoint)| ProbeIntervals {
        probe: probe.clone(),
        below_ground_m: at.below_ground_m,
        days: Vec::with_capacity(asked.days.len()),
    };
    let mut sunlight = Sunlight {
        refraction: asked.refraction,
        days: Vec::new(),
        probes: probes.iter().zip(&points).map(empty).collect(),
        components: search.components(),
    };

    let count = asked.days.len();
    tell(on_event, Event::Started { instants: count, tiles: 1 })?;
    let air = air(asked);
    for windows in asked.days.chunks(DAYS_TOGETHER) {
        let days = SearchedDays::new(&asked.place, windows, air)?;
        let found: Vec<_> = points.par_iter().map(|at| search.intervals(at, &days)).collect::<Result<_, _>>()?;
        sunlight.probes.iter_mut().zip(found).for_each(|(probed, found)| probed.days.extend(found));
        for (window, path) in windows.iter().zip(days.paths) {
            let index = sunlight.days.len();
            sunlight.days.push(SunDay { window: window.clone(), up: path.up });
            tell(on_event, Event::Drawn { index, count, time: window.from, mask: None, bits: None })?;
        }
    }
    Ok(sunlight)
}

/// The slow twin: by rays at the instants of a grid, so many seconds apart, and halving between two that differ. At a step of
/// one second nothing is missed.
///
/// # Errors
/// As of [`probe`].
#[cfg(feature = "test-hooks")]
pub fn probe_by_grid(asked: &ProbeSite, step_secs: i64) -> Result<Sunlight, StudyError> {
    let (probes, _) = with_laid(asked);
    let points = judged_points(asked, &probes);
    let search = ProbeSearch::new(asked.mesh.of_components(&asked.casts), &points);
    let step = chrono::TimeDelta::seconds(step_secs);
    let of_probe = |(probe, at): (&Probe, &JudgedPoint)| {
        let of_day = |window| search.by_grid(at, (&asked.place, window, air(asked)), step);
        let days = asked.days.par_iter().map(of_day).collect::<Result<_, _>>()?;
        Ok(ProbeIntervals { probe: probe.clone(), below_ground_m: at.below_ground_m, days })
    };
    Ok(Sunlight {
        refraction: asked.refraction,
        days: SearchedDays::new(&asked.place, &asked.days, air(asked))?
            .paths
            .into_iter()
            .zip(&asked.days)
            .map(|(path, window)| SunDay { window: window.clone(), up: path.up })
            .collect(),
        probes: probes.iter().zip(&points).map(of_probe).collect::<Result<_, StudyError>>()?,
        components: search.components(),
    })
}

/// All points, those that are laid on the side that is more open; and of how many of these both sides are alike.
fn with_laid(asked: &ProbeSite) -> (Vec<Probe>, usize) {
    let mut probes = asked.probes.clone();
    if asked.laid.is_empty() {
        return (probes, 0);
    }
    let origin = asked.mesh.origin;
    let farthest = |point: DVec3| (point - origin).abs().max_element();
    let reach = asked.laid.iter().flatten().map(|probe| farthest(judged(probe))).fold(0.0, f64::max);
    let rays = RayCaster::new(&asked.mesh, reach);
    let outer = |sides: &Vec<Probe>| {
        let open: Vec<f64> = sides.iter().map(|side| openness(&rays, judged(side) - origin, side.normal)).collect();
        let best = (0..sides.len()).max_by(|one, other| open[*one].total_cmp(&open[*other]).then(other.cmp(one)))?;
        let is_alike = (0..sides.len()).any(|other| other != best && open[other] >= open[best]);
        Some((sides[best].clone(), is_alike))
    };
    let found: Vec<_> = asked.laid.par_iter().filter_map(outer).collect();
    let doubtful = found.iter().filter(|(_, is_alike)| *is_alike).count();
    probes.extend(found.into_iter().map(|(probe, _)| probe));
    (probes, doubtful)
}

/// The air that bends the sun's light, where it does.
pub(super) fn air(asked: &ProbeSite) -> Option<Air> {
    asked.refraction.then(|| Air::standard(asked.place.elevation_m))
}

/// Where probes are judged.
pub(super) fn judged_points(asked: &ProbeSite, probes: &[Probe]) -> Vec<JudgedPoint> {
    let points: Vec<DVec3> = probes.iter().map(judged).collect();
    let heights = GroundHeights::of(&asked.mesh, &asked.ground, &points);
    probes.iter().map(|probe| heights.judge(judged(probe), probe.normal)).collect()
}
