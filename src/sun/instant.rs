//! An instant of a study: the direction to the sun, and the time for which it counts.

use super::Zone;
use chrono::DateTime;
use glam::DVec3;

/// One instant of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Instant {
    /// Local clock time of the place.
    pub time: DateTime<Zone>,
    /// Unit vector to the sun's centre in the world frame (with refraction, if that is on).
    pub to_sun: DVec3,
    /// Clockwise from true north, radians.
    pub azimuth_rad: f64,
    /// Above the horizon, radians.
    pub altitude_rad: f64,
    /// The seconds of the window that this instant represents.
    pub weight_secs: u32,
    /// The seconds since the previous instant, if the window and the daylight last throughout, so that times of change
    /// can be searched between the two; otherwise 0.
    pub gap_secs: u32,
    /// Whether the sun is below the horizon. The mask is then 0 everywhere, and the instant enters no sum.
    pub night: bool,
}

impl Instant {
    /// Clockwise from true north, degrees, rounded to 0.00001° for printing.
    pub fn azimuth_deg(&self) -> f64 {
        as_printed(self.azimuth_rad.to_degrees()) % 360.0
    }

    /// Above the horizon, degrees, rounded to 0.00001° for printing. Negative at night.
    pub fn altitude_deg(&self) -> f64 {
        as_printed(self.altitude_rad.to_degrees())
    }
}

/// Rounds: SPA is accurate to 0.0003°, so further digits mean nothing. Never returns −0.
fn as_printed(degrees: f64) -> f64 {
    (degrees * 1e5).round() / 1e5 + 0.0
}
