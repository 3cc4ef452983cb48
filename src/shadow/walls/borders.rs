//! Culls walls that the view cannot show.
//!
//! *Geometry of Real Time Shadows*, section 9, saves fill rate by bounds around casters. Here walls are culled one by
//! one, which saves at least as much, needs no bounds, and cannot change a mask: what is beyond a border is clipped
//! anyway. A wall that ends at the lowest receiver fills nothing that a scissor around its caster's shadow would save.

use crate::silhouette::DirectedEdge;
use glam::{DMat4, DVec3, DVec4, Vec3};

/// The borders of a view, and where walls end.
#[derive(Clone, Copy, Debug)]
pub struct Borders {
    /// The transform from metres around the mesh's origin to clip space, with depth 1 near and 0 far.
    pub clip_from_local: DMat4,
    /// The height at which walls end, metres above the origin; `None` if they end at infinity.
    pub lowest_z: Option<f64>,
    /// The unit vector to the sun.
    pub to_sun: DVec3,
}

/// The distance beyond a border at which a wall is culled, as a share of half the picture: far above the adapter's
/// rounding.
const MARGIN: f64 = 0.01;

impl Borders {
    /// Whether a wall is wholly beyond one of the borders.
    pub fn hide(&self, vertices: &[Vec3], wall: DirectedEdge) -> bool {
        let [from, to] = wall.map(|vertex| vertices[vertex as usize].as_dvec3());
        let beyond_from = self.beyond(from);
        beyond_from != 0 && beyond_from & self.beyond(to) != 0
    }

    /// One bit per border: whether a vertex and the end of its wall are both beyond it.
    fn beyond(&self, vertex: DVec3) -> u8 {
        let here = vertex.extend(1.0);
        // as in shaders/stencil.wgsl
        let end = match self.lowest_z {
            None => (-self.to_sun).extend(0.0),
            Some(lowest) if vertex.z <= lowest => here,
            Some(lowest) => (vertex * self.to_sun.z - self.to_sun * (vertex.z - lowest)).extend(self.to_sun.z),
        };
        beyond(self.clip_from_local * here) & beyond(self.clip_from_local * end)
    }
}

/// West, east, south, north, near: one bit each. A half-space in clip space is valid for points with any w.
fn beyond(clip: DVec4) -> u8 {
    let inside = [clip.w + clip.x, clip.w - clip.x, clip.w + clip.y, clip.w - clip.y, clip.w - clip.z];
    let margin = MARGIN * clip.w.abs();
    inside.iter().rev().fold(0, |bits, inside| bits << 1 | u8::from(inside + margin < 0.0))
}
