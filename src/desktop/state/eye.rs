//! The position of the eye: around a point, above it, or far in front of a façade.

use crate::site::Site;
use crate::site::file::CameraTable;
use crate::view::{Camera, Elevation, Grid, Side, View};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// The position from which one looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::desktop) enum Stand {
    /// A perspective from any direction.
    Perspective,
    /// Straight down, north up, in parallel projection.
    Plan,
    /// Horizontally at a side, along parallel rays.
    Side(Side),
}

impl Stand {
    /// All stands, with their names.
    pub(in crate::desktop) const ALL: [(Stand, &'static str); 6] = [
        (Stand::Perspective, "Perspective"),
        (Stand::Plan, "Plan"),
        (Stand::Side(Side::North), "From north"),
        (Stand::Side(Side::East), "From east"),
        (Stand::Side(Side::South), "From south"),
        (Stand::Side(Side::West), "From west"),
    ];

    /// The index among those without perspective.
    fn flat(self) -> Option<usize> {
        match self {
            Stand::Perspective => None,
            Stand::Plan => Some(0),
            Stand::Side(side) => Some(1 + side as usize),
        }
    }
}

/// The eye and its target. Each stand has its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::desktop) struct Eye {
    /// The stand.
    pub(in crate::desktop) stand: Stand,
    /// The aspect ratio of the picture in the window.
    pub(in crate::desktop) width_by_height: f64,
    /// The aspect ratio of a sheet.
    of_sheet: f64,
    /// The point in the middle of the perspective, metres.
    target: DVec3,
    /// The distance of the eye from it, metres.
    distance: f64,
    /// The direction from the target to the eye, clockwise from north, radians.
    azimuth_rad: f64,
    /// The altitude of that direction above the horizon, radians.
    altitude_rad: f64,
    /// The vertical field of view, radians.
    fov_rad: f64,
    /// The extents of the plan and the sides; `None` before they are first shown.
    flat: [Option<ParallelView>; Stand::ALL.len() - 1],
}

/// The extent of a picture without perspective.
#[derive(Clone, Copy, Debug, PartialEq)]
struct ParallelView {
    /// The point in its middle, metres.
    target: DVec3,
    /// Its height, metres; for a side, that of the sheet, which contains everything that the window shows.
    height_m: f64,
}

const LOWEST_RAD: f64 = 0.02;
const HIGHEST_RAD: f64 = 1.55;
/// The margin on each side of the contents, as a share of the picture.
const BESIDE: f64 = 0.04;

impl Eye {
    /// The eye of a site's camera, or in front of the side that it shows.
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
        // if the file does not say how much of a side to show, everything is shown
        if written.eye.is_some() || written.target.is_some() {
            eye.frame(camera.target, distance * eye.height_at_one());
        }
        eye
    }

    /// The camera for the site file: that of the perspective, or one that sees at its target the same extent as the
    /// side's sheet.
    pub(in crate::desktop) fn kept(&self) -> Camera {
        let ParallelView { target, height_m } = self.framed();
        let distance = height_m / self.of_sheet_in_window() / self.height_at_one();
        Eye { target, distance, ..*self }.camera((16, 10))
    }

    /// The height of the window's picture relative to a sheet's: a wider picture has the sheet's width.
    fn of_sheet_in_window(&self) -> f64 {
        match self.stand {
            Stand::Side(_) => (self.of_sheet / self.width_by_height).min(1.0),
            _ => 1.0,
        }
    }

    /// Whether the extent of this stand is known.
    pub(in crate::desktop) fn is_framed(&self) -> bool {
        self.stand.flat().is_none_or(|flat| self.flat[flat].is_some())
    }

    /// Forgets what the plan and the sides showed.
    pub(in crate::desktop) fn forget_flat(&mut self) {
        self.flat = Default::default();
    }

    /// The middle point of the window's picture, and its height there, metres.
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

    /// The height of the perspective's picture one metre in front of the eye.
    fn height_at_one(&self) -> f64 {
        2.0 * (self.fov_rad / 2.0).tan()
    }

    /// The view for a picture of this size in pixels.
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

    /// The size of a pixel at the target, metres.
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

    /// Turns around the target, given pixels in a picture of this height.
    pub(in crate::desktop) fn orbit(&mut self, pixels: DVec2, height: f64) {
        let turn = PI / height.max(1.0);
        self.azimuth_rad += pixels.x * turn;
        self.altitude_rad = (self.altitude_rad + pixels.y * turn).clamp(LOWEST_RAD, HIGHEST_RAD);
    }

    /// The direction from the target to the eye, clockwise from north, radians.
    pub(in crate::desktop) fn azimuth_rad(&self) -> f64 {
        self.azimuth_rad
    }

    /// The same eye in another direction from its target.
    pub(in crate::desktop) fn turned(self, azimuth_rad: f64, altitude_rad: f64) -> Eye {
        Eye { azimuth_rad, altitude_rad: altitude_rad.clamp(LOWEST_RAD, HIGHEST_RAD), ..self }
    }

    /// Looks at something of this size: it is in the middle, neither too small to be found nor larger than the picture.
    pub(in crate::desktop) fn look_at(&mut self, point: DVec3, size_m: f64) {
        let height = self.framed().height_m.clamp(size_m * 2.5, size_m * 10.0);
        self.frame(point, height);
    }

    /// Pans by pixels, so that the ground follows the pointer.
    pub(in crate::desktop) fn pan(&mut self, pixels: DVec2, height: u32) {
        let [right, up] = self.across();
        let ParallelView { target, height_m } = self.framed();
        self.frame(target + (up * pixels.y - right * pixels.x) * self.metres_a_pixel(height), height_m);
    }

    /// The point at the target's distance that is this many pixels right of and below the middle.
    pub(in crate::desktop) fn beside_target(&self, from_middle: DVec2, height: u32) -> DVec3 {
        let [right, up] = self.across();
        self.framed().target + (right * from_middle.x - up * from_middle.y) * self.metres_a_pixel(height)
    }

    /// Zooms by a factor, within limits of the distance, about a point, which keeps its place in the picture.
    pub(in crate::desktop) fn zoom(&mut self, factor: f64, about: DVec3, limits: [f64; 2]) {
        let ParallelView { target, height_m } = self.framed();
        let [least, most] = limits.map(|distance| distance * self.height_at_one());
        let height = (height_m / factor).clamp(least, most);
        self.frame(about + (target - about) * (height / height_m), height);
    }

    /// Shows a whole box in the window. A side stands on the ground, which is the box's lower end.
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
