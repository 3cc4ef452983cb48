//! Where the eye is: around a point, above it, or far before a façade.

use crate::site::Site;
use crate::view::{Camera, Grid, Side, View};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// From where one looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stand {
    /// From anywhere around.
    Perspective,
    /// Straight down, north up, without perspective.
    Plan,
    /// Level at a side, along parallel rays.
    Side(Side),
}

impl Stand {
    /// All of them, with their names.
    pub(super) const ALL: [(Stand, &'static str); 6] = [
        (Stand::Perspective, "Perspective"),
        (Stand::Plan, "Plan"),
        (Stand::Side(Side::North), "From north"),
        (Stand::Side(Side::East), "From east"),
        (Stand::Side(Side::South), "From south"),
        (Stand::Side(Side::West), "From west"),
    ];
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

const LOWEST_RAD: f64 = 0.02;
const HIGHEST_RAD: f64 = 1.55;

impl Eye {
    /// The eye of a site's camera, or before the side that it shows.
    pub(super) fn of(site: &Site) -> Eye {
        let camera = &site.camera;
        let back = camera.eye - camera.target;
        let distance = back.length().max(0.1);
        Eye {
            stand: site.side.map_or(Stand::Perspective, Stand::Side),
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
        let camera = self.camera((width, height));
        match self.stand {
            Stand::Side(side) => View::Elevation(camera.side(side)),
            _ => View::Camera(camera),
        }
    }

    /// The camera of the perspective.
    pub(super) fn camera(&self, (width, height): (u32, u32)) -> Camera {
        let (sin, cos) = self.altitude_rad.sin_cos();
        let back = DVec3::new(self.azimuth_rad.sin() * cos, self.azimuth_rad.cos() * cos, sin);
        let (target, fov_rad) = (self.target, self.fov_rad);
        Camera { eye: target + back * self.distance, target, up: DVec3::Z, fov_rad, width, height }
    }

    /// How large a pixel is at the target, metres.
    pub(super) fn metres_a_pixel(&self, height: u32) -> f64 {
        2.0 * self.distance * (self.fov_rad / 2.0).tan() / f64::from(height.max(1))
    }

    /// Rightwards and upwards in the picture.
    fn across(&self) -> [DVec3; 2] {
        match self.view((1, 1)) {
            View::Plan(_) => [DVec3::X, DVec3::Y],
            View::Elevation(side) => [side.axes()[0], DVec3::Z],
            View::Camera(_) => {
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
