//! Contours of a raster: the lines between the cells above a threshold and the others. Marching squares runs between
//! the cells' centres; each line is then straightened as far as it still passes between the same cells.
//!
//! A cell is either above or not, so no cell lies on a line. Straight edges come out straight at any slope, because a
//! line may lie anywhere between the centres that it separates. It is first pulled straight between them, over long and
//! then over shorter stretches, and then gets the fewest corners that a greedy walk along it finds (after Guibas et
//! al., "Approximating polygons and subdivisions with minimum-link paths", 1991; ours keeps to points of the pulled
//! line).

use rayon::prelude::*;
use rustc_hash::FxHashMap;

/// The values whose contours are found.
#[derive(Clone, Copy)]
pub struct ScalarField<'a> {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The value of a cell; row 0 comes first. Values are below 2⁶².
    pub value: &'a (dyn Fn(usize) -> u64 + Sync),
    /// Whether a line may be drawn between two neighbours (west and east, or north and south) on different sides of the
    /// threshold. If not, something else separates them, such as a wall, and lines end there.
    pub open: &'a (dyn Fn(usize, usize) -> bool + Sync),
}

/// The line around a group of cells above the threshold, or around a hole in it. It is closed, and clockwise around the
/// cells above if row 0 is at the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Contour {
    /// Columns and rows from the raster's north-west corner, in cells: a cell's centre is half a cell from its corners.
    pub points: Vec<[f64; 2]>,
    /// For the segment from each point to the next, whether it is drawn. Segments along the raster's border are not,
    /// nor are those for which [`ScalarField::open`] is false at both ends.
    pub drawn: Vec<bool>,
}

impl Contour {
    /// Returns the lines that are drawn. A closed one ends with its first point.
    pub fn lines(&self) -> Vec<Vec<[f64; 2]>> {
        let count = self.points.len();
        let Some(gap) = self.drawn.iter().position(|drawn| !drawn) else {
            return vec![self.points.iter().chain(self.points.first()).copied().collect()];
        };
        let mut lines: Vec<Vec<[f64; 2]>> = Vec::new();
        let mut goes_on = false;
        for at in (gap..gap + count).map(|at| at % count) {
            if self.drawn[at] {
                match lines.last_mut().filter(|_| goes_on) {
                    Some(line) => line.push(self.points[(at + 1) % count]),
                    None => lines.push(vec![self.points[at], self.points[(at + 1) % count]]),
                }
            }
            goes_on = self.drawn[at];
        }
        lines
    }

    /// The area that it encloses, in cells; negative for a hole.
    pub fn area(&self) -> f64 {
        let next = self.points.iter().cycle().skip(1);
        self.points.iter().zip(next).map(|(from, to)| cross(*from, *to)).sum::<f64>() / 2.0
    }
}

/// The least distance of a line from a centre, in cells.
const CLEAR: f64 = 0.01;

/// Returns the contours of all cells with a value above `threshold`, in the order of their first rows.
pub fn contours(field: &ScalarField, threshold: u64) -> Vec<Contour> {
    let walk = Walk { field, threshold, pitch: u64::from(field.width) + 2 * PAD };
    let rows = (0..u64::from(field.height) + 2 * PAD - 1).into_par_iter();
    let steps: Vec<(u64, u64)> = rows.flat_map_iter(|row| walk.steps(row)).collect();
    let mut next: FxHashMap<u64, u64> = steps.iter().copied().collect();
    let mut rings = Vec::new();
    for (first, _) in steps {
        let mut ring = Vec::new();
        let mut at = first;
        while let Some(to) = next.remove(&at) {
            ring.push(walk.crossing(at));
            at = to;
        }
        if !ring.is_empty() {
            rings.push(ring);
        }
    }
    rings.into_par_iter().map(straightened).collect()
}

/// The padding around the raster: one cell like its inner neighbour, so that lines reach the border, and one below any
/// threshold, so that they close.
const PAD: u64 = 2;

/// Why a line passes between two cells.
#[derive(Clone, Copy, PartialEq, Eq)]
enum LineCause {
    /// The values are on different sides of the threshold.
    Open,
    /// Something else separates the cells.
    Wall,
    /// One of the cells is outside of the raster.
    Border,
}

/// Where a line passes between two cells.
#[derive(Clone, Copy)]
struct LineCrossing {
    point: [f64; 2],
    /// The line passes between these: a cell below the threshold, and one above.
    sides: [[f64; 2]; 2],
    between: LineCause,
}

struct Walk<'a> {
    field: &'a ScalarField<'a>,
    threshold: u64,
    /// The number of columns with padding.
    pitch: u64,
}

impl Walk<'_> {
    /// The raster's cell for a padded one; `None` outside.
    fn cell(&self, column: u64, row: u64) -> Option<usize> {
        let along = |at: u64, count: u32| {
            let last = u64::from(count) + 2 * PAD - 1;
            (at > 0 && at < last).then(|| at.saturating_sub(PAD).min(u64::from(count) - 1) as usize)
        };
        Some(along(row, self.field.height)? * self.field.width as usize + along(column, self.field.width)?)
    }

    fn above(&self, row: u64) -> Vec<bool> {
        let is_above = |cell| (self.field.value)(cell) > self.threshold;
        (0..self.pitch).map(|column| self.cell(column, row).is_some_and(is_above)).collect()
    }

    /// The steps of lines through the squares between the centres of a row and the next. Each leads from one pair of
    /// neighbours that it separates to another. A pair is encoded as twice the index of its first cell, plus 1 if the
    /// second is below it.
    fn steps(&self, row: u64) -> Vec<(u64, u64)> {
        let (upper, lower) = (self.above(row), self.above(row + 1));
        let mut steps = Vec::new();
        for (at, (up, low)) in upper.windows(2).zip(lower.windows(2)).enumerate() {
            // clockwise from the north-west; the sides between them clockwise from the north
            let corners = [up[0], up[1], low[1], low[0]];
            if corners == [corners[0]; 4] {
                continue;
            }
            let first = row * self.pitch + at as u64;
            let sides = [2 * first, 2 * (first + 1) + 1, 2 * (first + self.pitch), 2 * first + 1];
            let is_saddle = corners[0] == corners[2] && corners[1] == corners[3];
            let turn = if is_saddle && self.joined(at as u64, row) { 1 } else { 3 };
            for from in (0..4).filter(|&side| corners[side] && !corners[(side + 1) % 4]) {
                let mut to = (from + turn) % 4;
                while corners[to] || !corners[(to + 1) % 4] {
                    to = (to + turn) % 4;
                }
                steps.push((sides[from], sides[to]));
            }
        }
        steps
    }

    /// Whether two diagonal cells above the threshold are connected: they are if the mean is above, too.
    fn joined(&self, column: u64, row: u64) -> bool {
        let cells = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(east, south)| self.cell(column + east, row + south));
        let sum: u128 = cells.into_iter().flatten().map(|cell| u128::from((self.field.value)(cell))).sum();
        sum > 4 * u128::from(self.threshold) + 2
    }

    fn crossing(&self, pair: u64) -> LineCrossing {
        let (column, row, south) = (pair / 2 % self.pitch, pair / 2 / self.pitch, pair % 2);
        let ends = [[column, row], [column + 1 - south, row + south]];
        let centre = |[column, row]: [u64; 2]| {
            let within = |at: u64, count: u32| (at as f64 - PAD as f64 + 0.5).clamp(0.0, f64::from(count));
            [within(column, self.field.width), within(row, self.field.height)]
        };
        let centres = ends.map(centre);
        let (Some(a), Some(b)) = (self.cell(ends[0][0], ends[0][1]), self.cell(ends[1][0], ends[1][1])) else {
            // outside cells, and those that replace them, are at the border
            let point = centres[usize::from(self.cell(ends[0][0], ends[0][1]).is_none())];
            return LineCrossing { point, sides: [point; 2], between: LineCause::Border };
        };
        let between = if (self.field.open)(a, b) { LineCause::Open } else { LineCause::Wall };
        let sides = if (self.field.value)(a) > self.threshold { [centres[1], centres[0]] } else { centres };
        LineCrossing { point: mix(centres[0], centres[1], 0.5), sides, between }
    }
}

/// A ring of crossings with only the corners that it needs.
fn straightened(mut ring: Vec<LineCrossing>) -> Contour {
    let count = ring.len();
    let is_drawn = |ring: &[LineCrossing], at: usize| {
        let ends = [ring[at % count].between, ring[(at + 1) % count].between];
        ends.contains(&LineCause::Open) && !ends.contains(&LineCause::Border)
    };
    // drawn stretches begin and end with points of their own
    let change = (1..count).find(|&at| is_drawn(&ring, at - 1) != is_drawn(&ring, at));
    ring.rotate_left(change.unwrap_or(0));
    ring.push(ring[0]);
    let (mut points, mut drawn) = (Vec::new(), Vec::new());
    let mut from = 0;
    while from < count {
        let is_line = is_drawn(&ring, from);
        let end = (from + 1..count).find(|&at| is_drawn(&ring, at) != is_line).unwrap_or(count);
        pull(&mut ring[from..=end]);
        while from < end {
            points.push(ring[from].point);
            drawn.push(is_line);
            from += reach(&ring[from..=end]);
        }
    }
    Contour { points, drawn }
}

/// Pulls crossings towards the straight line between others before and after them, as far as their sides allow.
fn pull(ring: &mut [LineCrossing]) {
    let last = ring.len() - 1;
    for away in [128, 64, 32, 16, 8, 4, 2, 1] {
        for at in 1..last {
            // small shapes are kept
            let away = away.min(at).min(last - at).min(last / 8);
            if away == 0 {
                continue;
            }
            let [before, behind] = [ring[at - away].point, ring[at + away].point];
            let LineCrossing { sides: [low, high], between, .. } = ring[at];
            let along = sub(behind, before);
            let [left, right] = [low, high].map(|side| cross(along, sub(side, before)));
            // a line that runs backwards does not pass between cells
            if between != LineCause::Border && right - left > 1e-9 {
                let share = left / (left - right);
                ring[at].point = mix(low, high, share.clamp(2.0 * CLEAR, 1.0 - 2.0 * CLEAR));
            }
        }
    }
}

/// The number of crossings on a straight line from the first one, found by exponential search.
fn reach(ring: &[LineCrossing]) -> usize {
    let last = ring.len() - 1;
    let (mut reach, mut leap) = (1, 1);
    while reach + leap <= last && is_straight(&ring[..=reach + leap]) {
        reach += leap;
        leap *= 2;
    }
    while leap > 1 {
        leap /= 2;
        if reach + leap <= last && is_straight(&ring[..=reach + leap]) {
            reach += leap;
        }
    }
    reach
}

/// Whether the straight line from the first to the last passes between the same cells, in the same order and direction.
fn is_straight(ring: &[LineCrossing]) -> bool {
    let [first, between @ .., last] = ring else { return true };
    let along = sub(last.point, first.point);
    let square = dot(along, along);
    if square < 1e-12 {
        return false;
    }
    let mut before = 0.0;
    between.iter().all(|crossing| {
        let [low, high] = crossing.sides.map(|side| sub(side, first.point));
        let hit = if crossing.between == LineCause::Border {
            if cross(along, low).abs() > 1e-9 * square.sqrt() {
                return false;
            }
            low
        } else {
            let [low, high] = [mix(low, high, CLEAR), mix(high, low, CLEAR)];
            let [left, right] = [cross(along, low), cross(along, high)];
            if left >= 0.0 || right <= 0.0 {
                return false;
            }
            mix(low, high, left / (left - right))
        };
        let at = dot(hit, along) / square;
        let goes_on = at >= before && at <= 1.0;
        before = at;
        goes_on
    })
}

fn sub(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Positive if `b` points to the right of `a`, with rows counted downwards.
fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn mix(a: [f64; 2], b: [f64; 2], share: f64) -> [f64; 2] {
    [a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share]
}
