//! What can reach a raster under a sun: the casters' faces in clumps with a box around each, and the clumps in blocks.
//!
//! A clump whose box falls beside what is judged is left out before anything of it is projected. That changes no bit:
//! beside its own shadow a face adds to the sum what it takes away again.

use crate::mesh::Mesh;
use glam::{DVec2, DVec3, Vec3Swizzles};
use rayon::prelude::*;
use std::ops::Range;

/// Faces of a clump at the most.
const FACES: usize = 256;
/// Clumps of a block.
const CLUMPS: usize = 64;

/// Some faces of one component that follow each other, and the groups that begin in them.
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

/// All clumps, neighbours beside each other.
pub(in crate::shadow) struct Clumps {
    list: Vec<Clump>,
    /// Around each run of [`CLUMPS`].
    blocks: Vec<RasterBounds>,
    /// Without it all clumps count as reaching what is judged.
    pub(super) culling: bool,
}

impl Clumps {
    /// For a mesh whose vertices are at `points`; groups are numbered in the order of their first faces.
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

    /// The clumps that may reach what is judged, in order.
    pub(in crate::shadow) fn reach(&self, judged: &Judged, found: &mut Vec<u32>) {
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

/// Puts boxes around clumps: around their own faces, and around those of their groups that lie in later clumps.
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

/// A number that is near for near places: the bits of column and row by turns (G. Morton, 1966).
fn place_code(place: DVec2, all: &RasterBounds) -> u32 {
    let spread = |at: f64| {
        let bits = (at * 65535.0) as u32;
        (0..16).fold(0, |code, bit| code | (bits >> bit & 1) << (2 * bit))
    };
    let along = (place - all.low.xy()) / (all.high.xy() - all.low.xy()).max(DVec2::splat(1e-9));
    spread(along.x) | spread(along.y) << 1
}

/// What is judged, and how shadows fall on it.
pub(in crate::shadow) struct Judged {
    at: RasterBounds,
    throw: DVec2,
    /// A unit vector across the shadows, and from where to where what is judged reaches along it.
    across: DVec2,
    reach: [f64; 2],
}

impl Judged {
    /// What is judged within a box, on which shadows fall so many columns and rows a metre of height.
    pub(in crate::shadow) fn new(at: RasterBounds, throw: DVec2) -> Judged {
        // rounding is far below a cell
        let at = RasterBounds { low: at.low - DVec3::new(1.0, 1.0, 0.0), high: at.high + DVec3::new(1.0, 1.0, 0.0) };
        let across = throw.perp().try_normalize().unwrap_or(DVec2::X);
        Judged { at, throw, across, reach: along(across, &at) }
    }

    /// How far before what is judged the middle of a box stands, towards the sun; not above 0 beside it.
    pub(super) fn distance(&self, bounds: &RasterBounds) -> f64 {
        let to_sun = self.throw.normalize_or_zero();
        let [_, nearest] = along(to_sun, &self.at);
        to_sun.dot(bounds.middle()) - nearest
    }

    /// False where nothing in a box can shade what is judged.
    fn is_reached_by(&self, bounds: &RasterBounds) -> bool {
        let Judged { at, throw, across, reach } = self;
        // so much higher it stands than what it shades
        let (least, most) = ((bounds.low.z - at.high.z).max(0.0), bounds.high.z - at.low.z);
        if most <= 0.0 {
            return false;
        }
        let falls = [*throw * least, *throw * most];
        let low = bounds.low.xy() - falls[0].max(falls[1]);
        let high = bounds.high.xy() - falls[0].min(falls[1]);
        // far away places are coarser
        let slack = 1e-9 * low.abs().max(high.abs()).max_element();
        let [first, last] = along(*across, bounds);
        let is_beside = (high + slack).cmplt(at.low.xy()).any() || (low - slack).cmpgt(at.high.xy()).any();
        !(is_beside || last + slack < reach[0] || first - slack > reach[1])
    }
}

/// From where to where a box reaches along a vector.
fn along(vector: DVec2, bounds: &RasterBounds) -> [f64; 2] {
    let middle = vector.dot(bounds.middle());
    let half = vector.abs().dot(bounds.high.xy() - bounds.low.xy()) / 2.0;
    [middle - half, middle + half]
}
