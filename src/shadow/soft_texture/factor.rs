//! How strongly a light shines on a point when nothing stands between the two.

use glam::DVec3;
use std::f64::consts::TAU;

/// The part of a point's sky, each direction weighted by its cosine, that a flat lamp takes: 0 to 1.
///
/// Cohen and Wallace, *Radiosity and Realistic Image Synthesis*, page 72; formula 4.2 of M. Herf's paper:
/// F = 1/(2π) · Σ βᵢ · N·(Rᵢ × Rᵢ₊₁)/|Rᵢ × Rᵢ₊₁|, Rᵢ from the point to the lamp's corners, βᵢ the angle between Rᵢ and Rᵢ₊₁.
/// The corners run either way around; the lamp stands wholly above the point's plane. It changes slowly, so it can be
/// asked at few texels. Towards the sun, the same is the cosine `normal.dot(to_sun)`.
pub fn unoccluded(point: DVec3, normal: DVec3, corners: &[DVec3]) -> f64 {
    let from_point: Vec<DVec3> = corners.iter().map(|corner| *corner - point).collect();
    let side = |at: usize| {
        let (one, other) = (from_point[at], from_point[(at + 1) % from_point.len()]);
        let across = one.cross(other);
        let length = across.length();
        // a side that runs towards the point is seen under no angle
        if length == 0.0 { 0.0 } else { length.atan2(one.dot(other)) * normal.dot(across) / length }
    };
    ((0..from_point.len()).map(side).sum::<f64>() / TAU).abs()
}
