//! A bounding-volume tree over the faces that cast, and its boxes and faces as a probe sees them.

use super::sift::Halfspace;
use super::sky_cells::SunPyramid;
use super::sun_path::MOST_OFF_RAD;
use super::wall_front::WallFront;
use glam::{DVec3, Vec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::{Bvh2, builder::build_bvh2};
use std::time::Duration;

/// A binary tree of boxes.
pub(super) struct FaceTree {
    tree: Option<Bvh2>,
    /// The faces' corners in the tree's order, relative to the mesh's origin.
    corners: Vec<[Vec3; 3]>,
}

/// The contents of one of the tree's boxes.
pub(super) enum BoxContents<'a> {
    Boxes([u32; 2]),
    Faces(&'a [[Vec3; 3]]),
}

/// A box as a probe sees it.
pub(super) struct SeenBox {
    middle: DVec3,
    half: DVec3,
}

impl FaceTree {
    /// The tree over faces, by their corners relative to the mesh's origin.
    pub(super) fn new(faces: &[[Vec3; 3]]) -> FaceTree {
        let box_of = |corners: &[Vec3; 3]| {
            let [a, b, c] = corners.map(Vec3A::from);
            Aabb::new(a.min(b).min(c), a.max(b).max(c))
        };
        let boxes: Vec<Aabb> = faces.iter().map(box_of).collect();
        let build = || build_bvh2(&boxes, BvhBuildParams::fast_build(), &mut Duration::default());
        let tree = (!boxes.is_empty()).then(build);
        let order = tree.as_ref().map_or(&[][..], |tree| &tree.primitive_indices);
        FaceTree { corners: order.iter().map(|&face| faces[face as usize]).collect(), tree }
    }

    /// The box around everything; `None` without faces.
    pub(super) fn root(&self) -> Option<u32> {
        self.tree.as_ref().map(|_| 0)
    }

    /// A box as it is seen from a point.
    pub(super) fn seen(&self, at: u32, point: DVec3) -> SeenBox {
        let Some(tree) = &self.tree else { return SeenBox { middle: DVec3::ZERO, half: DVec3::ZERO } };
        let bounds = &tree.nodes[at as usize].aabb();
        let [low, high] = [bounds.min, bounds.max].map(|corner| Vec3::from(corner).as_dvec3());
        SeenBox { middle: (low + high) / 2.0 - point, half: (high - low) / 2.0 }
    }

    pub(super) fn within(&self, at: u32) -> BoxContents<'_> {
        let Some(tree) = &self.tree else { return BoxContents::Faces(&[]) };
        let node = &tree.nodes[at as usize];
        let first = node.first_index;
        match node.prim_count {
            0 => BoxContents::Boxes([first, first + 1]),
            count => BoxContents::Faces(&self.corners[first as usize..(first + count) as usize]),
        }
    }
}

impl SeenBox {
    /// Whether the whole box lies outside of a pyramid.
    pub(super) fn is_outside(&self, pyramid: &SunPyramid) -> bool {
        // more than the rounding errors add up to
        let near = 1e-9 * (self.middle.abs().max_element() + self.half.max_element());
        pyramid.sides.iter().any(|side| side.dot(self.middle) + side.abs().dot(self.half) < -near)
    }

    /// Whether it is large compared with the pyramid at its distance, or close to the probe.
    pub(super) fn is_large(&self, pyramid: &SunPyramid) -> bool {
        let radius = self.half.length();
        let away = self.middle.length() - radius;
        radius > 3.0 * away * pyramid.half
    }

    /// Whether it may reach in front of a wall, for the point that sees it.
    pub(super) fn may_reach(&self, front: &WallFront, point: DVec3) -> bool {
        front.may_have(self.middle + point, self.half)
    }

    /// The square of its least distance.
    pub(super) fn nearest(&self) -> f64 {
        (self.middle.abs() - self.half).max(DVec3::ZERO).length_squared()
    }

    /// Its extent along the direction of time, on the plane perpendicular to the pyramid's axis.
    pub(super) fn along(&self, pyramid: &SunPyramid) -> [f64; 2] {
        let depth = pyramid.axis.dot(self.middle);
        let deep = pyramid.axis.abs().dot(self.half);
        if depth <= deep * 1.000_001 {
            return [f64::NEG_INFINITY, f64::INFINITY];
        }
        let [mut low, mut high] = [f64::INFINITY, f64::NEG_INFINITY];
        for corner in 0..8 {
            let sign = |axis: usize| if corner >> axis & 1 == 0 { -1.0 } else { 1.0 };
            let at = self.middle + self.half * DVec3::new(sign(0), sign(1), sign(2));
            let x = pyramid.along.dot(at) / pyramid.axis.dot(at);
            low = low.min(x);
            high = high.max(x);
        }
        [low, high]
    }
}

/// The corners of a face, relative to the probe.
#[derive(Clone, Copy)]
pub(super) struct SeenCorners([DVec3; 3]);

/// A face as a probe sees it.
#[derive(Clone)]
pub(super) struct SeenFace {
    pub(super) corners: SeenCorners,
    /// Planes through the probe and each side. A ray that hits the face is in front of all three.
    pub(super) sides: [Halfspace; 3],
    /// Whether the probe lies in the face's plane, within rounding. The sides then only exclude rays.
    pub(super) is_flat: bool,
}

/// How many of a cell's suns a face covers, as far as that is certain.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum SunCoverage {
    None,
    Part,
    Full,
}

impl SeenCorners {
    pub(super) fn new(corners: &[Vec3; 3], point: DVec3) -> SeenCorners {
        SeenCorners(corners.map(|corner| corner.as_dvec3() - point))
    }

    /// Whether one of the pyramid's sides separates it from the face.
    pub(super) fn is_beside(&self, pyramid: &SunPyramid) -> bool {
        pyramid.sides.iter().any(|side| self.0.iter().all(|corner| side.dot(*corner) < 0.0))
    }

    /// The square of the nearest corner's distance.
    pub(super) fn nearest(&self) -> f64 {
        self.0.iter().map(|corner| corner.length_squared()).fold(f64::INFINITY, f64::min)
    }

    /// As for [`SeenBox::along`].
    pub(super) fn along(&self, pyramid: &SunPyramid) -> [f64; 2] {
        let mut along = [f64::INFINITY, f64::NEG_INFINITY];
        for corner in &self.0 {
            let depth = pyramid.axis.dot(*corner);
            if depth <= 0.0 {
                return [f64::NEG_INFINITY, f64::INFINITY];
            }
            let x = pyramid.along.dot(*corner) / depth;
            along = [along[0].min(x), along[1].max(x)];
        }
        along
    }
}

impl SeenFace {
    pub(super) fn new(corners: SeenCorners) -> SeenFace {
        /// More than the rounding error of a product of two lengths.
        const ROUNDING: f64 = 1e-13;
        let seen = corners;
        let corners @ [a, b, c] = corners.0;
        let lengths = corners.map(DVec3::length);
        let volume = a.cross(b).dot(c);
        let sign = 1f64.copysign(volume);
        let side = |from: usize, to: usize| Halfspace {
            normal: corners[from].cross(corners[to]) * sign,
            slack: ROUNDING * lengths[from] * lengths[to],
        };
        SeenFace {
            corners: seen,
            sides: [side(0, 1), side(1, 2), side(2, 0)],
            is_flat: volume.is_nan() || volume.abs() <= ROUNDING * lengths.iter().product::<f64>(),
        }
    }

    /// How much of a pyramid's suns it covers.
    pub(super) fn coverage(&self, pyramid: &SunPyramid) -> SunCoverage {
        if self.corners.is_beside(pyramid) {
            return SunCoverage::None;
        }
        if self.is_flat {
            return SunCoverage::Part;
        }
        let mut before = true;
        for Halfspace { normal, slack } in &self.sides {
            let values = pyramid.corners.map(|corner| normal.dot(corner));
            let near = MOST_OFF_RAD * normal.length() + 4.0 * slack;
            if values.iter().all(|value| *value < -near) {
                return SunCoverage::None;
            }
            before &= values.iter().all(|value| *value > near);
        }
        if before { SunCoverage::Full } else { SunCoverage::Part }
    }
}
