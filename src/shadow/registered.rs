//! Herf's registered projection: maps what is between a light and a flat receiver to the receiver's own cells.
//!
//! M. Herf, *Efficient Generation of Soft Shadow Textures*, CMU-CS-97-138, 1997, section 3.2: the pyramid from a
//! light's sample to a parallelogram is mapped to a box, with the same cells for every sample, so that hard shadows of
//! many samples are aligned and can simply be added. Our deviations: one formula, with the homogeneous light, for a
//! lamp and for the sun, whose pyramid is an oblique prism; a height above the receiver instead of the paper's third
//! row, since faces are cut at a height; and cells instead of the unit square, with centres at whole numbers.
//!
//! A point v at the height h above the plane, seen from the light (l, w_l) whose own distance to the plane is f, is
//! projected to p with p·w = v − (h/f)·l and w = 1 − w_l·h/f, all of which is linear in v.

use super::ray_cast::TIE;
use crate::mesh::scan::Coverage;
use glam::{DVec2, DVec3, DVec4};

/// A flat receiver's raster, relative to any origin.
#[derive(Clone, Copy, Debug)]
pub struct Raster {
    /// The corner where its first cell begins. Its height above the plane does not matter.
    pub corner: DVec3,
    /// A unit vector along rows.
    pub right: DVec3,
    /// A unit vector down columns.
    pub down: DVec3,
    /// A cell's side, metres.
    pub cell: f64,
    /// The judged plane: its unit normal towards the judged side, and minus its height along that.
    pub plane: DVec4,
}

/// The projection onto a raster, for one light.
#[derive(Clone, Copy, Debug)]
pub struct RasterProjection {
    /// The homogeneous column of a vertex (v, 1), with centres at whole numbers.
    pub column: DVec4,
    /// Homogeneous row.
    pub row: DVec4,
    /// The divisor of both: 1 for the sun; for a lamp 1 in the plane, and 0 at the lamp's height.
    pub w: DVec4,
    /// The height above the plane, metres.
    pub height: DVec4,
}

/// A vertex seen from the light.
#[derive(Clone, Copy, Debug)]
pub struct ProjectedVertex {
    /// The homogeneous column and row, and their divisor.
    pub at: DVec3,
    /// Its height above the judged plane, metres.
    pub height: f64,
}

/// The least w at which faces are cut below a lamp: what is higher is projected too far away.
pub const LEAST_W: f64 = 1e-6;

impl RasterProjection {
    /// The projection for a homogeneous light (sun: w = 0, lamp: w = 1) relative to the raster's origin; `None` if the
    /// light is not in front of the plane.
    pub fn new(raster: &Raster, light: DVec4) -> Option<RasterProjection> {
        let front = raster.plane.dot(light);
        if front.partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater) {
            return None;
        }
        let height = raster.plane;
        let w = DVec4::W - height * (light.w / front);
        // as in ray casting: what is right of an edge through a centre counts, then what is below it
        let along = |axis: DVec3, tie: f64| {
            let fallen = axis.extend(0.0) - height * (axis.dot(light.truncate()) / front);
            (fallen - w * axis.dot(raster.corner)) / raster.cell - w * (0.5 + tie)
        };
        Some(RasterProjection { column: along(raster.right, TIE.x), row: along(raster.down, -TIE.y), w, height })
    }

    /// Projects a vertex.
    pub fn place(&self, vertex: DVec3) -> ProjectedVertex {
        let vertex = vertex.extend(1.0);
        ProjectedVertex {
            at: DVec3::new(self.column.dot(vertex), self.row.dot(vertex), self.w.dot(vertex)),
            height: self.height.dot(vertex),
        }
    }
}

/// The part of a face between the plane and the light: a convex polygon in cells.
#[derive(Clone, Copy, Debug, Default)]
pub struct ClippedFace {
    points: [DVec2; 5],
    count: usize,
}

impl ClippedFace {
    /// Its corners, in the face's order.
    pub fn points(&self) -> &[DVec2] {
        &self.points[..self.count]
    }

    /// Covers the cells whose centres lie in it or on its edge.
    pub(crate) fn cover(&self, bits: &mut Coverage) {
        for pair in self.points().windows(2).skip(1) {
            bits.cover([self.points[0], pair[0], pair[1]]);
        }
    }
}

/// Whether a face is wholly between the plane and the light.
pub fn is_whole(face: &[ProjectedVertex; 3]) -> bool {
    face.iter().all(|place| place.height > 0.0 && place.at.z > LEAST_W)
}

/// Cuts a face at the judged plane, and below a lamp. Two faces cut a shared edge at the same point.
pub fn part(face: [ProjectedVertex; 3]) -> ClippedFace {
    let mut part = ClippedFace::default();
    if is_whole(&face) {
        part.points[..3].copy_from_slice(&face.map(flat));
        part.count = 3;
        return part;
    }
    let (mut above, mut count) = ([face[0]; 4], 0);
    for at in 0..3 {
        let (from, to) = (face[at], face[(at + 1) % 3]);
        if from.height > 0.0 {
            above[count] = from;
            count += 1;
        }
        if (from.height > 0.0) != (to.height > 0.0) {
            above[count] = cut(from, to, |place| place.height);
            count += 1;
        }
    }
    let before_lamp = |place: &ProjectedVertex| place.at.z - LEAST_W;
    for at in 0..count {
        let (from, to) = (above[at], above[(at + 1) % count]);
        if before_lamp(&from) > 0.0 {
            part.points[part.count] = flat(from);
            part.count += 1;
        }
        if (before_lamp(&from) > 0.0) != (before_lamp(&to) > 0.0) {
            part.points[part.count] = flat(cut(from, to, |place| before_lamp(&place)));
            part.count += 1;
        }
    }
    part
}

fn flat(place: ProjectedVertex) -> DVec2 {
    place.at.truncate() / place.at.z
}

/// The zero of `height` on the line between two vertices. The result does not depend on their order.
fn cut(one: ProjectedVertex, other: ProjectedVertex, height: impl Fn(ProjectedVertex) -> f64) -> ProjectedVertex {
    let (low, high) = if height(one) < height(other) { (one, other) } else { (other, one) };
    // homogeneous positions are linear, also below the plane
    let along = -height(low) / (height(high) - height(low));
    ProjectedVertex { at: low.at + (high.at - low.at) * along, height: low.height + (high.height - low.height) * along }
}
