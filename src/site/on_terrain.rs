//! Puts models whose heights are measured from the ground onto the other models' terrain.

use super::stand::StandingModel;
use crate::formats::PartKind;
use crate::mesh::Part;
use crate::message::{Message, message};
use glam::{DVec2, DVec3};
use std::ops::RangeInclusive;

/// The most cells along a side of the raster in which terrain is looked up.
const MOST_CELLS: f64 = 1024.0;

/// Moves parts that stand on the ground up or down to the lowest point of the terrain below their corners, from which
/// OpenStreetMap measures heights, too. Without terrain they stand at the place's elevation.
pub(super) fn settle(models: &mut [StandingModel]) {
    let is_one = |standing: &StandingModel| standing.model.from_ground.contains(&true);
    if !models.iter().any(is_one) {
        return;
    }
    let terrain = TerrainHeights::of(models);
    for standing in models.iter_mut().filter(|standing| is_one(standing)) {
        // a file's own height of its origin is not a height of the ground
        let zero_m = if standing.is_where_said { standing.position.z } else { 0.0 };
        let StandingModel { model, notes, .. } = standing;
        let (mut settled, mut beyond) = (0, 0);
        for (part, _) in model.parts.iter_mut().zip(&model.from_ground).filter(|(_, is_from_ground)| **is_from_ground) {
            let height = |corner: &DVec3| terrain.as_ref()?.height(corner.truncate());
            let lowest = part.positions.iter().filter_map(height).min_by(f64::total_cmp);
            if lowest.is_some() {
                settled += 1
            } else {
                beyond += 1
            }
            let up = lowest.unwrap_or_default() - zero_m;
            part.positions.iter_mut().for_each(|corner| corner.z += up);
        }
        // without terrain all stand at one height, which is only worth a note beside other models
        if terrain.is_some() || !model.stands_on_ground() {
            notes.push(told([settled, beyond], model.parts.len(), terrain.is_some()));
        }
    }
}

/// A note that some parts of a model have no height of the ground; it counts those on the terrain and those beyond it.
fn told([settled, beyond]: [usize; 2], count: usize, has_terrain: bool) -> Message {
    let without = settled + beyond;
    let stand = |count: usize| if count == 1 { "stands" } else { "stand" };
    if !has_terrain {
        return message![format!(
            "says no height of the ground of {without} of its {count} parts, which {} at the place's elevation, beside \
             others that are above the sea",
            stand(without)
        )];
    }
    let (of, whose) = match without == count {
        true => (String::new(), format!(" of its {count} parts")),
        false => (format!(" of {without} of its {count} parts"), String::new()),
    };
    let beyond = match beyond {
        0 => String::new(),
        1 => ", and 1, which lies beyond it, at the place's elevation".to_owned(),
        beyond => format!(", and {beyond}, which lie beyond it, at the place's elevation"),
    };
    message![format!("says no height of the ground{of}: {settled}{whose} {} on the terrain{beyond}", stand(settled))]
}

/// The terrain's triangles, sorted into the cells of a raster that they touch.
struct TerrainHeights {
    triangles: Vec<[DVec3; 3]>,
    low: DVec2,
    cell: f64,
    columns: usize,
    rows: usize,
    /// For each cell, the index at which its triangles begin; and the end of the last one's.
    first: Vec<usize>,
    /// Triangle indices, cell by cell.
    in_cells: Vec<u32>,
}

impl TerrainHeights {
    /// The terrain of all models; `None` without terrain.
    fn of(models: &[StandingModel]) -> Option<TerrainHeights> {
        let parts = models.iter().flat_map(|standing| {
            let model = &standing.model;
            model.parts.iter().enumerate().filter(|(part, _)| model.kind(*part) == PartKind::Terrain)
        });
        let corners = |(_, part): (usize, &'_ Part)| -> Vec<[DVec3; 3]> {
            part.triangles.iter().map(|triangle| triangle.map(|corner| part.positions[corner as usize])).collect()
        };
        let triangles: Vec<[DVec3; 3]> = parts.flat_map(corners).collect();
        let all = || triangles.iter().flatten().map(|corner| corner.truncate());
        let (low, high) = (all().reduce(DVec2::min)?, all().reduce(DVec2::max)?);
        let size = high - low;
        let side = (triangles.len() as f64).sqrt().clamp(1.0, MOST_CELLS);
        let cell = (size.max_element() / side).max(f64::MIN_POSITIVE);
        let [columns, rows] = size.to_array().map(|length| (length / cell) as usize + 1);
        let mut found = TerrainHeights { triangles, low, cell, columns, rows, first: Vec::new(), in_cells: Vec::new() };
        found.sort();
        Some(found)
    }

    /// Fills the cells. Counting first allows one list for all.
    fn sort(&mut self) {
        let mut first = vec![0; self.columns * self.rows + 1];
        for triangle in &self.triangles {
            self.cells(triangle).for_each(|cell| first[cell + 1] += 1);
        }
        for cell in 1..first.len() {
            first[cell] += first[cell - 1];
        }
        let mut next = first.clone();
        let mut in_cells = vec![0; first.last().copied().unwrap_or_default()];
        for (number, triangle) in (0..).zip(&self.triangles) {
            for cell in self.cells(triangle) {
                in_cells[next[cell]] = number;
                next[cell] += 1;
            }
        }
        (self.first, self.in_cells) = (first, in_cells);
    }

    /// The cells of a triangle's bounding box.
    fn cells(&self, triangle: &[DVec3; 3]) -> impl Iterator<Item = usize> + use<> {
        let range = |axis: usize, count: usize| -> RangeInclusive<usize> {
            let at = triangle.map(|corner| ((corner[axis] - self.low[axis]) / self.cell) as usize);
            let [low, high] = [at.iter().min(), at.iter().max()].map(|end| end.copied().unwrap_or_default());
            low.min(count - 1)..=high.min(count - 1)
        };
        let (across, down, columns) = (range(0, self.columns), range(1, self.rows), self.columns);
        down.flat_map(move |row| across.clone().map(move |column| row * columns + column))
    }

    /// The height of the highest terrain at a point in plan; `None` beyond its edge.
    fn height(&self, at: DVec2) -> Option<f64> {
        let cell = (at - self.low) / self.cell;
        let is_inside = cell.min_element() >= 0.0 && (cell.x as usize) < self.columns && (cell.y as usize) < self.rows;
        let cell = is_inside.then(|| cell.y as usize * self.columns + cell.x as usize)?;
        let numbers = &self.in_cells[self.first[cell]..self.first[cell + 1]];
        let heights = numbers.iter().filter_map(|&number| above(&self.triangles[number as usize], at));
        heights.max_by(f64::total_cmp)
    }
}

/// The height of a triangle at a point in plan.
fn above(&[a, b, c]: &[DVec3; 3], at: DVec2) -> Option<f64> {
    let area = (b - a).truncate().perp_dot((c - a).truncate());
    let share = |one: DVec3, other: DVec3| (one.truncate() - at).perp_dot(other.truncate() - at) / area;
    let shares = [share(b, c), share(c, a), share(a, b)];
    // a point on the edge between two triangles is in both
    let is_inside = area != 0.0 && shares.iter().all(|share| *share >= -1e-9);
    is_inside.then(|| shares[0] * a.z + shares[1] * b.z + shares[2] * c.z)
}
