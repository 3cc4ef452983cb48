//! The sun as a disc.

use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// The sun's angular diameter, radians: 0.533°.
pub const SUN_DISC_RAD: f64 = 0.533 * PI / 180.0;

/// Returns unit vectors to `samples` points of the sun's disc around the unit vector to its centre. Each represents an
/// equal part of the disc.
///
/// The points are a spiral of golden angles (H. Vogel, *A better way to construct the sunflower head*, Mathematical
/// Biosciences 44, 1979), which are evenly spread for any number, and always the same.
pub fn disc(to_sun: DVec3, samples: u32) -> impl Iterator<Item = DVec3> {
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let (across, along) = to_sun.any_orthonormal_pair();
    let radius = (SUN_DISC_RAD / 2.0).tan();
    (0..samples).map(move |sample| {
        let out = ((f64::from(sample) + 0.5) / f64::from(samples)).sqrt() * radius;
        let at = DVec2::from_angle(golden * f64::from(sample)) * out;
        (to_sun + across * at.x + along * at.y).normalize()
    })
}
