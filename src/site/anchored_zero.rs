//! The point of the Earth at which a model's zero stands.

use crate::crs::{Crs, GeodeticPoint};
use glam::DVec3;

/// Where a model's zero stands, and which way it is turned; what is not said is none.
#[derive(Clone, Debug)]
pub(super) struct AnchoredZero {
    pub(super) at: Option<GeodeticPoint>,
    /// Whether the height of `at` is said.
    pub(super) has_height: bool,
    /// The point of a map that it is, where it is one.
    pub(super) on_map: Option<(Crs, DVec3)>,
    pub(super) north: Option<AnchoredNorth>,
}

/// Radians clockwise from the file's north.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum AnchoredNorth {
    /// The north of the anchor's map.
    Map(f64),
    /// True north.
    True(f64),
}

/// Radians clockwise from the file's north to true north, where an anchor says it.
pub(super) fn true_north(zero: &AnchoredZero) -> Option<f64> {
    match (zero.north?, &zero.on_map) {
        (AnchoredNorth::True(north), _) => Some(north),
        (AnchoredNorth::Map(north), Some((crs, at))) => Some(north - crs.convergence_rad(at.x, at.y)?),
        (AnchoredNorth::Map(_), None) => None,
    }
}
