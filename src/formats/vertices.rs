//! Selects the vertices that each part uses from a file's shared ones.

use crate::mesh::{CornerPrecision, Part};
use glam::DVec3;

/// A vertex that the part does not have yet.
const ABSENT: u32 = u32::MAX;

/// Gives the vertices of each part indices of their own. Many parts may each use a few of many vertices: only those are
/// visited.
#[derive(Default)]
pub(super) struct VertexPicker {
    /// For each vertex of the file its index in the current part; all [`ABSENT`] between parts.
    numbers: Vec<u32>,
}

impl VertexPicker {
    /// Returns the vertices that triangles use, and changes the triangles to refer to them. All indices must be within
    /// `positions`.
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

/// Records how coarse a part's numbers are if they are single-precision floats. Steps up to `told_step` are ignored.
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
