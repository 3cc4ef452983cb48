//! A perspective camera, and the directions of its pixels.

use super::{Elevation, Side};
use glam::{DMat4, DVec2, DVec3, DVec4};

/// A perspective camera in the world frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The position of the eye, metres.
    pub eye: DVec3,
    /// The point in the middle of the picture, metres.
    pub target: DVec3,
    /// The direction that is up in the picture.
    pub up: DVec3,
    /// Vertical field of view, radians.
    pub fov_rad: f64,
    /// Picture width, pixels.
    pub width: u32,
    /// Picture height, pixels.
    pub height: u32,
}

impl Camera {
    /// The distance of the near plane, metres. Anything nearer to the eye is not drawn.
    pub const NEAR_M: f64 = 0.05;

    /// Rightwards, upwards and forwards in the picture: unit vectors in the world frame.
    pub fn axes(&self) -> [DVec3; 3] {
        let forward = (self.target - self.eye).normalize();
        let right = forward.cross(self.up).normalize();
        [right, right.cross(forward), forward]
    }

    /// Half the picture's width and height at distance 1.
    pub fn half_size(&self) -> DVec2 {
        let half_height = (self.fov_rad / 2.0).tan();
        DVec2::new(half_height * f64::from(self.width) / f64::from(self.height), half_height)
    }

    /// The view of a side with the same middle point and the same extent as the perspective there.
    pub fn side(&self, side: Side) -> Elevation {
        let Camera { target, width, height, .. } = *self;
        let cell = 2.0 * (self.eye - target).length() * (self.fov_rad / 2.0).tan() / f64::from(height);
        Elevation { target, to_viewer: side.to_viewer(), cell, width, height }
    }

    /// The direction of a pixel's centre, a unit vector in the world frame.
    pub fn direction(&self, column: u32, row: u32) -> DVec3 {
        self.lens().direction(column, row)
    }

    /// The part of the computation that all pixels share.
    #[doc(hidden)]
    pub fn lens(&self) -> Lens {
        Lens {
            axes: self.axes(),
            half: self.half_size(),
            size: DVec2::new(f64::from(self.width), f64::from(self.height)),
        }
    }

    /// The perspective, from the near plane (depth 1) to infinity (depth 0).
    ///
    /// *Geometry of Real Time Shadows*, section 6, with depth reversed: a point at infinity has depth 0 exactly, so
    /// that no volume is cut at a far plane on any adapter, and `f32` depth keeps its precision far away.
    pub fn clip_from_world(&self) -> DMat4 {
        let [right, up, forward] = self.axes();
        let row = |axis: DVec3, scale: f64| (axis * scale).extend(-axis.dot(self.eye) * scale);
        let half = self.half_size();
        let rows = [
            row(right, 1.0 / half.x),
            row(up, 1.0 / half.y),
            DVec4::new(0.0, 0.0, 0.0, Self::NEAR_M),
            row(forward, 1.0),
        ];
        DMat4::from_cols_array_2d(&rows.map(|row| row.to_array())).transpose()
    }
}

/// A camera's axes and field of view, computed once for all of its pixels.
#[derive(Clone, Copy, Debug)]
pub struct Lens {
    axes: [DVec3; 3],
    half: DVec2,
    size: DVec2,
}

impl Lens {
    /// As [`Camera::direction`].
    pub fn direction(&self, column: u32, row: u32) -> DVec3 {
        let [right, up, forward] = self.axes;
        let x = ((f64::from(column) + 0.5) / self.size.x * 2.0 - 1.0) * self.half.x;
        let y = (1.0 - (f64::from(row) + 0.5) / self.size.y * 2.0) * self.half.y;
        (forward + right * x + up * y).normalize()
    }

    /// Forwards in the picture.
    pub fn forward(&self) -> DVec3 {
        self.axes[2]
    }
}
