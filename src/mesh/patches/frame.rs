//! The frame of a patch: the direction of its rows.
//!
//! Rows are horizontal, so that a wall is upright in its texture; seen from the judged side, right in the texture is
//! right. The exceptions are level patches, and patches that need less than half the texels along their longest border
//! (such as a leaning strut): their rows follow that border. Of its two directions, the one closer to horizontal rows,
//! or to the east, is used.

use super::gather::FlatPatch;
use super::patch::LEVEL;
use crate::mesh::Mesh;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use rustc_hash::FxHashMap;

/// A patch's axes, and its extent along them.
pub(super) struct PatchFrame {
    pub(super) right: DVec3,
    pub(super) down: DVec3,
    /// A point in the patch's plane, relative to the mesh's origin.
    anchor: DVec3,
    /// The minimum along right and down, metres from the anchor.
    low: DVec2,
    high: DVec2,
}

/// More texels than this along a side mean that the cell is too small.
const MOST_COUNTED: f64 = 1e9;

impl PatchFrame {
    fn along(mesh: &Mesh, flat: &FlatPatch, right: DVec3) -> PatchFrame {
        let down = right.cross(flat.plane.truncate());
        let anchor = flat.plane.truncate() * -flat.plane.w;
        let places = || {
            let corners = flat.faces.iter().flat_map(|&face| mesh.corners(face as usize));
            corners.map(|corner| corner.as_dvec3() - anchor).map(|from| DVec2::new(from.dot(right), from.dot(down)))
        };
        let low = places().fold(DVec2::INFINITY, DVec2::min);
        let high = places().fold(DVec2::NEG_INFINITY, DVec2::max);
        PatchFrame { right, down, anchor, low, high }
    }

    /// The number of columns and rows of this size in metres.
    pub(super) fn texels(&self, cell: f64) -> [u32; 2] {
        // a rounding error must not add a column or row to a wall of whole cells
        let count = |length: f64| (length / cell - 1e-4).ceil().clamp(1.0, MOST_COUNTED) as u32;
        [count(self.high.x - self.low.x), count(self.high.y - self.low.y)]
    }

    /// The corner where the first texel begins. The excess of whole texels over the patch's extent is equal on both
    /// sides.
    pub(super) fn corner(&self, cell: f64) -> DVec3 {
        let [width, height] = self.texels(cell).map(|count| f64::from(count) * cell);
        let corner = (self.low + self.high - DVec2::new(width, height)) / 2.0;
        self.anchor + self.right * corner.x + self.down * corner.y
    }

    fn cost(&self, cell: f64) -> f64 {
        let [width, height] = self.texels(cell);
        f64::from(width) * f64::from(height)
    }
}

/// The frames of all patches, for texels of approximately this size in metres.
pub(super) fn of_all(mesh: &Mesh, flats: &[FlatPatch], cell: f64) -> Vec<PatchFrame> {
    flats.par_iter().map(|flat| of(mesh, flat, cell)).collect()
}

fn of(mesh: &Mesh, flat: &FlatPatch, cell: f64) -> PatchFrame {
    let normal = flat.plane.truncate();
    let level = DVec3::Z.cross(normal);
    let is_level = level.length() < LEVEL;
    let meant = if is_level { DVec3::X } else { level.normalize() };
    let frame = (!is_level).then(|| PatchFrame::along(mesh, flat, meant));
    let along = longest_border(mesh, flat);
    let along = (along - normal * along.dot(normal)).try_normalize().unwrap_or_else(|| normal.any_orthonormal_vector());
    let aside = normal.cross(along);
    let [mut right, mut best] = [along; 2];
    for way in [along, -along, aside, -aside] {
        if way.dot(meant) > best.dot(meant) {
            [right, best] = [way; 2];
        }
    }
    let turned = PatchFrame::along(mesh, flat, right);
    match frame {
        Some(frame) if frame.cost(cell) <= 2.0 * turned.cost(cell) => frame,
        _ => turned,
    }
}

/// The longest border edge of the patch.
fn longest_border(mesh: &Mesh, flat: &FlatPatch) -> DVec3 {
    let mut count: FxHashMap<[u32; 2], u32> = FxHashMap::default();
    for &face in &flat.faces {
        let [a, b, c] = mesh.faces[face as usize];
        for [from, to] in [[a, b], [b, c], [c, a]] {
            *count.entry([from.min(to), from.max(to)]).or_default() += 1;
        }
    }
    let borders = count.into_iter().filter(|(_, faces)| *faces == 1);
    let long = |[from, to]: [u32; 2]| (mesh.vertices[to as usize] - mesh.vertices[from as usize]).as_dvec3();
    let longest = borders
        .map(|(edge, _)| (long(edge).length(), edge))
        .max_by(|one, other| one.0.total_cmp(&other.0).then(other.1.cmp(&one.1)));
    longest.map_or(DVec3::ZERO, |(_, edge)| long(edge))
}
