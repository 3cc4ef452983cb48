//! What a search visits, in counts that do not depend on load.

use super::frame::BeamFrame;
use super::lanes::{LaneWork, Simd};
use super::search::{AnyHit, AskedBlock, BlockVisitor, traverse};
use super::shear::Shear;
use super::tree::{TriangleBlock, WideTree};
use glam::{DVec3, Vec3};

/// What searches for anything in the way of rays have tested.
#[doc(hidden)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RayCounts {
    /// Nodes, of eight boxes each.
    pub nodes: u64,
    /// Faces, in blocks of up to eight.
    pub faces: u64,
}

/// Counts what the search of one ray tests.
pub(super) struct CountedRay<'a> {
    pub(super) tree: &'a WideTree,
    pub(super) shear: &'a Shear,
    pub(super) origin: DVec3,
}

impl LaneWork for CountedRay<'_> {
    type Output = RayCounts;
    #[inline(always)]
    fn run<S: Simd>(self) -> RayCounts {
        let (search, frame) = AnyHit::of(self.shear, self.origin, |_: &[Vec3; 3]| true);
        let mut counting = CountingVisitor { search, counts: RayCounts::default() };
        traverse::<S, _>(self.tree, &frame, &mut counting);
        counting.counts
    }
}

struct CountingVisitor<'a, K> {
    search: AnyHit<'a, K>,
    counts: RayCounts,
}

impl<K: Fn(&[Vec3; 3]) -> bool> BlockVisitor for CountingVisitor<'_, K> {
    #[inline(always)]
    fn enter(&mut self) {
        self.counts.nodes += 1;
    }
    #[inline(always)]
    fn visit<S: Simd>(&mut self, frame: &BeamFrame<'_>, asked: AskedBlock, block: &TriangleBlock) -> bool {
        self.counts.faces += u64::from(asked.triangles.count_ones());
        self.search.visit::<S>(frame, asked, block)
    }
}
