//! The sky laid flat: where a direction lies in a picture of it, and which direction a place of the picture has.

use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, TAU};

/// How the sky is laid flat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SkyProjection {
    /// A disc, as a plan has it: the zenith in the middle, the horizon around it, north up and east at the right. A
    /// direction of altitude h lies tan(45° − h/2) of the radius from the middle, and circles on the sky stay circles.
    Stereographic,
    /// Azimuth across and altitude up, degrees of the same length.
    Cylindrical {
        /// The azimuth in the middle, clockwise from north, radians.
        middle_rad: f64,
    },
}

/// A picture of the sky above the horizon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkyPicture {
    /// How the sky is laid flat.
    pub projection: SkyProjection,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

/// How far beyond the horizon a disc has directions still, a share of its radius: those of the horizon, so that what
/// stands there reaches the rim whole.
const BEYOND: f64 = 1.02;

impl SkyPicture {
    /// A disc that fills a square.
    pub fn stereographic(side: u32) -> SkyPicture {
        SkyPicture { projection: SkyProjection::Stereographic, width: side, height: side }
    }

    /// All azimuths, with that one in the middle: a quarter as high as wide.
    pub fn cylindrical(width: u32, middle_rad: f64) -> SkyPicture {
        SkyPicture { projection: SkyProjection::Cylindrical { middle_rad }, width, height: (width / 4).max(1) }
    }

    /// Where a direction (of length 1) lies: columns and rows from the north-west corner. Below the horizon it lies
    /// outside of the picture.
    pub fn place(&self, to: DVec3) -> DVec2 {
        let size = self.size();
        match self.projection {
            SkyProjection::Stereographic => {
                // cos h / (1 + sin h) = tan(45° − h/2); the nadir is infinitely far away
                let flat = to.truncate() / (1.0 + to.z).max(1e-9);
                size / 2.0 + DVec2::new(flat.x, -flat.y) * size / 2.0
            }
            SkyProjection::Cylindrical { middle_rad } => {
                let across = ((to.x.atan2(to.y) - middle_rad) / TAU + 0.5).rem_euclid(1.0);
                let up = to.z.clamp(-1.0, 1.0).asin() / FRAC_PI_2;
                DVec2::new(across, 1.0 - up) * size
            }
        }
    }

    /// The direction of a place; none outside of a disc.
    pub fn direction(&self, at: DVec2) -> Option<DVec3> {
        let size = self.size();
        match self.projection {
            SkyProjection::Stereographic => {
                let flat = (at / size * 2.0 - 1.0) * DVec2::new(1.0, -1.0);
                let square = flat.length_squared();
                if square > BEYOND * BEYOND {
                    return None;
                }
                if square > 1.0 {
                    return Some(flat.normalize().extend(0.0));
                }
                Some((2.0 * flat).extend(1.0 - square) / (1.0 + square))
            }
            SkyProjection::Cylindrical { middle_rad } => {
                let part = at / size;
                let (sin_azimuth, cos_azimuth) = ((part.x - 0.5) * TAU + middle_rad).sin_cos();
                let (sin_altitude, cos_altitude) = ((1.0 - part.y).clamp(0.0, 1.0) * FRAC_PI_2).sin_cos();
                Some(DVec3::new(sin_azimuth * cos_altitude, cos_azimuth * cos_altitude, sin_altitude))
            }
        }
    }

    fn size(&self) -> DVec2 {
        DVec2::new(f64::from(self.width.max(1)), f64::from(self.height.max(1)))
    }
}
