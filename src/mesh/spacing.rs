//! The precision of coordinates.

use super::Mesh;
use glam::Vec3;

/// The distance between neighbouring `f32` values at the largest coordinate of what stands together, metres. For points
/// beyond that, it grows with their distance.
pub(super) struct Spacing {
    home: f32,
}

impl Spacing {
    pub(super) fn of(mesh: &Mesh) -> Spacing {
        let at_home = (0..mesh.vertices.len() as u32).filter(|&vertex| mesh.is_at_home(vertex));
        let largest = at_home.map(|vertex| mesh.vertices[vertex as usize].abs().max_element());
        Spacing { home: largest.fold(0.0f32, f32::max) }
    }

    pub(super) fn at(&self, points: &[Vec3]) -> f64 {
        let largest = points.iter().fold(self.home, |largest, point| largest.max(point.abs().max_element()));
        f64::from(largest) * f64::from(f32::EPSILON)
    }
}
