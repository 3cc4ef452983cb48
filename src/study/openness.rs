//! How open one side of something is: what lies before it, as far as a street is wide.

use crate::shadow::ray_cast::RayCaster;
use glam::DVec3;

/// No ray is followed farther, metres.
pub(super) const FAR_M: f64 = 50.0;

/// The rays along which is looked from a side: to both sides, up and down, and ahead.
pub(super) fn looks(normal: DVec3) -> [DVec3; 5] {
    let (across, along) = normal.any_orthonormal_pair();
    let [right, left, up, down] = [across, -across, along, -along].map(|side| (normal + side).normalize());
    [right, left, up, down, normal]
}

/// How far one sees from a point around the mesh's origin: metres along all rays together.
pub(super) fn openness(rays: &RayCaster, point: DVec3, normal: Option<DVec3>) -> f64 {
    let Some(normal) = normal else { return 0.0 };
    let seen = |direction: DVec3| rays.first_hit(point, direction).map_or(FAR_M, |(_, away)| away.min(FAR_M));
    looks(normal).into_iter().map(seen).sum()
}
