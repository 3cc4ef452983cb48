//! How high something may stand without blocking rays to the sun: over each cell of a plot, the least height of the
//! rays that are to stay free.
//!
//! A cell is a column with upright walls, and rays to the sun rise, so a ray is lowest over a cell where it enters.
//! Columns are widened a little, so that no rounding lets a ray pass through an edge.

use crate::view::Grid;
use glam::{DVec2, DVec3};

/// The width by which a cell is widened on each side, metres. A ray that only touches it counts as meeting it.
const WIDER_M: f64 = 0.001;

/// The heights that rays leave over a plot.
#[derive(Clone, Debug)]
pub struct Headroom {
    /// The cells.
    pub grid: Grid,
    /// For each cell, whether it belongs to the plot. Row 0 is north.
    pub inside: Vec<bool>,
    /// For each cell, the z of the lowest ray over it; infinite where there is none.
    pub top: Vec<f64>,
}

/// A second, and the least z of its ray over a plot; infinite if the ray does not pass over it.
pub type RayHeight = (i64, f64);

/// The seconds that are kept free, and the z of the lowest of their rays.
#[derive(Clone, Debug, PartialEq)]
pub struct KeptSeconds {
    /// Spells in their order: the first second, and the one after the last.
    pub spells: Vec<[i64; 2]>,
    /// Infinite if none of them passes over the plot.
    pub lowest: f64,
}

impl Headroom {
    /// A plot without rays.
    pub fn new(grid: Grid, inside: Vec<bool>) -> Headroom {
        let top = vec![f64::INFINITY; inside.len()];
        Headroom { grid, inside, top }
    }

    /// The least z of a ray over the plot.
    pub fn lowest(&self, from: DVec3, to_sun: DVec3) -> f64 {
        let mut lowest = f64::INFINITY;
        self.over(from, to_sun, |_, height| lowest = lowest.min(height));
        lowest
    }

    /// Lowers the heights so that a ray stays free.
    pub fn keep(&mut self, from: DVec3, to_sun: DVec3) {
        let mut top = std::mem::take(&mut self.top);
        self.over(from, to_sun, |cell, height| top[cell] = top[cell].min(height));
        self.top = top;
    }

    /// Combines the heights that two sets of rays leave over the same plot.
    pub fn and(mut self, other: &Headroom) -> Headroom {
        self.top.iter_mut().zip(&other.top).for_each(|(top, other)| *top = top.min(*other));
        self
    }

    /// Calls back for each cell of the plot over which a ray passes, with the ray's height where it enters. A ray that
    /// does not rise belongs to no sun.
    fn over(&self, from: DVec3, to_sun: DVec3, mut each: impl FnMut(usize, f64)) {
        if to_sun.z <= 0.0 {
            return;
        }
        // in cells, columns eastwards and rows southwards
        let cell = self.grid.cell;
        let start = DVec2::new(from.x - self.grid.west, self.grid.north - from.y) / cell;
        let along = DVec2::new(to_sun.x, -to_sun.y) / cell;
        let wider = WIDER_M / cell;
        let (width, height) = (f64::from(self.grid.width), f64::from(self.grid.height));
        let Some([first, last]) = within(start, along, [width, height], wider) else { return };
        // one row after the other, and in each the columns between the points where the ray enters and leaves the row
        let rows = {
            let ends = [first, last].map(|at| start.y + along.y * at);
            let [low, high] = [ends[0].min(ends[1]) - wider, ends[0].max(ends[1]) + wider];
            (low.floor().max(0.0) as u32)..=(high.floor().clamp(0.0, height - 1.0) as u32)
        };
        for row in rows {
            let sides = [f64::from(row) - wider, f64::from(row) + 1.0 + wider];
            let Some([from_row, to_row]) = between(start.y, along.y, sides, [first, last]) else { continue };
            let ends = [from_row, to_row].map(|at| start.x + along.x * at);
            let [low, high] = [ends[0].min(ends[1]) - wider, ends[0].max(ends[1]) + wider];
            if high < 0.0 || low >= width {
                continue;
            }
            for column in (low.floor().max(0.0) as u32)..=(high.floor().clamp(0.0, width - 1.0) as u32) {
                let index = row as usize * self.grid.width as usize + column as usize;
                let sides = [f64::from(column) - wider, f64::from(column) + 1.0 + wider];
                let entry = between(start.x, along.x, sides, [from_row, to_row]);
                if let (true, Some([entry, _])) = (self.inside[index], entry) {
                    each(index, from.z + to_sun.z * entry);
                }
            }
        }
    }
}

/// The part of a line within a rectangle, from the line's start on.
fn within(start: DVec2, along: DVec2, [width, height]: [f64; 2], wider: f64) -> Option<[f64; 2]> {
    let across = between(start.x, along.x, [-wider, width + wider], [0.0, f64::INFINITY])?;
    let [first, last] = between(start.y, along.y, [-wider, height + wider], across)?;
    // a vertical line stays where it is in plan
    last.is_finite().then_some([first, last]).or(Some([first, first]))
}

/// The part of a line's range in which one coordinate lies between two values.
fn between(start: f64, along: f64, [low, high]: [f64; 2], [first, last]: [f64; 2]) -> Option<[f64; 2]> {
    if along == 0.0 {
        return (low <= start && start <= high).then_some([first, last]);
    }
    let ends = [(low - start) / along, (high - start) / along];
    let [first, last] = [first.max(ends[0].min(ends[1])), last.min(ends[0].max(ends[1]))];
    (first <= last).then_some([first, last])
}

/// From seconds in their order, chooses enough of them such that their lowest ray is as high as possible. `at_once`
/// asks for one stretch without a gap. Returns `None` if there are not enough.
pub fn roomiest(rays: &[RayHeight], secs: usize, at_once: bool) -> Option<KeptSeconds> {
    if secs == 0 {
        return Some(KeptSeconds { spells: Vec::new(), lowest: f64::INFINITY });
    }
    if rays.len() < secs {
        return None;
    }
    if at_once {
        return longest_at_once(rays, secs);
    }
    let mut by_height: Vec<usize> = (0..rays.len()).collect();
    // the first of equal ones
    by_height.sort_by(|one, other| rays[*other].1.total_cmp(&rays[*one].1).then(one.cmp(other)));
    let lowest = rays[by_height[secs - 1]].1;
    let mut kept: Vec<i64> = by_height[..secs].iter().map(|at| rays[*at].0).collect();
    kept.sort_unstable();
    Some(KeptSeconds { spells: spells(&kept), lowest })
}

/// The same for one stretch without a gap. The lowest ray of each stretch is found with a queue of the rays that may
/// become it.
fn longest_at_once(rays: &[RayHeight], secs: usize) -> Option<KeptSeconds> {
    let mut best: Option<(f64, usize)> = None;
    let mut queue = std::collections::VecDeque::new();
    let mut begin = 0;
    for (at, (second, height)) in rays.iter().enumerate() {
        if at > 0 && rays[at - 1].0 + 1 != *second {
            queue.clear();
            begin = at;
        }
        while queue.back().is_some_and(|last: &usize| rays[*last].1 >= *height) {
            queue.pop_back();
        }
        queue.push_back(at);
        if at + 1 < begin + secs {
            continue;
        }
        let first = at + 1 - secs;
        while queue.front().is_some_and(|front| *front < first) {
            queue.pop_front();
        }
        let lowest = queue.front().map_or(f64::INFINITY, |front| rays[*front].1);
        if best.is_none_or(|(height, _)| lowest > height) {
            best = Some((lowest, first));
        }
    }
    let (lowest, first) = best?;
    Some(KeptSeconds { spells: vec![[rays[first].0, rays[first].0 + secs as i64]], lowest })
}

/// Merges seconds into spells.
fn spells(seconds: &[i64]) -> Vec<[i64; 2]> {
    let mut spells: Vec<[i64; 2]> = Vec::new();
    for second in seconds {
        match spells.last_mut() {
            Some(last) if last[1] == *second => last[1] += 1,
            _ => spells.push([*second, *second + 1]),
        }
    }
    spells
}
