//! Latitude or longitude.

use std::fmt;

/// The two angles of a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Latitude, north positive.
    Latitude,
    /// Longitude, east positive.
    Longitude,
}

impl Axis {
    /// The greatest value, degrees; the least is its negative.
    pub fn most(self) -> f64 {
        match self {
            Axis::Latitude => 90.0,
            Axis::Longitude => 180.0,
        }
    }

    pub(super) fn example(self) -> &'static str {
        match self {
            Axis::Latitude => "48.2082, 48,2082 or 48°12'30\" N",
            Axis::Longitude => "16.3738, 16,3738 or 16°22'26\" E",
        }
    }
}

impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if *self == Axis::Latitude { "latitude" } else { "longitude" })
    }
}
