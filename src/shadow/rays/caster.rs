//! One mesh, and the rays that are cast at it.

use super::beam::{BlockedBeam, FirstHits, MOST_RAYS};
use super::lanes::SimdLevel;
use super::search::{BlockedRay, FirstHit};
use super::shear::Shear;
use super::tree::WideTree;
use crate::mesh::Mesh;
use glam::DVec3;

/// Casts rays at one mesh. Points and directions are around the mesh's origin.
#[doc(hidden)]
pub struct RayCaster {
    tree: WideTree,
    level: SimdLevel,
}

impl RayCaster {
    /// How many parallel rays are asked at once.
    pub const MOST_RAYS: usize = MOST_RAYS;

    /// Builds the tree; `reach` is the farthest that a ray's origin lies from the mesh's origin, metres.
    pub fn new(mesh: &Mesh, reach: f64) -> RayCaster {
        let size = mesh.vertices.iter().fold(0.0f32, |size, vertex| size.max(vertex.abs().max_element()));
        // a ray's place in single precision, slid along it, and the products that say when it meets a plane
        let padding = (f64::from(size) + reach) * f64::from(f32::EPSILON) * 16.0;
        RayCaster { tree: WideTree::new(mesh, padding as f32), level: SimdLevel::best() }
    }

    /// The same with instructions of one level: for tests, and to measure.
    #[cfg(feature = "test-hooks")]
    pub fn on(self, level: SimdLevel) -> RayCaster {
        RayCaster { level, ..self }
    }

    /// The nearest face along a ray, and how many lengths of `direction` away. Of several that are equally near the first.
    pub fn first_hit(&self, origin: DVec3, direction: DVec3) -> Option<(u32, f64)> {
        self.level.run(FirstHit { tree: &self.tree, shear: &Shear::along(direction), origin })
    }

    /// Whether anything lies along a ray.
    pub fn blocked(&self, origin: DVec3, shear: &Shear) -> bool {
        self.level.run(BlockedRay { tree: &self.tree, shear, origin })
    }

    /// Along which of up to [`RayCaster::MOST_RAYS`] parallel rays anything lies: a bit for each. Rays that lie close together
    /// cost a fraction of what they cost one by one.
    pub fn blocked_beam(&self, origins: &[DVec3], shear: &Shear) -> u64 {
        if origins.is_empty() { 0 } else { self.level.run(BlockedBeam { tree: &self.tree, shear, origins }) }
    }

    /// As [`RayCaster::first_hit`], for up to [`RayCaster::MOST_RAYS`] parallel rays at once: each one's place in `hits` is set.
    pub fn first_hits(&self, origins: &[DVec3], shear: &Shear, hits: &mut [Option<(u32, f64)>]) {
        if !origins.is_empty() {
            self.level.run(FirstHits { tree: &self.tree, shear, origins, hits });
        }
    }

    /// How many faces lie along a ray: the count that a shadow volume must have at its origin.
    #[cfg(feature = "test-hooks")]
    pub fn crossings(&self, origin: DVec3, direction: DVec3) -> usize {
        let shear = Shear::along(direction);
        let triangles = self
            .tree
            .blocks
            .iter()
            .flat_map(|block| (0..block.there.count_ones()).map(|at| block.triangle(at as usize)));
        triangles.filter(|corners| shear.hit(origin, corners).is_some()).count()
    }
}
