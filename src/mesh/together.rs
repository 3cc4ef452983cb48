//! Finds what stands together. Drawings contain leftovers, often a thousand kilometres from the model, which must not
//! reduce the precision of the model.
//!
//! Corners stand together if they lie in neighbouring cells of a grid. There are two grids. In the fine one, groups
//! that are a cell or more apart are welded separately. In the coarse one, whatever lies two cells, 20 km, or more from
//! everything else has another sun, and does not belong to the study.

use super::Part;
use super::adjacency::lowest;
use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;

/// A cell of the grid for welding, metres: a millionth of it is far below any detail.
const WELD_CELL_M: f64 = 250.0;
/// A cell of the grid that separates strays from what stands at home, metres.
const HOME_CELL_M: f64 = 10_000.0;
/// Models closer to the place than this are probably those of the study, metres.
const NEAR_M: f64 = 20_000.0;
/// The weight of a triangle near the place in the choice of the group at home.
const NEAR_COUNTS: u64 = 1000;

/// The corners of all parts, in groups that stand together.
pub(super) struct CornerGroups {
    /// The groups that are welded separately; `None` if there is only one.
    welded: Option<Clusters>,
    /// The group at home: the one with the most triangles, especially near the place.
    home: CornerGroup,
}

/// A group of corners: its box, and their number.
#[derive(Clone, Copy, Debug)]
pub(super) struct CornerGroup {
    pub(super) low: DVec3,
    pub(super) high: DVec3,
    pub(super) corners: usize,
    triangles: u64,
}

impl CornerGroup {
    const NONE: CornerGroup = CornerGroup { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY, corners: 0, triangles: 0 };

    fn add(&mut self, corner: DVec3) {
        *self =
            CornerGroup { low: self.low.min(corner), high: self.high.max(corner), corners: self.corners + 1, ..*self };
    }

    /// The diagonal of its box, metres.
    pub(super) fn size(&self) -> f64 {
        if self.low.x <= self.high.x { (self.high - self.low).length() } else { 0.0 }
    }

    /// The largest coordinate, metres.
    pub(super) fn reach(&self) -> f64 {
        self.low.abs().max(self.high.abs()).max_element()
    }

    /// Its horizontal distance from the place.
    fn distance(&self) -> f64 {
        DVec3::ZERO.clamp(self.low, self.high).truncate().length()
    }

    fn weight(&self) -> u64 {
        self.triangles.saturating_mul(if self.distance() <= NEAR_M { NEAR_COUNTS } else { 1 })
    }
}

impl CornerGroups {
    pub(super) fn of(parts: &[Part]) -> CornerGroups {
        let points = parts.par_iter().flat_map(|part| part.positions.par_iter().map(|&corner| (corner, corner)));
        let both = |one: (DVec3, DVec3), other: (DVec3, DVec3)| (one.0.min(other.0), one.1.max(other.1));
        let (low, high) = points.reduce(|| (DVec3::INFINITY, DVec3::NEG_INFINITY), both);
        // all corners are in neighbouring cells
        let are_one = |cell_m: f64| (high - low).max_element() <= cell_m;
        let home = if are_one(HOME_CELL_M) { CornerGroup { low, high, ..CornerGroup::NONE } } else { home(parts) };
        let clusters = (!are_one(WELD_CELL_M)).then(|| Clusters::of(parts, WELD_CELL_M, false));
        CornerGroups { welded: clusters.filter(|clusters| !clusters.is_one()), home }
    }

    /// The box around what stands at home; `None` without corners.
    pub(super) fn home(&self) -> Option<(DVec3, DVec3)> {
        (self.home.low.x <= self.home.high.x).then_some((self.home.low, self.home.high))
    }

    /// Whether a corner is in that box.
    pub(super) fn is_home(&self, corner: DVec3) -> bool {
        corner.cmpge(self.home.low).all() && corner.cmple(self.home.high).all()
    }

    /// The groups of a part's corners that are welded separately; and the group of each corner, if there are several.
    pub(super) fn in_part(&self, part: &Part) -> (Vec<CornerGroup>, Option<Vec<u32>>) {
        let mut groups: Vec<CornerGroup> = Vec::new();
        let Some(clusters) = &self.welded else {
            let mut group = CornerGroup::NONE;
            part.positions.iter().for_each(|&corner| group.add(corner));
            groups.push(group);
            return (groups, None);
        };
        let mut numbers: FxHashMap<u32, u32> = FxHashMap::default();
        let mut of_corner = Vec::with_capacity(part.positions.len());
        for (group, &corner) in clusters.of_corners(part).zip(&part.positions) {
            let number = *numbers.entry(group).or_insert_with(|| {
                groups.push(CornerGroup::NONE);
                groups.len() as u32 - 1
            });
            groups[number as usize].add(corner);
            of_corner.push(number);
        }
        let are_several = groups.len() > 1;
        (groups, are_several.then_some(of_corner))
    }
}

/// Finds the group at home. A triangle may extend from it to a stray: a group's triangles are those with all corners in
/// it. Only if no group has any, triangles join what they touch.
fn home(parts: &[Part]) -> CornerGroup {
    let groups = |joined: bool| -> Vec<CornerGroup> {
        let clusters = Clusters::of(parts, HOME_CELL_M, joined);
        let mut groups: BTreeMap<u32, CornerGroup> = BTreeMap::new(); // in the file's order
        for part in parts {
            let of_corner: Vec<u32> = clusters.of_corners(part).collect();
            for triangle in &part.triangles {
                let [a, b, c] = triangle.map(|corner| of_corner[corner as usize]);
                if a == b && b == c {
                    let group = groups.entry(a).or_insert(CornerGroup::NONE);
                    triangle.iter().for_each(|&corner| group.add(part.positions[corner as usize]));
                    group.triangles += 1;
                }
            }
        }
        groups.into_values().collect()
    };
    let mut found = groups(false);
    if found.is_empty() {
        found = groups(true);
    }
    let better = |one: &CornerGroup, other: &CornerGroup| {
        one.weight().cmp(&other.weight()).then(other.distance().total_cmp(&one.distance())).is_gt()
    };
    found
        .into_iter()
        .reduce(|best, group| if better(&group, &best) { group } else { best })
        .unwrap_or(CornerGroup::NONE)
}

/// The group of each occupied cell of a grid: connected neighbouring cells.
struct Clusters {
    cell_m: f64,
    group_of: FxHashMap<[i64; 3], u32>,
}

impl Clusters {
    /// Optionally, triangles also join the cells of their corners.
    fn of(parts: &[Part], cell_m: f64, joined_by_triangles: bool) -> Clusters {
        // cells in order of appearance, and a union-find forest
        let mut cells: Vec<[i64; 3]> = Vec::new();
        let mut number: FxHashMap<[i64; 3], u32> = FxHashMap::default();
        let mut above: Vec<u32> = Vec::new();
        for part in parts {
            let of_corner: Vec<u32> = {
                let number_of = remembering(cell_m, |cell| {
                    *number.entry(cell).or_insert_with(|| {
                        cells.push(cell);
                        above.push(above.len() as u32);
                        above.len() as u32 - 1
                    })
                });
                let numbers = part.positions.iter().copied().map(number_of);
                // otherwise nobody asks for the corners' numbers
                if joined_by_triangles {
                    numbers.collect()
                } else {
                    numbers.map(drop).fold(Vec::new(), |none, ()| none)
                }
            };
            for triangle in part.triangles.iter().filter(|_| joined_by_triangles) {
                let [a, b, c] = triangle.map(|corner| of_corner[corner as usize]);
                join(&mut above, a, b);
                join(&mut above, b, c);
            }
        }
        for (at, &[x, y, z]) in cells.iter().enumerate() {
            let near = |of: i64| [of.saturating_sub(1), of, of.saturating_add(1)];
            for (x, y) in near(x).into_iter().flat_map(|x| near(y).map(|y| (x, y))) {
                for z in near(z) {
                    if let Some(&other) = number.get(&[x, y, z]) {
                        join(&mut above, at as u32, other);
                    }
                }
            }
        }
        let group_of = number.into_iter().map(|(cell, number)| (cell, lowest(&mut above, number))).collect();
        Clusters { cell_m, group_of }
    }

    fn is_one(&self) -> bool {
        let mut groups = self.group_of.values();
        let first = groups.next();
        groups.all(|group| Some(group) == first)
    }

    /// The group of each of a part's corners.
    fn of_corners<'a>(&'a self, part: &'a Part) -> impl Iterator<Item = u32> + 'a {
        part.positions.iter().copied().map(remembering(self.cell_m, |cell| self.group_of[&cell]))
    }
}

/// Finds something for the cell of a corner, and caches the last answer: a corner is usually in the cell of the one
/// before it.
fn remembering(cell_m: f64, mut find: impl FnMut([i64; 3]) -> u32) -> impl FnMut(DVec3) -> u32 {
    let mut last = None;
    move |corner| {
        let place = corner / cell_m;
        match last {
            // comparing takes less time than rounding
            Some((low, found)) if place.cmpge(low).all() && place.cmplt(low + 1.0).all() => found,
            _ => {
                let low = place.floor();
                let found = find(low.to_array().map(|at| at as i64));
                last = Some((low, found));
                found
            }
        }
    }
}

fn join(above: &mut [u32], one: u32, other: u32) {
    let [one, other] = [one, other].map(|number| lowest(above, number));
    above[one.max(other) as usize] = one.min(other);
}
