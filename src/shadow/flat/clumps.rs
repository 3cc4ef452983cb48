//! Culls what cannot reach a raster under a sun: the casters' faces are in clumps with a box each, and the clumps in
//! blocks.
//!
//! A clump whose box is projected outside of the judged cells is skipped before anything of it is projected. That
//! changes no bit: outside of its own shadow a face adds to the sum what it subtracts again.

use crate::mesh::Mesh;
use glam::{DVec2, DVec3, Vec3Swizzles};
use rayon::prelude::*;
use std::ops::Range;

/// The most faces of a clump.
const FACES: usize = 256;
/// The number of clumps in a block.
const CLUMPS: usize = 64;

/// Consecutive faces of one component, and the groups that begin in them.
pub(in crate::shadow) struct Clump {
    pub(in crate::shadow) faces: Range<u32>,
    pub(super) groups: Range<u32>,
    pub(super) bounds: RasterBounds,
}

/// A box in columns, rows and heights.
#[derive(Clone, Copy)]
pub(in crate::shadow) struct RasterBounds {
    pub(in crate::shadow) low: DVec3,
    pub(in crate::shadow) high: DVec3,
}

impl RasterBounds {
    pub(in crate::shadow) const NONE: RasterBounds = RasterBounds { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };

    pub(in crate::shadow) fn with(self, point: DVec3) -> RasterBounds {
        RasterBounds { low: self.low.min(point), high: self.high.max(point) }
    }

    pub(in crate::shadow) fn joined(self, other: RasterBounds) -> RasterBounds {
        RasterBounds { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    fn middle(&self) -> DVec2 {
        (self.low.xy() + self.high.xy()) / 2.0
    }
}

/// All clumps, in spatial order.
pub(in crate::shadow) struct Clumps {
    list: Vec<Clump>,
    /// A box around each block of [`CLUMPS`].
    blocks: Vec<RasterBounds>,
    /// Whether to cull; otherwise, all clumps count as reaching.
    pub(super) culling: bool,
}

impl Clumps {
    /// The clumps of a mesh whose vertices are at `points`. Groups are numbered in the order of their first faces.
    pub(super) fn of(mesh: &Mesh, points: &[DVec3], group_of: &[u32]) -> Clumps {
        let runs = mesh.components.iter().flat_map(|component| {
            let Range { start, end } = component.faces;
            (start..end).step_by(FACES).map(move |first| first..(first + FACES as u32).min(end))
        });
        let mut groups = 0;
        let mut list: Vec<Clump> = runs
            .map(|faces| {
                let first = groups;
                for &group in &group_of[faces.start as usize..faces.end as usize] {
                    groups = groups.max(group + 1);
                }
                Clump { faces, groups: first..groups, bounds: RasterBounds::NONE }
            })
            .collect();
        bound(&mut list, mesh, points, group_of);
        let all = list.iter().map(|clump| clump.bounds).fold(RasterBounds::NONE, RasterBounds::joined);
        list.par_sort_by_cached_key(|clump| place_code(clump.bounds.middle(), &all));
        let blocks = list.chunks(CLUMPS);
        let blocks =
            blocks.map(|clumps| clumps.iter().map(|clump| clump.bounds).fold(RasterBounds::NONE, RasterBounds::joined));
        Clumps { blocks: blocks.collect(), list, culling: true }
    }

    pub(in crate::shadow) fn list(&self) -> &[Clump] {
        &self.list
    }

    /// Adds the clumps that may reach the judged cells, in order.
    pub(in crate::shadow) fn reach(&self, judged: &JudgedCells, found: &mut Vec<u32>) {
        found.clear();
        if !self.culling {
            found.extend(0..self.list.len() as u32);
            return;
        }
        for (block, (bounds, clumps)) in self.blocks.iter().zip(self.list.chunks(CLUMPS)).enumerate() {
            if judged.is_reached_by(bounds) {
                let numbers = (block * CLUMPS) as u32..;
                let reach = numbers.zip(clumps).filter(|(_, clump)| judged.is_reached_by(&clump.bounds));
                found.extend(reach.map(|(number, _)| number));
            }
        }
    }
}

/// Sets the boxes of clumps, around their own faces and those of their groups in later clumps.
fn bound(list: &mut [Clump], mesh: &Mesh, points: &[DVec3], group_of: &[u32]) {
    let of_clump = |clump: &Clump| {
        let (mut own, mut others) = (RasterBounds::NONE, Vec::new());
        for face in clump.faces.clone() {
            let of_face = mesh.faces[face as usize].map(|vertex| points[vertex as usize]);
            let of_face = of_face.into_iter().fold(RasterBounds::NONE, RasterBounds::with);
            own = own.joined(of_face);
            let group = group_of[face as usize];
            if group < clump.groups.start {
                others.push((group, of_face));
            }
        }
        (own, others)
    };
    let found: Vec<(RasterBounds, Vec<(u32, RasterBounds)>)> =
        list.par_iter().with_min_len(CLUMPS).map(of_clump).collect();
    for (clump, (own, _)) in list.iter_mut().zip(&found) {
        clump.bounds = *own;
    }
    for (group, bounds) in found.into_iter().flat_map(|(_, others)| others) {
        let clump = list.partition_point(|clump| clump.groups.end <= group);
        list[clump].bounds = list[clump].bounds.joined(bounds);
    }
}

/// The Morton code of a place (G. Morton, 1966): near places have near codes.
fn place_code(place: DVec2, all: &RasterBounds) -> u32 {
    let spread = |at: f64| {
        let bits = (at * 65535.0) as u32;
        (0..16).fold(0, |code, bit| code | (bits >> bit & 1) << (2 * bit))
    };
    let along = (place - all.low.xy()) / (all.high.xy() - all.low.xy()).max(DVec2::splat(1e-9));
    spread(along.x) | spread(along.y) << 1
}

/// The judged cells, and the direction in which shadows fall on them.
pub(in crate::shadow) struct JudgedCells {
    at: RasterBounds,
    throw: DVec2,
    /// A unit vector perpendicular to the shadows, and the extent of the judged cells along it.
    across: DVec2,
    reach: [f64; 2],
}

impl JudgedCells {
    /// The judged cells within a box. `throw` is the shadow's columns and rows per metre of height.
    pub(in crate::shadow) fn new(at: RasterBounds, throw: DVec2) -> JudgedCells {
        // a margin far above rounding
        let at = RasterBounds { low: at.low - DVec3::new(1.0, 1.0, 0.0), high: at.high + DVec3::new(1.0, 1.0, 0.0) };
        let across = throw.perp().try_normalize().unwrap_or(DVec2::X);
        JudgedCells { at, throw, across, reach: along(across, &at) }
    }

    /// The distance of a box's middle from the judged cells towards the sun; at most 0 beside them.
    pub(super) fn distance(&self, bounds: &RasterBounds) -> f64 {
        let to_sun = self.throw.normalize_or_zero();
        let [_, nearest] = along(to_sun, &self.at);
        to_sun.dot(bounds.middle()) - nearest
    }

    /// Whether anything in a box could shade the judged cells.
    fn is_reached_by(&self, bounds: &RasterBounds) -> bool {
        let JudgedCells { at, throw, across, reach } = self;
        // the range of heights above what it shades
        let (least, most) = ((bounds.low.z - at.high.z).max(0.0), bounds.high.z - at.low.z);
        if most <= 0.0 {
            return false;
        }
        let falls = [*throw * least, *throw * most];
        let low = bounds.low.xy() - falls[0].max(falls[1]);
        let high = bounds.high.xy() - falls[0].min(falls[1]);
        // far away the rounding is coarser
        let slack = 1e-9 * low.abs().max(high.abs()).max_element();
        let [first, last] = along(*across, bounds);
        let is_beside = (high + slack).cmplt(at.low.xy()).any() || (low - slack).cmpgt(at.high.xy()).any();
        !(is_beside || last + slack < reach[0] || first - slack > reach[1])
    }
}

/// The extent of a box along a vector.
fn along(vector: DVec2, bounds: &RasterBounds) -> [f64; 2] {
    let middle = vector.dot(bounds.middle());
    let half = vector.abs().dot(bounds.high.xy() - bounds.low.xy()) / 2.0;
    [middle - half, middle + half]
}
