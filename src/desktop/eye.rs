//! Where the eye is: around a point, above it, or far before a façade.

use crate::view::{Camera, Grid, View};
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// From where one looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stand {
    /// From anywhere around.
    Perspective,
    /// Straight down, north up, without perspective.
    Plan,
    /// Level at the side that looks this way, through a lens so long that hardly anything converges.
    North,
    /// The same from the east.
    East,
    /// The same from the south.
    South,
    /// The same from the west.
    West,
}

impl Stand {
    /// All of them, with their names.
    pub(super) const ALL: [(Stand, &'static str); 6] = [
        (Stand::Perspective, "Perspective"),
        (Stand::Plan, "Plan"),
        (Stand::North, "From north"),
        (Stand::East, "From east"),
        (Stand::South, "From south"),
        (Stand::West, "From west"),
    ];

    /// The azimuth of an elevation's eye, radians.
    fn azimuth_rad(self) -> Option<f64> {
        match self {
            Stand::Perspective | Stand::Plan => None,
            Stand::North => Some(0.0),
            Stand::East => Some(FRAC_PI_2),
            Stand::South => Some(PI),
            Stand::West => Some(-FRAC_PI_2),
        }
    }
}

/// The eye and what it looks at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Eye {
    /// From where.
    pub(super) stand: Stand,
    /// The point in the middle of the picture, metres.
    pub(super) target: DVec3,
    /// How far away the eye of the perspective is; other stands show as much as it does there.
    pub(super) distance: f64,
    /// The direction from the target to the eye, clockwise from north, radians.
    pub(super) azimuth_rad: f64,
    /// The same above the horizon, radians.
    pub(super) altitude_rad: f64,
    /// The perspective's vertical field of view, radians.
    pub(super) fov_rad: f64,
}

/// The lens of elevations, radians.
const LONG_LENS_RAD: f64 = 8.0 * PI / 180.0;
const LOWEST_RAD: f64 = 0.02;
const HIGHEST_RAD: f64 = 1.55;

impl Eye {
    /// The eye of a site's camera.
    pub(super) fn of(camera: &Camera) -> Eye {
        let back = camera.eye - camera.target;
        let distance = back.length().max(0.1);
        Eye {
            stand: Stand::Perspective,
            target: camera.target,
            distance,
            azimuth_rad: back.x.atan2(back.y),
            altitude_rad: (back.z / distance).asin().clamp(LOWEST_RAD, HIGHEST_RAD),
            fov_rad: camera.fov_rad,
        }
    }

    /// What is seen in a picture of so many pixels.
    pub(super) fn view(&self, (width, height): (u32, u32)) -> View {
        if self.stand == Stand::Plan {
            let cell = self.metres_a_pixel(height);
            let half = DVec2::new(f64::from(width), f64::from(height)) * cell / 2.0;
            let (west, north) = (self.target.x - half.x, self.target.y + half.y);
            return View::Plan(Grid { west, north, cell, width, height });
        }
        View::Camera(self.camera((width, height)))
    }

    /// The camera of perspective and elevations.
    pub(super) fn camera(&self, (width, height): (u32, u32)) -> Camera {
        let (azimuth, altitude, fov_rad) = match self.stand.azimuth_rad() {
            Some(azimuth) => (azimuth, 0.0, LONG_LENS_RAD),
            None => (self.azimuth_rad, self.altitude_rad, self.fov_rad),
        };
        let distance = self.distance * (self.fov_rad / 2.0).tan() / (fov_rad / 2.0).tan();
        let (sin, cos) = altitude.sin_cos();
        let back = DVec3::new(azimuth.sin() * cos, azimuth.cos() * cos, sin);
        Camera { eye: self.target + back * distance, target: self.target, up: DVec3::Z, fov_rad, width, height }
    }

    /// How large a pixel is at the target, metres.
    pub(super) fn metres_a_pixel(&self, height: u32) -> f64 {
        2.0 * self.distance * (self.fov_rad / 2.0).tan() / f64::from(height.max(1))
    }

    /// Rightwards and upwards in the picture.
    fn across(&self) -> [DVec3; 2] {
        match self.stand {
            Stand::Plan => [DVec3::X, DVec3::Y],
            _ => {
                let [right, up, _] = self.camera((1, 1)).axes();
                [right, up]
            }
        }
    }

    /// Turns around the target by so many pixels of a picture so high.
    pub(super) fn orbit(&mut self, pixels: DVec2, height: f64) {
        let turn = PI / height.max(1.0);
        self.azimuth_rad += pixels.x * turn;
        self.altitude_rad = (self.altitude_rad + pixels.y * turn).clamp(LOWEST_RAD, HIGHEST_RAD);
    }

    /// Moves with the ground under the hand by so many pixels.
    pub(super) fn pan(&mut self, pixels: DVec2, height: u32) {
        let [right, up] = self.across();
        self.target += (up * pixels.y - right * pixels.x) * self.metres_a_pixel(height);
    }

    /// The point as far away as the target that lies so many pixels right of and below the middle.
    pub(super) fn beside_target(&self, from_middle: DVec2, height: u32) -> DVec3 {
        let [right, up] = self.across();
        self.target + (right * from_middle.x - up * from_middle.y) * self.metres_a_pixel(height)
    }

    /// Comes nearer by a factor, within limits, about a point: it stays where it is in the picture.
    pub(super) fn zoom(&mut self, factor: f64, about: DVec3, limits: [f64; 2]) {
        let distance = (self.distance / factor).clamp(limits[0], limits[1]);
        self.target = about + (self.target - about) * (distance / self.distance);
        self.distance = distance;
    }

    /// Shows a box whole, in a picture of that proportion.
    pub(super) fn fit(&mut self, (low, high): (DVec3, DVec3), width_by_height: f64) {
        self.target = (low + high) / 2.0;
        let half = (self.fov_rad / 2.0).tan();
        let corners = (0..8).map(|corner| {
            DVec3::new(
                if corner & 1 == 0 { low.x } else { high.x },
                if corner & 2 == 0 { low.y } else { high.y },
                if corner & 4 == 0 { low.z } else { high.z },
            ) - self.target
        });
        let [right, up] = self.across();
        let nearer = match self.stand {
            Stand::Perspective => right.cross(up),
            _ => DVec3::ZERO,
        };
        let needed = |corner: DVec3| {
            let across = (corner.dot(right).abs() / width_by_height).max(corner.dot(up).abs());
            across / half + corner.dot(nearer)
        };
        self.distance = corners.map(needed).fold(0.1, f64::max) * 1.08;
    }
}
