//! The frame in which parallel rays are an axis, and the deciding test in double precision.

use super::tree::EIGHT;
use glam::{DVec3, Vec3};

/// The frame in which a direction is an axis; it is the same for all parallel rays.
#[doc(hidden)]
pub struct Shear {
    /// The axes right, up and forward: the direction's largest component is along forward.
    pub(super) axes: [usize; 3],
    /// The direction's change to the right and up for one metre forward, and the reciprocal of its forward component.
    pub(super) scale: DVec3,
    /// In single precision, for excluding only: the change to the right and up for one metre along the forward axis,
    /// the direction's sign along that axis, and for each axis the reciprocal of its speed.
    pub(super) slope: [f32; 2],
    pub(super) sign: f32,
    pub(super) per_metre: [f32; 3],
}

/// The least slope of a ray against an axis: smaller ones have no effect after rounding.
const LEAST_SLOPE: f32 = 1e-12;

impl Shear {
    /// For rays along a direction, which must not be zero.
    pub fn along(direction: DVec3) -> Shear {
        let forward = direction.abs().max_position();
        let (mut right, mut up) = ((forward + 1) % 3, (forward + 2) % 3);
        if direction[forward] < 0.0 {
            std::mem::swap(&mut right, &mut up);
        }
        let scale = DVec3::new(direction[right], direction[up], 1.0) / direction[forward];
        let slope = [scale.x as f32, scale.y as f32];
        let sign = if direction[forward] < 0.0 { -1.0 } else { 1.0 };
        let per_metre = |slope: f32| {
            let speed = slope * sign;
            1.0 / if speed.abs() < LEAST_SLOPE { LEAST_SLOPE } else { speed }
        };
        let per_metre = [per_metre(slope[0]), per_metre(slope[1]), sign];
        Shear { axes: [right, up, forward], scale, slope, sign, per_metre }
    }

    /// As [`Shear::hit`] for eight parallel rays: the same computation in the same order, with SIMD if the processor
    /// has it. Origins are by the rays' axes. A miss has an infinite distance.
    #[inline(always)]
    pub(super) fn hits(&self, origins: [&[f64; EIGHT]; 3], corners: &[Vec3; 3]) -> [f64; EIGHT] {
        let mut hits = [f64::INFINITY; EIGHT];
        let corner = |at: usize| {
            let [right, up, forward] = self.axes;
            [f64::from(corners[at][right]), f64::from(corners[at][up]), f64::from(corners[at][forward])]
        };
        let corners = [corner(0), corner(1), corner(2)];
        for (lane, hit) in hits.iter_mut().enumerate() {
            let mut seen = [[0.0; 3]; 3];
            for (seen, corner) in seen.iter_mut().zip(&corners) {
                let ahead = corner[2] - origins[2][lane];
                *seen = [
                    corner[0] - origins[0][lane] - self.scale.x * ahead,
                    corner[1] - origins[1][lane] - self.scale.y * ahead,
                    ahead * self.scale.z,
                ];
            }
            let [a, b, c] = seen;
            let u = c[0] * b[1] - c[1] * b[0];
            let v = a[0] * c[1] - a[1] * c[0];
            let w = b[0] * a[1] - b[1] * a[0];
            let beside = ((u < 0.0) | (v < 0.0) | (w < 0.0)) & ((u > 0.0) | (v > 0.0) | (w > 0.0));
            let area = u + v + w;
            let distance = (u * a[2] + v * b[2] + w * c[2]) / area;
            *hit = if !beside & (area != 0.0) & (distance > 0.0) { distance } else { f64::INFINITY };
        }
        hits
    }

    /// The distance at which a ray meets the triangle, in lengths of the direction; `None` behind the origin or beside
    /// it.
    #[inline(always)]
    pub(in crate::shadow) fn hit(&self, origin: DVec3, corners: &[Vec3; 3]) -> Option<f64> {
        let [a, b, c] = corners;
        let (a, b, c) = (self.seen(origin, a), self.seen(origin, b), self.seen(origin, c));
        let u = c[0] * b[1] - c[1] * b[0];
        let v = a[0] * c[1] - a[1] * c[0];
        let w = b[0] * a[1] - b[1] * a[0];
        if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
            return None;
        }
        let area = u + v + w;
        // 0: the triangle is edge-on or has no area, and shades nothing
        let distance = (area != 0.0).then(|| (u * a[2] + v * b[2] + w * c[2]) / area)?;
        (distance > 0.0).then_some(distance)
    }

    /// A corner relative to a ray's origin: right and up in the sheared frame, and how many lengths of the direction
    /// ahead.
    #[inline(always)]
    fn seen(&self, origin: DVec3, corner: &Vec3) -> [f64; 3] {
        let [right, up, forward] = self.axes;
        let from_origin = corner.as_dvec3() - origin;
        let ahead = from_origin[forward];
        [from_origin[right] - self.scale.x * ahead, from_origin[up] - self.scale.y * ahead, ahead * self.scale.z]
    }
}
