//! The point of the Earth where a model's origin lies.

use crate::crs::{Crs, GeodeticPoint};
use glam::DVec3;

/// Where a model's origin lies and how the model is turned. What the anchors do not say is `None`.
#[derive(Clone, Debug)]
pub(super) struct AnchoredZero {
    pub(super) at: Option<GeodeticPoint>,
    /// Whether the height of `at` is given.
    pub(super) has_height: bool,
    /// The map and the coordinates in it, if the anchor uses a map.
    pub(super) on_map: Option<(Crs, DVec3)>,
    pub(super) north: Option<AnchoredNorth>,
}

/// The angle to a north, in radians clockwise from the file's own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum AnchoredNorth {
    /// The north of the anchor's map.
    Map(f64),
    /// True north.
    True(f64),
}

/// Radians clockwise from the file's north to true north, if an anchor gives them.
pub(super) fn true_north(zero: &AnchoredZero) -> Option<f64> {
    match (zero.north?, &zero.on_map) {
        (AnchoredNorth::True(north), _) => Some(north),
        (AnchoredNorth::Map(north), Some((crs, at))) => Some(north - crs.convergence_rad(at.x, at.y)?),
        (AnchoredNorth::Map(_), None) => None,
    }
}
