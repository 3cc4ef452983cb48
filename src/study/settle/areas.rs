//! Areas that lie under something: a garden that was drawn on the ground below its podium would never see the sun.

use super::super::ground_heights::GroundHeights;
use super::obstacles::Obstacles;
use crate::mesh::Mesh;
use crate::message::{Message, message};
use crate::site::{AreaSurface, JudgedArea, JudgedSite};
use glam::{DVec2, DVec3};
use rustc_hash::FxHashMap;

/// The number of tested points along each side of an area's rectangle.
const POINTS: usize = 16;
/// An area does not lie under what is higher above it than this, metres.
const LOW_M: f64 = 3.0;
/// An area gets a note if a greater share of it than this lies under something.
const COVERED: f64 = 0.5;

/// Notes on areas that lie under something in the state before, or in the only state. What is built over an area later
/// is what is judged.
pub(super) fn notes(site: &JudgedSite) -> Vec<Message> {
    let state = site.before.as_ref().unwrap_or(&site.now);
    let bounded: Vec<&JudgedArea> = site.areas.iter().filter(|area| !area.rings.is_empty()).collect();
    if bounded.is_empty() {
        return Vec::new();
    }
    let ground = state.ground.level;
    let corners = || bounded.iter().flat_map(|area| area.rings.iter().flatten()).map(|corner| corner.extend(ground));
    let casters = Obstacles::new(&state.mesh, &state.casts, corners());
    let heights = GroundHeights::of(&state.mesh, &state.ground, &corners().collect::<Vec<_>>());
    let kept = state.mesh.of_components(&state.casts);
    bounded.iter().filter_map(|area| of_area(area, &heights, &casters, &kept)).collect()
}

fn of_area(area: &JudgedArea, heights: &GroundHeights, casters: &Obstacles, kept: &Mesh) -> Option<Message> {
    let points = points(&area.rings);
    let mut covers: FxHashMap<usize, usize> = FxHashMap::default();
    for at in &points {
        let height = match area.surface {
            AreaSurface::Level(level) => level,
            AreaSurface::Ground(above) => heights.height(at.extend(0.0)) + above,
            AreaSurface::Faces(_) => return None,
        };
        // a millimetre above itself, as everything that is judged
        let met = casters.first_face(at.extend(height + 0.001), DVec3::Z);
        if let Some((face, _)) = met.filter(|(_, away)| *away <= LOW_M) {
            let component = kept.components.partition_point(|component| component.faces.end <= face);
            *covers.entry(component).or_default() += 1;
        }
    }
    let covered: usize = covers.values().sum();
    let share = covered as f64 / points.len().max(1) as f64;
    let (most, _) = covers.iter().max_by_key(|(component, count)| (**count, std::cmp::Reverse(**component)))?;
    (share > COVERED).then(|| {
        let name = kept.components.get(*most).map_or("", |component| &component.name);
        let what =
            format!("{:.0} % of the area \"{}\" lies less than {LOW_M} m under \"{name}\"", share * 100.0, area.name);
        message![what; "write its `height` or `level`, or `component`, if it lies on top of that"]
    })
}

/// The points of a grid that lie within an area's borders.
fn points(rings: &[Vec<DVec2>]) -> Vec<DVec2> {
    let corners = || rings.iter().flatten().copied();
    let low = corners().fold(DVec2::INFINITY, DVec2::min);
    let high = corners().fold(DVec2::NEG_INFINITY, DVec2::max);
    let at = |index: usize| {
        let [column, row] = [index % POINTS, index / POINTS].map(|step| (step as f64 + 0.5) / POINTS as f64);
        low + (high - low) * DVec2::new(column, row)
    };
    (0..POINTS * POINTS).map(at).filter(|at| is_within(*at, rings)).collect()
}

fn is_within(at: DVec2, rings: &[Vec<DVec2>]) -> bool {
    let mut is_within = false;
    for ring in rings {
        for (index, a) in ring.iter().enumerate() {
            let b = ring[(index + 1) % ring.len()];
            if (a.y > at.y) != (b.y > at.y) && at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x) {
                is_within = !is_within;
            }
        }
    }
    is_within
}
