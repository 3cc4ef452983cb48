//! Measures how coarsely corners are stored, if that is coarse enough for a note.

use super::reader::Reader;
use crate::mesh::CornerPrecision;
use glam::{DAffine3, DVec3};
use gltf::json::accessor::ComponentType;

/// Notes which corners are stored coarsely: those of the vertices `used`, at `points`, with indices from `first` on.
/// Steps are in the model's units; those up to `told_step` are ignored.
pub(super) fn corners(
    positions: &Reader,
    (used, first): (&[u32], u32),
    model_from_mesh: &DAffine3,
    points: &[DVec3],
    told_step: f64,
) -> Vec<CornerPrecision> {
    let matrix = model_from_mesh.matrix3;
    let units = DVec3::new(matrix.x_axis.length(), matrix.y_axis.length(), matrix.z_axis.length());
    if let Some(step) = positions.whole_step() {
        let step_m = step * units.max_element();
        let all = CornerPrecision { corners: first..first + used.len() as u32, step_m, is_float: false };
        return if step_m > told_step { vec![all] } else { Vec::new() };
    }
    // the corners' positions bound the size of the stored numbers; that nearly always suffices
    let reach = points.iter().fold(DVec3::ZERO, |reach, point| reach.max((point - model_from_mesh.translation).abs()));
    let mesh_from_model = matrix.inverse();
    let largest = [mesh_from_model.x_axis, mesh_from_model.y_axis, mesh_from_model.z_axis]
        .iter()
        .zip(reach.to_array())
        .fold(DVec3::ZERO, |sum, (axis, reach)| sum + axis.abs() * reach);
    if (largest * units).max_element() * f64::from(f32::EPSILON) <= told_step && largest.is_finite() {
        return Vec::new();
    }
    let mut found: Vec<CornerPrecision> = Vec::new();
    for (corner, &vertex) in (first..).zip(used) {
        let steps = positions.vec3(vertex as usize).to_array().map(step);
        let step_m = (DVec3::from_array(steps) * units).max_element();
        match found.last_mut() {
            _ if step_m.is_nan() || step_m <= told_step => (),
            Some(last) if last.corners.end == corner && last.step_m == step_m => last.corners.end += 1,
            _ => found.push(CornerPrecision { corners: corner..corner + 1, step_m, is_float: true }),
        }
    }
    found
}

/// The distance from a single-precision number to the next larger one.
fn step(number: f64) -> f64 {
    let size = number.abs() as f32;
    f64::from(size.next_up()) - f64::from(size)
}

impl Reader<'_> {
    /// The step between neighbouring values if they are integers, normalised integers, or were rounded.
    fn whole_step(&self) -> Option<f64> {
        if self.rounded.is_some() {
            return self.rounded;
        }
        let most = match self.component {
            ComponentType::F32 => return None,
            ComponentType::I8 => f64::from(i8::MAX),
            ComponentType::U8 => f64::from(u8::MAX),
            ComponentType::I16 => f64::from(i16::MAX),
            ComponentType::U16 => f64::from(u16::MAX),
            ComponentType::U32 => f64::from(u32::MAX),
        };
        Some(if self.normalized { 1.0 / most } else { 1.0 })
    }
}
