//! Parallel rays in the frame of their direction, tested against boxes.

use super::lanes::Lanes;
use super::shear::Shear;
use super::tree::WideNode;

/// Parallel rays: where each meets the plane through the reference across its longest axis, and how far ahead of it it
/// begins. Values are in single precision, relative to the reference, by the axes of [`Shear`].
pub(super) struct BeamFrame<'a> {
    pub(super) shear: &'a Shear,
    /// By the rays' axes.
    pub(super) reference: [f32; 3],
    /// The middle of the rays' plane positions and starts, and the greatest distance from it.
    pub(super) middle: [f32; 3],
    pub(super) half: [f32; 3],
    /// No value of a ray, and no distance of its origin from the reference along an axis, is larger.
    pub(super) size: f32,
    /// The earliest start, metres from the plane along the rays' direction.
    start: f32,
    /// By axis: the plane of a box that rays meet first and the coordinate from which they reach it soonest, the plane
    /// that they meet last and the coordinate from which they reach it latest, and the reciprocal of their speed.
    sides: [BoxSide; 3],
}

#[derive(Clone, Copy)]
struct BoxSide {
    near: usize,
    near_from: f32,
    far: usize,
    far_from: f32,
    per_metre: f32,
}

/// The reference for rays from a point: its value in single precision, by the rays' axes.
pub(super) fn reference(shear: &Shear, origin: glam::DVec3) -> [f32; 3] {
    let [right, up, forward] = shear.axes;
    [origin[right] as f32, origin[up] as f32, origin[forward] as f32]
}

/// A ray relative to the reference: where it meets the plane, right and up, and how far ahead of it it begins.
#[inline(always)]
pub(super) fn around(shear: &Shear, reference: &[f32; 3], origin: glam::DVec3) -> [f32; 3] {
    let off = |at: usize| origin[shear.axes[at]] - f64::from(reference[at]);
    let (right, up, ahead) = (off(0), off(1), off(2));
    [(right - shear.scale.x * ahead) as f32, (up - shear.scale.y * ahead) as f32, ahead as f32]
}

impl<'a> BeamFrame<'a> {
    /// The frame for rays with values between the lowest and the highest.
    #[inline(always)]
    pub(super) fn new(shear: &'a Shear, reference: [f32; 3], low: [f32; 3], high: [f32; 3]) -> BeamFrame<'a> {
        let side = |at: usize, low: f32, high: f32| {
            let (low, high) = (reference[at] + low, reference[at] + high);
            let (axis, per_metre) = (shear.axes[at], shear.per_metre[at]);
            if per_metre > 0.0 {
                BoxSide { near: axis, near_from: high, far: axis + 3, far_from: low, per_metre }
            } else {
                BoxSide { near: axis + 3, near_from: low, far: axis, far_from: high, per_metre }
            }
        };
        let middle = |at: usize| (low[at] + high[at]) * 0.5;
        let largest = |at: usize| low[at].abs().max(high[at].abs());
        let half = |at: usize| ((high[at] - low[at]) * 0.5 + largest(at) * f32::EPSILON) * 1.000_001;
        BeamFrame {
            shear,
            reference,
            middle: [middle(0), middle(1), middle(2)],
            // rounded up, since the middle is rounded
            half: [half(0), half(1), half(2)],
            size: largest(0).max(largest(1)).max(largest(2)) * 2.0,
            start: if shear.sign < 0.0 { -high[2] } else { low[2] },
            // along the forward axis all are in one plane
            sides: [side(0, low[0], high[0]), side(1, low[1], high[1]), side(2, 0.0, 0.0)],
        }
    }

    /// The boxes of a node that the rays may meet, and their distances: metres from the plane.
    #[inline(always)]
    pub(super) fn enter<L: Lanes>(&self, node: &WideNode, farthest: f32) -> (u32, L) {
        let mut near = L::splat(self.start);
        let mut far = L::splat(farthest);
        for &BoxSide { near: soon, near_from, far: late, far_from, per_metre } in &self.sides {
            let per_metre = L::splat(per_metre);
            near = near.most(L::load(&node.planes[soon]).minus(L::splat(near_from)).times(per_metre));
            far = far.least(L::load(&node.planes[late]).minus(L::splat(far_from)).times(per_metre));
        }
        (!far.less(near) & 0xff, near)
    }
}
