//! A probe: a single point.

use glam::DVec3;

/// A point whose times in the sun are computed.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe {
    /// Its name.
    pub name: String,
    /// Its position, metres in the world frame.
    pub point: DVec3,
    /// The unit normal of the plane in which it lies, on the judged side. Without one, the point is free on all sides.
    pub normal: Option<DVec3>,
}
