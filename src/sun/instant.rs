//! One instant: where the sun stands at it, and for how much of a study it counts.

use super::Zone;
use chrono::DateTime;
use glam::DVec3;

/// One instant of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Instant {
    /// Local clock time of the place.
    pub time: DateTime<Zone>,
    /// Unit vector to the sun's centre in the world frame (refraction included where it is on).
    pub to_sun: DVec3,
    /// Clockwise from true north, radians.
    pub azimuth_rad: f64,
    /// Above the horizon, radians.
    pub altitude_rad: f64,
    /// How many seconds of the window this instant stands for.
    pub weight_secs: u32,
    /// Seconds since the instant before, where the window and the sun's light last all that time, so that between the two
    /// there is something to search; else 0.
    pub gap_secs: u32,
    /// Whether the sun is below the horizon: the mask is 0 everywhere and the instant enters no sum.
    pub night: bool,
}

impl Instant {
    /// Clockwise from true north, degrees, as it is printed: to 0.00001°.
    pub fn azimuth_deg(&self) -> f64 {
        as_printed(self.azimuth_rad.to_degrees()) % 360.0
    }

    /// Above the horizon, degrees, as it is printed: to 0.00001°. Below 0 is night.
    pub fn altitude_deg(&self) -> f64 {
        as_printed(self.altitude_rad.to_degrees())
    }
}

/// SPA is good to 0.0003°; more digits than these say nothing. Never −0.
fn as_printed(degrees: f64) -> f64 {
    (degrees * 1e5).round() / 1e5 + 0.0
}
