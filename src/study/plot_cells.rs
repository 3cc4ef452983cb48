//! The cells of a plot, and what stands around it.

use super::ground_heights::GroundHeights;
use crate::shadow::plan_surface;
use crate::site::{JudgedPlot, JudgedState};
use crate::view::{Grid, Surface};
use glam::{DVec2, DVec3};

/// The most cells of a plot with its surroundings.
const MOST_CELLS: f64 = 1e6;

/// Around a plot so much is shown: a part of its longer side, and at least so many metres.
const AROUND: f64 = 0.35;
const LEAST_AROUND_M: f64 = 8.0;

/// The raster of a plot with its surroundings, by cells of that side, or such that its longer side has about two hundred.
/// None where there would be too many.
pub fn plot_grid(plot: &JudgedPlot, cell_m: Option<f64>) -> Option<Grid> {
    const ROUND_M: [f64; 9] = [0.1, 0.2, 0.25, 0.5, 1.0, 2.0, 2.5, 5.0, 10.0];
    let none = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    let (low, high) = plot.border.iter().fold(none, |(low, high), at| (low.min(*at), high.max(*at)));
    let longer = (high - low).max_element();
    let round = || ROUND_M.into_iter().find(|cell| longer / cell <= 200.0).unwrap_or(longer / 200.0);
    let cell = cell_m.unwrap_or_else(round);
    let around = ((longer * AROUND).max(LEAST_AROUND_M) / cell).ceil() * cell;
    let size = ((high - low + 2.0 * around) / cell).ceil();
    // a border with NaN has no size either
    let is_fit = size.x > 0.0 && size.y > 0.0 && size.x * size.y <= MOST_CELLS;
    is_fit.then_some(Grid {
        west: low.x - around,
        north: low.y - around + size.y * cell,
        cell,
        width: size.x as u32,
        height: size.y as u32,
    })
}

/// For each cell, whether its centre lies within a border.
pub fn cells_within(border: &[DVec2], grid: &Grid) -> Vec<bool> {
    let is_within = |at: DVec2| {
        let sides = (0..border.len()).map(|side| (border[side], border[(side + 1) % border.len()]));
        let crossed = sides.filter(|(from, to)| {
            (from.y > at.y) != (to.y > at.y) && at.x < from.x + (at.y - from.y) / (to.y - from.y) * (to.x - from.x)
        });
        crossed.count() % 2 == 1
    };
    let centres = (0..grid.height).flat_map(|row| (0..grid.width).map(move |column| grid.centre(column, row)));
    centres.map(is_within).collect()
}

/// The lowest ground in the middle of one of the chosen cells, metres above the place's point: the terrain's, or the plane's.
pub fn lowest_ground(state: &JudgedState, (grid, chosen): (&Grid, &[bool])) -> f64 {
    let centres = (0..grid.height).flat_map(|row| (0..grid.width).map(move |column| grid.centre(column, row)));
    let points: Vec<DVec3> = centres.zip(chosen).filter(|(_, chosen)| **chosen).map(|(at, _)| at.extend(0.0)).collect();
    let ground = GroundHeights::of(&state.mesh, &state.ground, &points);
    points.iter().map(|point| ground.height(*point)).min_by(f64::total_cmp).unwrap_or(state.ground.level)
}

/// For each cell, whether something other than terrain casts there.
pub fn buildings(state: &JudgedState, grid: &Grid) -> Vec<bool> {
    let stands = state.casts.iter().zip(&state.mesh.components);
    let stands: Vec<bool> = stands.map(|(casts, component)| *casts && !component.is_terrain).collect();
    let surface = plan_surface(&state.mesh.of_components(&stands), state.ground.level, grid);
    surface.face.iter().map(|face| *face < Surface::GROUND).collect()
}
