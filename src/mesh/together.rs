//! What stands together. Drawings have leftovers, often a thousand kilometres from what was meant: how exact the models
//! are must not be up to them.
//!
//! Places belong together where a triangle joins them, or where they lie in neighbouring cells of a grid; so what is 20 km
//! from all else is always told apart, and what is 10 km from something never is. What is farther from a place than that
//! has another sun.

use super::Part;
use super::adjacency::lowest;
use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

/// A cell of the grid, metres.
const CELL_M: f64 = 10_000.0;
/// Models nearer to the place than this are those that a study is about, metres.
const NEAR_M: f64 = 20_000.0;
/// One triangle near the place counts as many far ones, when it comes to which group is at home.
const NEAR_COUNTS: u64 = 1000;

/// The parts' corners in groups that stand together.
pub(super) struct Together {
    /// Per occupied cell its group; empty where all is one.
    group_of: FxHashMap<[i64; 3], u32>,
    /// The group that is meant: most of the triangles, above all of those near the place.
    home: Group,
}

/// The corners that stand together: a box around them, and how many they are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Group {
    pub(super) low: DVec3,
    pub(super) high: DVec3,
    pub(super) corners: usize,
    triangles: u64,
}

impl Group {
    const NONE: Group = Group { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY, corners: 0, triangles: 0 };

    fn add(&mut self, corner: DVec3) {
        *self = Group { low: self.low.min(corner), high: self.high.max(corner), corners: self.corners + 1, ..*self };
    }

    /// From corner to corner of its box, metres.
    pub(super) fn size(&self) -> f64 {
        if self.low.x <= self.high.x { (self.high - self.low).length() } else { 0.0 }
    }

    /// How far it is from the place, along the ground.
    fn distance(&self) -> f64 {
        DVec3::ZERO.clamp(self.low, self.high).truncate().length()
    }

    fn weight(&self) -> u64 {
        self.triangles.saturating_mul(if self.distance() <= NEAR_M { NEAR_COUNTS } else { 1 })
    }
}

impl Together {
    pub(super) fn of(parts: &[Part]) -> Together {
        let points = || parts.par_iter().flat_map(|part| part.positions.par_iter().copied());
        let low = points().reduce(|| DVec3::INFINITY, DVec3::min);
        let high = points().reduce(|| DVec3::NEG_INFINITY, DVec3::max);
        if (high - low).max_element() <= CELL_M {
            // neighbouring cells at most
            return Together { group_of: FxHashMap::default(), home: Group { low, high, ..Group::NONE } };
        }

        // cells by the order in which they appear, and a forest of those that belong together
        let mut cells: Vec<[i64; 3]> = Vec::new();
        let mut number: FxHashMap<[i64; 3], u32> = FxHashMap::default();
        let mut above: Vec<u32> = Vec::new();
        for part in parts {
            let of_corner: Vec<u32> = part
                .positions
                .iter()
                .map(|&corner| {
                    *number.entry(cell(corner)).or_insert_with_key(|&cell| {
                        cells.push(cell);
                        above.push(above.len() as u32);
                        above.len() as u32 - 1
                    })
                })
                .collect();
            for &[a, b, c] in &part.triangles {
                let [a, b, c] = [a, b, c].map(|corner| of_corner[corner as usize]);
                join(&mut above, a, b);
                join(&mut above, b, c);
            }
        }
        for (at, &[x, y, z]) in cells.iter().enumerate() {
            let near = |of: i64| [of.saturating_sub(1), of, of.saturating_add(1)];
            for neighbour in near(x).into_iter().flat_map(|x| near(y).map(|y| (x, y))) {
                for z in near(z) {
                    if let Some(&other) = number.get(&[neighbour.0, neighbour.1, z]) {
                        join(&mut above, at as u32, other);
                    }
                }
            }
        }
        let group_of: FxHashMap<[i64; 3], u32> =
            number.into_iter().map(|(cell, number)| (cell, lowest(&mut above, number))).collect();

        let mut groups = vec![Group::NONE; cells.len()];
        let group = |corner: DVec3| group_of[&cell(corner)] as usize;
        for part in parts {
            part.positions.iter().for_each(|&corner| groups[group(corner)].add(corner));
            for triangle in &part.triangles {
                groups[group(part.positions[triangle[0] as usize])].triangles += 1;
            }
        }
        let better = |one: &Group, other: &Group| {
            one.weight().cmp(&other.weight()).then(other.distance().total_cmp(&one.distance())).is_gt()
        };
        let home = groups.into_iter().reduce(|best, group| if better(&group, &best) { group } else { best });
        Together { group_of, home: home.unwrap_or(Group::NONE) }
    }

    /// A box around what stands at home; none where there are no corners.
    pub(super) fn home(&self) -> Option<(DVec3, DVec3)> {
        (self.home.low.x <= self.home.high.x).then_some((self.home.low, self.home.high))
    }

    /// Whether a corner lies in that box.
    pub(super) fn is_home(&self, corner: DVec3) -> bool {
        corner.cmpge(self.home.low).all() && corner.cmple(self.home.high).all()
    }

    /// The groups in which a part has corners; and per corner which of them it is in, where there are several.
    pub(super) fn in_part(&self, part: &Part) -> (Vec<Group>, Option<Vec<u32>>) {
        let mut groups: Vec<Group> = Vec::new();
        if self.group_of.is_empty() {
            let mut group = Group::NONE;
            part.positions.iter().for_each(|&corner| group.add(corner));
            groups.push(group);
            return (groups, None);
        }
        let mut numbers: FxHashMap<u32, u32> = FxHashMap::default();
        let mut of_corner = Vec::with_capacity(part.positions.len());
        for &corner in &part.positions {
            let number = *numbers.entry(self.group_of[&cell(corner)]).or_insert_with(|| {
                groups.push(Group::NONE);
                groups.len() as u32 - 1
            });
            groups[number as usize].add(corner);
            of_corner.push(number);
        }
        let are_several = groups.len() > 1;
        (groups, are_several.then_some(of_corner))
    }
}

fn cell(corner: DVec3) -> [i64; 3] {
    (corner / CELL_M).floor().to_array().map(|at| at as i64)
}

fn join(above: &mut [u32], one: u32, other: u32) {
    let [one, other] = [one, other].map(|number| lowest(above, number));
    above[one.max(other) as usize] = one.min(other);
}
