//! What stands in front of a point, except the glass of judged windows.

use crate::mesh::Mesh;
use crate::shadow::ray_cast::RayCaster;
use crate::study::openness::{looks, openness};
use glam::{DVec3, DVec4};

/// The distance of a ray's start from the surface that it leaves, metres.
const BEFORE_M: f64 = 0.002;

/// Some components, ready to be met by rays.
pub(super) struct Obstacles {
    origin: DVec3,
    rays: RayCaster,
    planes: Vec<DVec4>,
}

impl Obstacles {
    /// The components that are kept, for rays that start near these points of the world frame.
    pub(super) fn new(mesh: &Mesh, keep: &[bool], points: impl Iterator<Item = DVec3>) -> Obstacles {
        /// The greatest distance of a ray's start from the points, metres.
        const NEAR_M: f64 = 10.0;
        let kept = mesh.of_components(keep);
        let reach = points.map(|point| (point - kept.origin).abs().max_element()).fold(0.0, f64::max) + NEAR_M;
        Obstacles { origin: kept.origin, rays: RayCaster::new(&kept, reach), planes: kept.planes().to_vec() }
    }

    /// How open a side is at a point.
    pub(super) fn openness(&self, point: DVec3, normal: DVec3) -> f64 {
        openness(&self.rays, point + normal * BEFORE_M - self.origin, Some(normal))
    }

    /// Whether only the insides of walls are seen from a side: something lies in every direction, and most of it shows
    /// its back.
    pub(super) fn is_walled_in(&self, point: DVec3, normal: DVec3) -> bool {
        let from = point + normal * BEFORE_M - self.origin;
        let hits = looks(normal).map(|look| Some((look, self.rays.first_hit(from, look)?.0)));
        let backs =
            hits.iter().flatten().filter(|(look, face)| self.planes[*face as usize].truncate().dot(*look) > 0.0);
        hits.iter().all(Option::is_some) && 2 * backs.count() > hits.len()
    }

    /// The distance to the first face along a ray, metres.
    pub(super) fn first(&self, from: DVec3, direction: DVec3) -> Option<f64> {
        self.rays.first_hit(from - self.origin, direction).map(|(_, away)| away)
    }

    /// The first face along a ray, and its distance, metres.
    pub(super) fn first_face(&self, from: DVec3, direction: DVec3) -> Option<(u32, f64)> {
        self.rays.first_hit(from - self.origin, direction)
    }
}
