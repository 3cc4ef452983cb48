//! The faces that can take the sun from a point inside a wall: those that reach in front of it.

use glam::{DVec3, Vec3};

/// What lies in front of a plane.
#[derive(Clone, Copy, Debug)]
pub struct WallFront {
    /// The unit normal, away from the room.
    pub normal: DVec3,
    /// The plane's distance from the origin along the normal, metres. What lies in the plane is not in front of it.
    pub along_m: f64,
}

impl WallFront {
    /// The same, relative to a mesh's origin.
    pub(super) fn relative_to(self, origin: DVec3) -> WallFront {
        WallFront { along_m: self.along_m - self.normal.dot(origin), ..self }
    }

    /// Whether a face reaches in front of the plane.
    pub(super) fn has(&self, corners: &[Vec3; 3]) -> bool {
        corners.iter().any(|corner| self.normal.dot(corner.as_dvec3()) > self.along_m)
    }

    /// Whether a box may reach in front of it.
    pub(super) fn may_have(&self, middle: DVec3, half: DVec3) -> bool {
        // more than the rounding errors add up to
        let near = 1e-9 * (middle.abs().max_element() + half.max_element());
        self.normal.dot(middle) + self.normal.abs().dot(half) > self.along_m - near
    }
}
