//! The order in which the processor judges patches.

use crate::mesh::patches::Patches;
use glam::DVec3;
use rayon::prelude::*;

/// The patches' indices along a space-filling curve, so that what their rays meet is still in the processor's caches.
pub(super) fn along_a_curve(patches: &Patches) -> Vec<u32> {
    let corners = || patches.list.iter().map(|patch| patch.corner);
    let (low, high) = (corners().fold(DVec3::INFINITY, DVec3::min), corners().fold(DVec3::NEG_INFINITY, DVec3::max));
    let per_metre = 1023.0 / (high - low).max_element().max(f64::MIN_POSITIVE);
    let spread = |number: f64| (0..10).fold(0, |spread, bit| spread | (number as u32 >> bit & 1) << (3 * bit));
    let along = |corner: DVec3| {
        let [x, y, z] = ((corner - low) * per_metre).to_array().map(spread);
        x | y << 1 | z << 2
    };
    let mut order: Vec<(u32, u32)> = (0..).zip(corners()).map(|(at, corner)| (along(corner), at)).collect();
    order.par_sort_unstable();
    order.into_iter().map(|(_, at)| at).collect()
}
