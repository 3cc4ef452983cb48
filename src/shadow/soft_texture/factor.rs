//! The light of an unoccluded lamp at a point.

use glam::DVec3;
use std::f64::consts::TAU;

/// Returns the share of a point's sky that a flat lamp takes, with each direction weighted by its cosine: 0 to 1.
///
/// Cohen and Wallace, *Radiosity and Realistic Image Synthesis*, page 72; formula 4.2 of M. Herf's paper:
/// F = 1/(2π) · Σ βᵢ · N·(Rᵢ × Rᵢ₊₁)/|Rᵢ × Rᵢ₊₁|, with Rᵢ from the point to the lamp's corners and βᵢ the angle between
/// Rᵢ and Rᵢ₊₁. The corners may be in either order; the lamp must be wholly above the point's plane. The factor varies
/// slowly, so it can be evaluated at few texels. For the sun, it is the cosine `normal.dot(to_sun)`.
pub fn unoccluded(point: DVec3, normal: DVec3, corners: &[DVec3]) -> f64 {
    let from_point: Vec<DVec3> = corners.iter().map(|corner| *corner - point).collect();
    let side = |at: usize| {
        let (one, other) = (from_point[at], from_point[(at + 1) % from_point.len()]);
        let across = one.cross(other);
        let length = across.length();
        // an edge that points at the point subtends no angle
        if length == 0.0 { 0.0 } else { length.atan2(one.dot(other)) * normal.dot(across) / length }
    };
    ((0..from_point.len()).map(side).sum::<f64>() / TAU).abs()
}
