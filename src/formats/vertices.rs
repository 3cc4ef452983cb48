//! A file's shared vertices → the vertices that each part uses.

use crate::mesh::{CornerPrecision, Part};
use glam::DVec3;

/// A vertex that the part does not have yet.
const ABSENT: u32 = u32::MAX;

/// Gives the vertices of each part numbers of their own. Many parts may each use a few of many vertices: only those are looked at.
#[derive(Default)]
pub(super) struct VertexPicker {
    /// Per vertex of the file its number in the part at hand; all [`ABSENT`] between parts.
    numbers: Vec<u32>,
}

impl VertexPicker {
    /// The vertices that triangles use, which become numbers of those. Every triangle's vertices are among `positions`.
    pub(super) fn pick(&mut self, positions: &[DVec3], triangles: &mut [[u32; 3]]) -> Vec<DVec3> {
        if self.numbers.len() < positions.len() {
            self.numbers.resize(positions.len(), ABSENT);
        }
        let (mut picked, mut used) = (Vec::new(), Vec::new());
        for vertex in triangles.iter_mut().flatten() {
            let Some(number) = self.numbers.get_mut(*vertex as usize) else { continue };
            if *number == ABSENT {
                *number = used.len() as u32;
                used.push(*vertex);
                picked.push(positions.get(*vertex as usize).copied().unwrap_or_default());
            }
            *vertex = *number;
        }
        for vertex in used {
            if let Some(number) = self.numbers.get_mut(vertex as usize) {
                *number = ABSENT;
            }
        }
        picked
    }
}

/// Says how coarse a part's numbers are where they are single-precision floats; steps up to `told_step` are not told.
pub(super) fn note_floats(part: &mut Part, told_step: f64) {
    let mut found: Vec<CornerPrecision> = Vec::new();
    for (corner, position) in (0_u32..).zip(&part.positions) {
        let size = position.abs().max_element() as f32;
        let step_m = f64::from(size.next_up()) - f64::from(size);
        match found.last_mut() {
            _ if step_m.is_nan() || step_m <= told_step => (),
            Some(last) if last.corners.end == corner && last.step_m == step_m => last.corners.end += 1,
            _ => found.push(CornerPrecision { corners: corner..corner + 1, step_m, is_float: true }),
        }
    }
    part.coarse = found;
}
