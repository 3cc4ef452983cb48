//! Casts rays at one mesh.

use super::beam::{BlockedBeam, FirstHits, MOST_RAYS};
#[cfg(feature = "test-hooks")]
use super::counted::{CountedRay, RayCounts};
use super::lanes::SimdLevel;
use super::raster::{BlockedCells, BlockedRaster, RasterFate, RayRaster};
use super::search::{BlockedRay, FirstHit};
use super::shear::Shear;
use super::tree::WideTree;
use crate::mesh::Mesh;
use glam::{DVec3, Vec3};

/// Casts rays at one mesh. Points and directions are relative to the mesh's origin.
#[doc(hidden)]
pub struct RayCaster {
    tree: WideTree,
    level: SimdLevel,
}

impl RayCaster {
    /// The number of parallel rays that can be traced at once.
    pub const MOST_RAYS: usize = MOST_RAYS;

    /// Builds the tree; `reach` is the greatest distance of a ray's origin from the mesh's origin, metres.
    pub fn new(mesh: &Mesh, reach: f64) -> RayCaster {
        let size = mesh.vertices.iter().fold(0.0f32, |size, vertex| size.max(vertex.abs().max_element()));
        // covers the rounding of a ray's place in single precision, slid along it, and of the products in plane tests
        let padding = (f64::from(size) + reach) * f64::from(f32::EPSILON) * 16.0;
        RayCaster { tree: WideTree::new(mesh, padding as f32), level: SimdLevel::best() }
    }

    /// The same with the instructions of one level, for tests and measurements.
    #[cfg(feature = "test-hooks")]
    pub fn on(self, level: SimdLevel) -> RayCaster {
        RayCaster { level, ..self }
    }

    /// Returns the nearest face along a ray, and its distance in lengths of `direction`; of equally near ones the
    /// first.
    pub fn first_hit(&self, origin: DVec3, direction: DVec3) -> Option<(u32, f64)> {
        self.first_hit_of(origin, direction, |_| true)
    }

    /// The same among those faces that are kept, by their corners.
    pub fn first_hit_of(
        &self,
        origin: DVec3,
        direction: DVec3,
        keep: impl Fn(&[Vec3; 3]) -> bool,
    ) -> Option<(u32, f64)> {
        self.level.run(FirstHit { tree: &self.tree, shear: &Shear::along(direction), origin, keep })
    }

    /// Whether anything is in the way of a ray.
    pub fn blocked(&self, origin: DVec3, shear: &Shear) -> bool {
        self.blocked_of(origin, shear, |_| true)
    }

    /// The same for those faces that are kept, by their corners.
    pub fn blocked_of(&self, origin: DVec3, shear: &Shear, keep: impl Fn(&[Vec3; 3]) -> bool) -> bool {
        self.level.run(BlockedRay { tree: &self.tree, shear, origin, keep })
    }

    /// Returns which of up to [`RayCaster::MOST_RAYS`] parallel rays are blocked: a bit for each. Rays that are close
    /// together cost a fraction of single ones.
    pub fn blocked_beam(&self, origins: &[DVec3], shear: &Shear) -> u64 {
        if origins.is_empty() { 0 } else { self.level.run(BlockedBeam { tree: &self.tree, shear, origins }) }
    }

    /// Finds which parallel rays of a raster are blocked; sets `found` if they differ. Returns also the
    /// number of rays that were tested by themselves.
    pub fn blocked_raster<P: Fn(u32, u32) -> DVec3>(
        &self,
        raster: &RayRaster<'_, P>,
        shear: &Shear,
        found: &mut BlockedCells,
    ) -> (RasterFate, u64) {
        self.level.run(BlockedRaster { tree: &self.tree, shear, raster, found })
    }

    /// As [`RayCaster::first_hit`], for up to [`RayCaster::MOST_RAYS`] parallel rays at once; sets each one's entry in
    /// `hits`.
    pub fn first_hits(&self, origins: &[DVec3], shear: &Shear, hits: &mut [Option<(u32, f64)>]) {
        if !origins.is_empty() {
            self.level.run(FirstHits { tree: &self.tree, shear, origins, hits });
        }
    }

    /// Counts what [`RayCaster::blocked`] tests.
    #[cfg(feature = "test-hooks")]
    pub fn counted(&self, origin: DVec3, shear: &Shear) -> RayCounts {
        self.level.run(CountedRay { tree: &self.tree, shear, origin })
    }

    /// Returns the number of faces along a ray: the count that a shadow volume must have at its origin.
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
