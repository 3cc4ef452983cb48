//! How high something may stand without blocking rays to the sun: over each cell of a plot, the least height of the
//! rays that are to stay free.
//!
//! A cell is a column with upright walls, and rays to the sun rise, so a ray is lowest over a cell where it enters.
//! Columns are widened a little, so that no rounding lets a ray pass through an edge.

use super::sun_slopes::{SpellSlopes, SunSlopes};
use crate::view::Grid;
use glam::{DVec2, DVec3};
use std::ops::Range;

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
    spans: PlotSpans,
}

/// Where a plot's cells lie in the raster.
#[derive(Clone, Debug, Default)]
struct PlotSpans {
    /// The rows and the columns in which it has cells.
    rows: Range<u32>,
    columns: Range<u32>,
    /// For each row of the raster, from its first to its last cell of the plot.
    of_row: Vec<Range<u32>>,
}

/// Where rays to the sun begin.
#[derive(Clone, Copy, Debug)]
pub struct RaySource {
    /// The point, or the middle of what it stands for.
    pub at: DVec3,
    /// The radius in plan of what it stands for, metres: with its own ray, all that begin as far around it at its height
    /// stay free. A cell is widened by as much.
    pub around_m: f64,
}

/// The directions in plan in which a place may see a plot.
#[derive(Clone, Copy, Debug)]
pub struct PlotSight {
    /// The directions to the corners of a rectangle around the plot that bound it, clockwise and counter-clockwise;
    /// `None` in all directions, from within the rectangle.
    between: Option<[DVec2; 2]>,
}

/// A ray in cells: columns eastwards and rows southwards.
#[derive(Clone, Copy)]
struct PlanRay {
    start: DVec2,
    along: DVec2,
    /// The width by which cells are widened, in cells.
    wider: f64,
}

impl Headroom {
    /// A plot without rays.
    pub fn new(grid: Grid, inside: Vec<bool>) -> Headroom {
        let top = vec![f64::INFINITY; inside.len()];
        let spans = PlotSpans::of(&grid, &inside);
        Headroom { grid, inside, top, spans }
    }

    /// The directions in which a place may see the plot.
    pub fn sight(&self, from: RaySource) -> PlotSight {
        // so that rounding refuses no ray
        let around_m = 2.0 * WIDER_M + from.around_m;
        let PlotSpans { rows, columns, .. } = &self.spans;
        let Grid { west, north, cell, .. } = self.grid;
        let [west, east] = [columns.start, columns.end].map(|column| west + f64::from(column) * cell);
        let [north, south] = [rows.start, rows.end].map(|row| north - f64::from(row) * cell);
        let (low, high) = (DVec2::new(west, south) - around_m, DVec2::new(east, north) + around_m);
        let from = from.at.truncate();
        if from.cmpge(low).all() && from.cmple(high).all() {
            return PlotSight { between: None };
        }
        let corners = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)].map(|corner| corner - from);
        // all lie within less than half a turn
        let first = |sign: f64| {
            let is_before = |one: DVec2, other: DVec2| sign * one.perp_dot(other) > 0.0;
            corners.into_iter().reduce(|first, corner| if is_before(corner, first) { corner } else { first })
        };
        PlotSight { between: first(1.0).zip(first(-1.0)).map(|(right, left)| [right, left]) }
    }

    /// The least z of a ray over the plot: where it enters the plot's first cell.
    pub fn lowest(&self, from: RaySource, to_sun: DVec3) -> f64 {
        let Some((ray, ends)) = self.over_plot(from, to_sun) else { return f64::INFINITY };
        let mut first = f64::INFINITY;
        self.each_row(ray, ends, |row, columns, ends| {
            // widened rows overlap, so a row may be entered before a cell of the row before it
            if ends[0] > first {
                return false;
            }
            let inside = |column: &u32| self.inside[self.cell(*column, row)];
            let column = if ray.along.x < 0.0 { columns.rev().find(inside) } else { columns.into_iter().find(inside) };
            if let Some(entry) = column.and_then(|column| ray.entry(column, ends)) {
                first = first.min(entry);
            }
            true
        });
        if first.is_finite() { from.at.z + to_sun.z * first } else { f64::INFINITY }
    }

    /// Lowers the heights so that a place's rays stay free in some spells: from a second to the one after the last.
    pub fn keep(&mut self, from: RaySource, spells: &[[i64; 2]], slopes: &SunSlopes) {
        let spells: Vec<[usize; 2]> = spells.iter().map(|spell| slopes.indices(*spell)).collect();
        let sides = [0, 1].map(|axis| slopes.in_spells(axis, &spells));
        for row in self.spans.rows.clone() {
            for column in self.spans.of_row[row as usize].clone() {
                let cell = self.cell(column, row);
                if self.inside[cell] {
                    let lowest = self.lowest_over(from, [column, row], &sides, self.top[cell]);
                    self.top[cell] = self.top[cell].min(lowest);
                }
            }
        }
    }

    /// The height of a place's lowest ray over a cell. It need not be found if it is not below `top`.
    fn lowest_over(
        &self,
        from: RaySource,
        [column, row]: [u32; 2],
        sides: &[[Option<SpellSlopes<'_>>; 2]; 2],
        top: f64,
    ) -> f64 {
        let Grid { west, north, cell, .. } = self.grid;
        let RaySource { at: from, around_m } = from;
        let low = DVec2::new(west + f64::from(column) * cell, north - f64::from(row + 1) * cell) - from.truncate();
        let (low, high) = (low - WIDER_M - around_m, low + cell + WIDER_M + around_m);
        if low.cmple(DVec2::ZERO).all() && high.cmpge(DVec2::ZERO).all() {
            // a ray begins over it
            return if sides.iter().flatten().any(Option::is_some) { from.z } else { f64::INFINITY };
        }
        let mut lowest = f64::INFINITY;
        for axis in 0..2 {
            // a ray enters through the sides that face its place
            let (away, side) =
                if low[axis] > 0.0 { (low[axis], &sides[axis][0]) } else { (-high[axis], &sides[axis][1]) };
            let Some(side) = side else { continue };
            if away <= 0.0 || from.z + away * side.least_up >= lowest.min(top) {
                continue;
            }
            let across = [low[1 - axis] / away, high[1 - axis] / away];
            let least = side.least(across);
            lowest = lowest.min(least.map_or(f64::INFINITY, |up| from.z + away * up));
        }
        lowest
    }

    /// Combines the heights that two sets of rays leave over the same plot.
    pub fn and(mut self, other: &Headroom) -> Headroom {
        self.top.iter_mut().zip(&other.top).for_each(|(top, other)| *top = top.min(*other));
        self
    }

    /// By how much a ray would lower the heights, none of which counts above `most`: a sum over cells, metres.
    pub fn cut(&self, from: RaySource, to_sun: DVec3, most: f64) -> f64 {
        let mut sum = 0.0;
        self.over(from, to_sun, |cell, height| sum += (self.top[cell].min(most) - height).max(0.0));
        sum
    }

    /// The volume below the heights and above `ground`, cubic metres. Heights above `most` count as that.
    pub fn volume_m3(&self, ground: f64, most: f64) -> f64 {
        let of = |(top, inside): (&f64, &bool)| if *inside { (top.min(most) - ground).max(0.0) } else { 0.0 };
        self.top.iter().zip(&self.inside).map(of).sum::<f64>() * self.grid.cell * self.grid.cell
    }

    fn cell(&self, column: u32, row: u32) -> usize {
        row as usize * self.grid.width as usize + column as usize
    }

    /// Calls back for each cell of the plot over which a ray passes, with the ray's height where it enters.
    fn over(&self, from: RaySource, to_sun: DVec3, mut each: impl FnMut(usize, f64)) {
        let Some((ray, ends)) = self.over_plot(from, to_sun) else { return };
        self.each_row(ray, ends, |row, columns, ends| {
            for column in columns {
                let cell = self.cell(column, row);
                if let (true, Some(entry)) = (self.inside[cell], ray.entry(column, ends)) {
                    each(cell, from.at.z + to_sun.z * entry);
                }
            }
            true
        });
    }

    /// A ray in cells, and the part of it over the rectangle around the plot. A ray that does not rise belongs to no
    /// sun.
    fn over_plot(&self, from: RaySource, to_sun: DVec3) -> Option<(PlanRay, [f64; 2])> {
        if to_sun.z <= 0.0 || self.spans.rows.is_empty() {
            return None;
        }
        let cell = self.grid.cell;
        let start = DVec2::new(from.at.x - self.grid.west, self.grid.north - from.at.y) / cell;
        let along = DVec2::new(to_sun.x, -to_sun.y) / cell;
        let ray = PlanRay { start, along, wider: (WIDER_M + from.around_m) / cell };
        Some((ray, ray.within(&self.spans.columns, &self.spans.rows)?))
    }

    /// Calls back for each row that a ray passes, in that order, with the columns of the plot in which the ray may be
    /// there, and the part of the ray in the row, until the answer is `false`.
    fn each_row(&self, ray: PlanRay, ends: [f64; 2], mut each: impl FnMut(u32, Range<u32>, [f64; 2]) -> bool) {
        let rows = ray.cells(ray.start.y, ray.along.y, ends, &self.spans.rows);
        let count = rows.len() as u32;
        for step in 0..count {
            let row = if ray.along.y < 0.0 { rows.end - 1 - step } else { rows.start + step };
            let Some(in_row) = between(ray.start.y, ray.along.y, ray.sides(row..row + 1), ends) else { continue };
            let columns = ray.cells(ray.start.x, ray.along.x, in_row, &self.spans.of_row[row as usize]);
            if !columns.is_empty() && !each(row, columns, in_row) {
                return;
            }
        }
    }
}

impl RaySource {
    /// A single point.
    pub fn point(at: DVec3) -> RaySource {
        RaySource { at, around_m: 0.0 }
    }
}

impl PlotSight {
    /// Whether a ray to the sun may pass over the plot.
    pub fn may_meet(&self, to_sun: DVec3) -> bool {
        let to_sun = to_sun.truncate();
        self.between.is_none_or(|[right, left]| right.perp_dot(to_sun) >= 0.0 && to_sun.perp_dot(left) >= 0.0)
    }
}

impl PlotSpans {
    fn of(grid: &Grid, inside: &[bool]) -> PlotSpans {
        let mut spans = PlotSpans::default();
        let both = |one: Range<u32>, other: &Range<u32>| match (one.is_empty(), other.is_empty()) {
            (_, true) => one,
            (true, false) => other.clone(),
            _ => one.start.min(other.start)..one.end.max(other.end),
        };
        for (row, cells) in (0..grid.height).zip(inside.chunks(grid.width.max(1) as usize)) {
            let first = cells.iter().position(|inside| *inside).unwrap_or(0) as u32;
            let end = cells.iter().rposition(|inside| *inside).map_or(0, |last| last as u32 + 1);
            let span = first..end;
            if !span.is_empty() {
                spans.rows = both(spans.rows, &(row..row + 1));
                spans.columns = both(spans.columns, &span);
            }
            spans.of_row.push(span);
        }
        spans
    }
}

impl PlanRay {
    /// The part of the ray within a rectangle of cells, from its start on.
    fn within(&self, columns: &Range<u32>, rows: &Range<u32>) -> Option<[f64; 2]> {
        let across = between(self.start.x, self.along.x, self.sides(columns.clone()), [0.0, f64::INFINITY])?;
        let [first, last] = between(self.start.y, self.along.y, self.sides(rows.clone()), across)?;
        // a vertical line stays where it is in plan
        last.is_finite().then_some([first, last]).or(Some([first, first]))
    }

    /// The widened borders of some cells in a line.
    fn sides(&self, cells: Range<u32>) -> [f64; 2] {
        [f64::from(cells.start) - self.wider, f64::from(cells.end) + self.wider]
    }

    /// Those of some cells in a line over which a part of the ray may pass.
    fn cells(&self, start: f64, along: f64, [first, last]: [f64; 2], of: &Range<u32>) -> Range<u32> {
        let ends = [first, last].map(|at| start + along * at);
        let [low, high] = [ends[0].min(ends[1]) - self.wider, ends[0].max(ends[1]) + self.wider];
        // casts saturate, so that what is left of the first cell is 0
        (low.floor() as u32).max(of.start)..((high.floor() + 1.0) as u32).min(of.end)
    }

    /// Where the ray enters a cell, if it meets it within a part of it that lies in the cell's row.
    fn entry(&self, column: u32, in_row: [f64; 2]) -> Option<f64> {
        between(self.start.x, self.along.x, self.sides(column..column + 1), in_row).map(|[entry, _]| entry)
    }
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
