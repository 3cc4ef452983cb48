//! When windows are lit.

use super::super::StudyError;
use super::judging::{BothStates, RuleOnSite, Steps};
use super::point_light::PointLight;
use super::state_search::{StateSearch, WallPlane};
use crate::judgement::{SpellBound, WindowSpot, both, clipped, window_spot};
use crate::rules::{Spell, common};
use crate::site::JudgedWindow;
use crate::sun::SunError;
use glam::DVec3;
use rayon::prelude::*;
use std::collections::HashMap;

/// The number of windows that are searched between two calls of the listener.
const TOGETHER: usize = 64;

/// When a window is lit.
pub(super) struct WindowLight {
    pub(super) spot: WindowSpot,
    pub(super) light: PointLight,
}

/// When a sun that counts would shine, with nothing in its way, on windows that face one direction, on each day.
type OpenByNormal = HashMap<[u64; 3], Vec<Vec<Spell>>>;

/// The wall in front of a point inside; what lies in the wall and behind it does not take the sun.
pub(super) fn wall_plane(spot: &WindowSpot) -> Option<WallPlane> {
    spot.through.as_ref().map(|opening| (opening.outward, opening.plane_m()))
}

/// The light of all windows, in their order.
pub(super) fn windows(judging: &RuleOnSite<'_>, steps: &mut Steps<'_, '_>) -> Result<Vec<WindowLight>, StudyError> {
    let windows = &judging.site.windows;
    let spots: Vec<WindowSpot> = windows
        .iter()
        // missing values were reported earlier
        .map(|window| {
            window_spot(&judging.rule.receiver, window).unwrap_or(WindowSpot { points: Vec::new(), through: None })
        })
        .collect();
    let open = open_by_normal(judging, windows);
    let points: Vec<DVec3> = spots.iter().flat_map(|spot| spot.points.iter().copied()).collect();
    let searches = judging.states(&points);
    let asked: Vec<(&JudgedWindow, &WindowSpot)> = windows.iter().zip(&spots).collect();
    let mut found: Vec<PointLight> = Vec::with_capacity(windows.len());
    for some in asked.chunks(TOGETHER) {
        let of = |(window, spot): &(&JudgedWindow, &WindowSpot)| {
            light(judging, &searches, (window, spot), &open[&bits(window.outward)])
        };
        found.extend(some.par_iter().map(of).collect::<Result<Vec<_>, SunError>>()?);
        steps.done(some.len())?;
    }
    Ok(spots.into_iter().zip(found).map(|(spot, light)| WindowLight { spot, light }).collect())
}

fn bits(normal: DVec3) -> [u64; 3] {
    normal.to_array().map(f64::to_bits)
}

fn open_by_normal(judging: &RuleOnSite<'_>, windows: &[JudgedWindow]) -> OpenByNormal {
    let mut normals: Vec<DVec3> = windows.iter().map(|window| window.outward).collect();
    normals.sort_by_key(|normal| bits(*normal));
    // by their bits, as the keys are: −0 equals 0
    normals.dedup_by_key(|normal| bits(*normal));
    normals.into_par_iter().map(|normal| (bits(normal), judging.days.open(Some(normal)))).collect()
}

/// The light of a window, which is lit while all of its points are.
fn light(
    judging: &RuleOnSite<'_>,
    searches: &BothStates,
    (window, spot): (&JudgedWindow, &WindowSpot),
    open: &[Vec<Spell>],
) -> Result<PointLight, SunError> {
    let mut whole: Option<PointLight> = None;
    for point in &spot.points {
        let one = light_of_point(judging, searches, (window, spot, *point), open)?;
        whole = Some(match whole {
            None => one,
            Some(whole) => together(whole, one),
        });
    }
    Ok(whole.unwrap_or(PointLight { open: Vec::new(), now: Vec::new(), before: None }))
}

fn light_of_point(
    judging: &RuleOnSite<'_>,
    searches: &BothStates,
    (window, spot, point): (&JudgedWindow, &WindowSpot, DVec3),
    open: &[Vec<Spell>],
) -> Result<PointLight, SunError> {
    let at = |search: &StateSearch| match spot.through {
        Some(_) => search.free(point, Some(window.outward)),
        None => search.in_plane(point, window.outward),
    };
    let (mut now, mut before) = searches.lit(at, wall_plane(spot), judging.days, open)?;
    let mut open = open.to_vec();
    if let Some(opening) = &spot.through {
        open = judging.days.before_planes(&open, &opening.planes_from(point));
        for lit in std::iter::once(&mut now).chain(before.as_mut()) {
            for (lit, open) in lit.iter_mut().zip(&open) {
                *lit = clipped(lit, open, SpellBound::Reveal);
            }
        }
    }
    Ok(PointLight { open, now, before })
}

fn together(one: PointLight, other: PointLight) -> PointLight {
    let lit = |one: &[Vec<_>], other: &[Vec<_>]| one.iter().zip(other).map(|(a, b)| both(a, b)).collect();
    PointLight {
        open: one.open.iter().zip(&other.open).map(|(a, b)| common(a, b)).collect(),
        now: lit(&one.now, &other.now),
        before: one.before.as_deref().zip(other.before.as_deref()).map(|(one, other)| lit(one, other)),
    }
}
