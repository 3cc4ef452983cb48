//! A probe: a single point.

use glam::DVec3;

/// A point for which is computed when it lies in the sun.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe {
    /// What people call it.
    pub name: String,
    /// Metres in the world frame.
    pub point: DVec3,
    /// The unit normal of the plane in which it lies, on the side that is judged; a point without one is free.
    pub normal: Option<DVec3>,
}
