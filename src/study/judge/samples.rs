//! An area as triangles with points at their corners, split where what is asked of it changes.
//!
//! The error of a number's sum is what the last splits of triangles changed, added up without signs. `parts` has the parts
//! of an area that keep a demand.

use super::super::StudyError;
use super::border_points::points_in;
use super::judging::Steps;
use crate::judgement::PartTriangle;
use crate::sun::SunError;
use glam::DVec3;
use rayon::prelude::*;
use std::collections::HashMap;

/// The distance of points from the area's border, metres, so that what stands at the border does not enclose them.
const INSIDE_M: f64 = 0.001;

/// A point of an area.
#[derive(Clone, Copy, Debug)]
pub(super) struct AreaSpot {
    /// The point on the area; on the plan if the area lies on the ground.
    pub(super) at: DVec3,
    /// The upward normal of a sloped face.
    pub(super) normal: Option<DVec3>,
}

/// A triangle that is not split further.
#[derive(Clone, Debug)]
pub(super) struct Leaf {
    pub(super) corners: [u32; 3],
    pub(super) m2: f64,
    /// For each number that is summed, how much the last split changed, as this triangle's share of it.
    pub(super) changed: Vec<f64>,
}

/// The sum over an area of each number, with its error.
#[derive(Clone, Debug, Default)]
pub(super) struct AreaSums {
    pub(super) sums: Vec<f64>,
    pub(super) errors: Vec<f64>,
}

/// An area's points and triangles.
pub(super) struct Samples {
    pub(super) spots: Vec<AreaSpot>,
    /// The numbers at each point.
    pub(super) values: Vec<Vec<f64>>,
    pub(super) leaves: Vec<Leaf>,
    middles: HashMap<(u32, u32), u32>,
}

/// The numbers asked of a point, in their order.
pub(super) type SpotFunction<'a> = &'a (dyn Fn(&AreaSpot) -> Result<Vec<f64>, SunError> + Sync);

/// The error that a sum may have, given the sum so far.
pub(super) type AllowedError<'a> = &'a dyn Fn(f64) -> f64;

impl Samples {
    /// Cuts an area into triangles whose sides are at most `longest_m` long.
    pub(super) fn new(triangles: &[PartTriangle], longest_m: f64) -> Samples {
        let mut samples =
            Samples { spots: Vec::new(), values: Vec::new(), leaves: Vec::new(), middles: HashMap::new() };
        for triangle in triangles {
            let middle = triangle.corners.iter().sum::<DVec3>() / 3.0;
            let corners = triangle.corners.map(|corner| {
                let inward = middle - corner;
                let by = INSIDE_M.min(inward.length() / 10.0);
                let at = corner + inward.normalize_or_zero() * by;
                samples.spots.push(AreaSpot { at, normal: triangle.normal });
                samples.spots.len() as u32 - 1
            });
            let mut waiting = vec![(corners, triangle.m2)];
            while let Some((corners, m2)) = waiting.pop() {
                match samples.halved(corners, longest_m) {
                    Some(halves) => waiting.extend(halves.map(|half| (half, m2 / 2.0))),
                    None => samples.leaves.push(Leaf { corners, m2, changed: Vec::new() }),
                }
            }
        }
        samples
    }

    /// A point at random in each triangle, with the triangle's square metres.
    pub(super) fn spot_in_each(&self) -> (Vec<AreaSpot>, Vec<f64>) {
        let of = |leaf: &Leaf| {
            let [a, b, c] = leaf.corners.map(|corner| self.spots[corner as usize]);
            points_in([a.at, b.at, c.at], 0, 1)
                .map(|at| (AreaSpot { at, normal: a.normal }, leaf.m2))
                .collect::<Vec<_>>()
        };
        self.leaves.iter().flat_map(of).unzip()
    }

    /// Halves a triangle as long as its longest side is too long.
    fn halved(&mut self, corners: [u32; 3], longest_m: f64) -> Option<[[u32; 3]; 2]> {
        let at = |corner: u32| self.spots[corner as usize].at;
        let length = |first: usize| at(corners[first]).distance(at(corners[(first + 1) % 3]));
        let longest = (0..3).max_by(|one, other| length(*one).total_cmp(&length(*other)))?;
        if length(longest) <= longest_m {
            return None;
        }
        let [a, b, c] = [0, 1, 2].map(|step| corners[(longest + step) % 3]);
        let middle = self.middle(a, b);
        Some([[a, middle, c], [middle, b, c]])
    }

    fn middle(&mut self, one: u32, other: u32) -> u32 {
        let key = (one.min(other), one.max(other));
        let spots = &mut self.spots;
        *self.middles.entry(key).or_insert_with(|| {
            let [a, b] = [key.0, key.1].map(|corner| spots[corner as usize]);
            spots.push(AreaSpot { at: (a.at + b.at) / 2.0, normal: a.normal });
            spots.len() as u32 - 1
        })
    }

    /// Computes the numbers at the points that are new.
    pub(super) fn ask(&mut self, value: SpotFunction<'_>, steps: &mut Steps<'_, '_>) -> Result<(), StudyError> {
        const TOGETHER: usize = 512;
        while self.values.len() < self.spots.len() {
            let from = self.values.len();
            let some = &self.spots[from..self.spots.len().min(from + TOGETHER)];
            let found: Vec<_> = some.par_iter().map(value).collect::<Result<_, _>>()?;
            self.values.extend(found);
            steps.poll()?;
        }
        Ok(())
    }

    pub(super) fn of_leaf(&self, corners: [u32; 3], number: usize) -> [f64; 3] {
        corners.map(|corner| self.values[corner as usize][number])
    }

    /// The sums of numbers over the present triangles.
    pub(super) fn sums(&self, numbers: usize) -> AreaSums {
        let of = |number: usize| -> (f64, f64) {
            let leaf = |leaf: &Leaf| {
                let three = self.of_leaf(leaf.corners, number);
                let error = match is_level(three) {
                    true => 0.0,
                    false => leaf.changed.get(number).copied().unwrap_or(leaf.m2 * spread(three)),
                };
                (leaf.m2 * mean(three), error)
            };
            self.leaves.iter().map(leaf).fold((0.0, 0.0), |sum, of| (sum.0 + of.0, sum.1 + of.1))
        };
        let (sums, errors) = (0..numbers).map(of).unzip();
        AreaSums { sums, errors }
    }

    /// Splits the triangles in which the first number changes, until its sum's error does not exceed what `allowed` gives
    /// for the sum, or there are `most` points.
    pub(super) fn refine(
        &mut self,
        value: SpotFunction<'_>,
        (allowed, most): (AllowedError<'_>, usize),
        steps: &mut Steps<'_, '_>,
    ) -> Result<(), StudyError> {
        const AT_LEAST: usize = 2;
        const AT_MOST: usize = 12;
        self.ask(value, steps)?;
        for pass in 0..AT_MOST {
            let sums = self.sums(1);
            let is_good = || sums.errors[0] <= allowed(sums.sums[0]);
            if pass >= AT_LEAST && is_good() || self.spots.len() > most {
                break;
            }
            let leaves = std::mem::take(&mut self.leaves);
            let (whole, split): (Vec<Leaf>, Vec<Leaf>) =
                leaves.into_iter().partition(|leaf| is_level(self.of_leaf(leaf.corners, 0)));
            self.leaves = whole;
            if split.is_empty() {
                break;
            }
            self.split(split, 1, value, steps)?;
        }
        Ok(())
    }

    /// Splits leaves into four each, and records how much that changes the first numbers.
    fn split(
        &mut self,
        leaves: Vec<Leaf>,
        numbers: usize,
        value: SpotFunction<'_>,
        steps: &mut Steps<'_, '_>,
    ) -> Result<(), StudyError> {
        let quarters: Vec<[[u32; 3]; 4]> = leaves.iter().map(|leaf| self.quarters(leaf.corners)).collect();
        self.ask(value, steps)?;
        for (leaf, quarters) in leaves.into_iter().zip(quarters) {
            let quarter_m2 = leaf.m2 / 4.0;
            let changed = |number: usize| {
                let whole = leaf.m2 * mean(self.of_leaf(leaf.corners, number));
                let of = |corners: [u32; 3]| quarter_m2 * mean(self.of_leaf(corners, number));
                (whole - quarters.into_iter().map(of).sum::<f64>()).abs() / 4.0
            };
            let changed: Vec<f64> = (0..numbers).map(changed).collect();
            for corners in quarters {
                self.leaves.push(Leaf { corners, m2: quarter_m2, changed: changed.clone() });
            }
        }
        Ok(())
    }

    pub(super) fn quarters(&mut self, [a, b, c]: [u32; 3]) -> [[u32; 3]; 4] {
        let [ab, bc, ca] = [[a, b], [b, c], [c, a]].map(|[one, other]| self.middle(one, other));
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
    }

    /// Repeatedly splits the triangles around the lowest value of a single number. Returns the point that has it, and
    /// by how much the last splits lowered it.
    pub(super) fn lowest(
        &mut self,
        value: SpotFunction<'_>,
        steps: &mut Steps<'_, '_>,
    ) -> Result<(usize, f64), StudyError> {
        const PASSES: usize = 8;
        const TOGETHER: usize = 12;
        self.ask(value, steps)?;
        let mut lowered = [0.0; 2];
        let mut lowest = self.lowest_spot();
        for _ in 0..PASSES {
            let leaves = std::mem::take(&mut self.leaves);
            let of = |leaf: &Leaf| self.of_leaf(leaf.corners, 0).into_iter().fold(f64::INFINITY, f64::min);
            let mut order: Vec<(f64, Leaf)> = leaves.into_iter().map(|leaf| (of(&leaf), leaf)).collect();
            order.sort_by(|one, other| one.0.total_cmp(&other.0).then(other.1.m2.total_cmp(&one.1.m2)));
            let kept = order.split_off(order.len().min(TOGETHER));
            self.leaves = kept.into_iter().map(|(_, leaf)| leaf).collect();
            self.split(order.into_iter().map(|(_, leaf)| leaf).collect(), 1, value, steps)?;
            let now = self.lowest_spot();
            lowered = [lowered[1], self.values[lowest][0] - self.values[now][0]];
            lowest = now;
        }
        Ok((lowest, lowered.into_iter().sum()))
    }

    fn lowest_spot(&self) -> usize {
        let value = |spot: &usize| self.values[*spot][0];
        (0..self.values.len()).min_by(|one, other| value(one).total_cmp(&value(other))).unwrap_or(0)
    }
}

/// Whether splitting a triangle changes nothing: its corners have the same number.
fn is_level(three: [f64; 3]) -> bool {
    three.iter().all(|value| *value == three[0])
}

/// The difference between the highest and the lowest of three.
pub(super) fn spread([a, b, c]: [f64; 3]) -> f64 {
    a.max(b).max(c) - a.min(b).min(c)
}

fn mean(three: [f64; 3]) -> f64 {
    three.iter().sum::<f64>() / 3.0
}
