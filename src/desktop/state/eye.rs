//! The position of the eye: around a point, above it, or far in front of a façade.

use crate::site::Site;
use crate::site::file::CameraTable;
use crate::view::{Camera, Elevation, Grid, Side, View};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// From where one looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::desktop) enum Stand {
    /// A perspective from any direction.
    Perspective,
    /// Straight down, north up, without perspective.
    Plan,
    /// Level at a side, along parallel rays.
    Side(Side),
}

impl Stand {
    /// All of them, with their names.
    pub(in crate::desktop) const ALL: [(Stand, &'static str); 6] = [
        (Stand::Perspective, "Perspective"),
        (Stand::Plan, "Plan"),
        (Stand::Side(Side::North), "From north"),
        (Stand::Side(Side::East), "From east"),
        (Stand::Side(Side::South), "From south"),
        (Stand::Side(Side::West), "From west"),
    ];

    /// Where among those without perspective.
    fn flat(self) -> Option<usize> {
        match self {
            Stand::Perspective => None,
            Stand::Plan => Some(0),
            Stand::Side(side) => Some(1 + side as usize),
        }
    }
}

/// The eye and what it looks at. Each stand keeps its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::desktop) struct Eye {
    /// From where.
    pub(in crate::desktop) stand: Stand,
    /// The proportion of the picture in the window.
    pub(in crate::desktop) width_by_height: f64,
    /// That of a sheet's.
    of_sheet: f64,
    /// The point in the middle of the perspective, metres.
    target: DVec3,
    /// How far away from it the eye is, metres.
    distance: f64,
    /// The direction from the target to the eye, clockwise from north, radians.
    azimuth_rad: f64,
    /// The same above the horizon, radians.
    altitude_rad: f64,
    /// The vertical field of view, radians.
    fov_rad: f64,
    /// What the plan and the sides show; none before they are first seen.
    flat: [Option<ParallelView>; Stand::ALL.len() - 1],
}

/// What a picture without perspective shows.
#[derive(Clone, Copy, Debug, PartialEq)]
struct ParallelView {
    /// The point in its middle, metres.
    target: DVec3,
    /// How much it shows from its foot to its head, metres; of a side the sheet, which leaves nothing out that the
    /// window shows.
    height_m: f64,
}

const LOWEST_RAD: f64 = 0.02;
const HIGHEST_RAD: f64 = 1.55;
/// What stays free on each side of all that is shown, a share of the picture.
const BESIDE: f64 = 0.04;

impl Eye {
    /// The eye of a site's camera, or before the side that it shows.
    pub(in crate::desktop) fn of(site: &Site, written: &CameraTable) -> Eye {
        let camera = &site.camera;
        let back = camera.eye - camera.target;
        let distance = back.length().max(0.1);
        let of_sheet = f64::from(camera.width) / f64::from(camera.height.max(1));
        let mut eye = Eye {
            stand: site.side.map_or(Stand::Perspective, Stand::Side),
            width_by_height: of_sheet,
            of_sheet,
            target: camera.target,
            distance,
            azimuth_rad: back.x.atan2(back.y),
            altitude_rad: (back.z / distance).asin().clamp(LOWEST_RAD, HIGHEST_RAD),
            fov_rad: camera.fov_rad,
            flat: Default::default(),
        };
        // where nobody says how much of a side is to be seen, it is all
        if written.eye.is_some() || written.target.is_some() {
            eye.frame(camera.target, distance * eye.height_at_one());
        }
        eye
    }

    /// The camera that a site file keeps: that of the perspective, or one that sees at its target as much as the side's
    /// sheet shows.
    pub(in crate::desktop) fn kept(&self) -> Camera {
        let ParallelView { target, height_m } = self.framed();
        let distance = height_m / self.of_sheet_in_window() / self.height_at_one();
        Eye { target, distance, ..*self }.camera((16, 10))
    }

    /// How much of what a sheet is high the window is: what is wider than a sheet is as wide as that.
    fn of_sheet_in_window(&self) -> f64 {
        match self.stand {
            Stand::Side(_) => (self.of_sheet / self.width_by_height).min(1.0),
            _ => 1.0,
        }
    }

    /// Whether it is known what is to be seen from here.
    pub(in crate::desktop) fn is_framed(&self) -> bool {
        self.stand.flat().is_none_or(|flat| self.flat[flat].is_some())
    }

    /// Forgets what the plan and the sides showed.
    pub(in crate::desktop) fn forget_flat(&mut self) {
        self.flat = Default::default();
    }

    /// The point in the middle of the window's picture, and how much is seen there from foot to head, metres.
    fn framed(&self) -> ParallelView {
        let of_perspective = ParallelView { target: self.target, height_m: self.distance * self.height_at_one() };
        let ParallelView { target, height_m } =
            self.stand.flat().and_then(|flat| self.flat[flat]).unwrap_or(of_perspective);
        ParallelView { target, height_m: height_m * self.of_sheet_in_window() }
    }

    fn frame(&mut self, target: DVec3, height_m: f64) {
        match self.stand.flat() {
            Some(flat) => {
                self.flat[flat] = Some(ParallelView { target, height_m: height_m / self.of_sheet_in_window() });
            }
            None => (self.target, self.distance) = (target, height_m / self.height_at_one()),
        }
    }

    /// How much the perspective shows from foot to head, a metre before the eye.
    fn height_at_one(&self) -> f64 {
        2.0 * (self.fov_rad / 2.0).tan()
    }

    /// What is seen in a picture of so many pixels.
    pub(in crate::desktop) fn view(&self, (width, height): (u32, u32)) -> View {
        let (target, cell) = (self.framed().target, self.metres_a_pixel(height));
        if self.stand == Stand::Plan {
            let half = DVec2::new(f64::from(width), f64::from(height)) * cell / 2.0;
            let (west, north) = (target.x - half.x, target.y + half.y);
            return View::Plan(Grid { west, north, cell, width, height });
        }
        match self.stand {
            Stand::Side(side) => {
                View::Elevation(Elevation { target, to_viewer: side.to_viewer(), cell, width, height })
            }
            _ => View::Camera(self.camera((width, height))),
        }
    }

    /// The camera of the perspective.
    pub(in crate::desktop) fn camera(&self, (width, height): (u32, u32)) -> Camera {
        let (sin, cos) = self.altitude_rad.sin_cos();
        let back = DVec3::new(self.azimuth_rad.sin() * cos, self.azimuth_rad.cos() * cos, sin);
        let (target, fov_rad) = (self.target, self.fov_rad);
        Camera { eye: target + back * self.distance, target, up: DVec3::Z, fov_rad, width, height }
    }

    /// How large a pixel is at the target, metres.
    pub(in crate::desktop) fn metres_a_pixel(&self, height: u32) -> f64 {
        self.framed().height_m / f64::from(height.max(1))
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
    pub(in crate::desktop) fn orbit(&mut self, pixels: DVec2, height: f64) {
        let turn = PI / height.max(1.0);
        self.azimuth_rad += pixels.x * turn;
        self.altitude_rad = (self.altitude_rad + pixels.y * turn).clamp(LOWEST_RAD, HIGHEST_RAD);
    }

    /// Moves with the ground under the hand by so many pixels.
    pub(in crate::desktop) fn pan(&mut self, pixels: DVec2, height: u32) {
        let [right, up] = self.across();
        let ParallelView { target, height_m } = self.framed();
        self.frame(target + (up * pixels.y - right * pixels.x) * self.metres_a_pixel(height), height_m);
    }

    /// The point as far away as the target that lies so many pixels right of and below the middle.
    pub(in crate::desktop) fn beside_target(&self, from_middle: DVec2, height: u32) -> DVec3 {
        let [right, up] = self.across();
        self.framed().target + (right * from_middle.x - up * from_middle.y) * self.metres_a_pixel(height)
    }

    /// Comes nearer by a factor, within limits of the distance, about a point: it stays where it is in the picture.
    pub(in crate::desktop) fn zoom(&mut self, factor: f64, about: DVec3, limits: [f64; 2]) {
        let ParallelView { target, height_m } = self.framed();
        let [least, most] = limits.map(|distance| distance * self.height_at_one());
        let height = (height_m / factor).clamp(least, most);
        self.frame(about + (target - about) * (height / height_m), height);
    }

    /// Shows a box whole in the window; a side stands on the ground, which is the box's lower end.
    pub(in crate::desktop) fn fit(&mut self, (low, high): (DVec3, DVec3)) {
        let (middle, half) = ((low + high) / 2.0, (high - low) / 2.0);
        if self.stand == Stand::Perspective {
            let [right, up] = self.across();
            let corner = |at: i32| DVec3::new(sign(at, 1), sign(at, 2), sign(at, 4)) * half;
            let nearer = right.cross(up);
            let needed = |corner: DVec3| {
                let across = (corner.dot(right).abs() / self.width_by_height).max(corner.dot(up).abs());
                across * 2.0 / self.height_at_one() + corner.dot(nearer)
            };
            let distance = (0..8).map(corner).map(needed).fold(0.1, f64::max) / (1.0 - 2.0 * BESIDE);
            (self.target, self.distance) = (middle, distance);
            return;
        }
        let (target, height_m) = match self.stand {
            Stand::Side(side) => side.around((low, high), self.width_by_height),
            _ => (middle, 2.0 * half.y.max(half.x / self.width_by_height).max(0.05) / (1.0 - 2.0 * BESIDE)),
        };
        self.frame(target, height_m);
    }
}

fn sign(bits: i32, bit: i32) -> f64 {
    if bits & bit == 0 { -1.0 } else { 1.0 }
}
