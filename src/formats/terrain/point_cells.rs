//! Makes heights on a raster from points, and blocks that stand on it.

use super::grid::{HeightGrid, of_unit};
use crate::formats::ModelFault;
use crate::message::{Message, message};
use glam::{DVec2, DVec3};

/// The mean number of points in a cell.
const IN_A_CELL: f64 = 2.0;
/// The mean number of points in a cell if the ground is not classified; the lowest of them is taken as ground.
const IN_A_LOWEST: f64 = 30.0;
/// The share of points for the usual deviation from their cell's height.
const USUAL: f64 = 0.9;

/// A narrow strip takes more cells than points; so many a point, and so many in all, are ground.
const CELLS_A_POINT: usize = 8;
const SPARSEST: usize = 10_000;

/// Points on a raster.
pub(super) struct PointCells {
    pub grid: HeightGrid,
    /// The number of cells without a point.
    filled: usize,
    /// The distance of points from their cell's height, metres: that of nine in ten, and the greatest.
    deviations: [f64; 2],
}

/// Blocks on the cells of a raster.
pub(super) struct CellBlocks {
    pub positions: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
}

impl PointCells {
    /// The raster of ground points: the mean of each cell, or the lowest point if the ground is not classified.
    pub(super) fn of(points: &[DVec3], is_classified: bool) -> Result<PointCells, ModelFault> {
        let low = points.iter().fold(DVec2::INFINITY, |low, point| low.min(point.truncate()));
        let high = points.iter().fold(DVec2::NEG_INFINITY, |high, point| high.max(point.truncate()));
        let size = high - low;
        if !(size.min_element() > 0.0 && size.is_finite()) {
            return Err(
                message!["has all its points on one line, so there is no ground between them"; "export it again"]
                    .into(),
            );
        }
        let in_a_cell = if is_classified { IN_A_CELL } else { IN_A_LOWEST };
        let cell = rounded_up((size.x * size.y * in_a_cell / points.len() as f64).sqrt());
        let [columns, rows] = size.to_array().map(|side| (side / cell).ceil().max(1.0) + 1.0);
        let count = HeightGrid::counted(columns as u64, rows as u64)?;
        if count > SPARSEST.max(points.len().saturating_mul(CELLS_A_POINT)) {
            let what = format!(
                "has {} points, strewn over {size_x} × {size_y} of its units",
                points.len(),
                size_x = size.x,
                size_y = size.y
            );
            return Err(message![what; "leave out the points that lie apart, and export it again"].into());
        }
        let (columns, rows) = (columns as usize, rows as usize);
        // samples are in the middle of cells, the first in the north-west
        let first = DVec2::new(low.x + cell / 2.0, low.y + cell * (rows as f64 - 0.5));
        let steps = [DVec2::new(cell, 0.0), DVec2::new(0.0, -cell)];
        let heights = vec![f32::NAN; count];
        let mut cells =
            PointCells { grid: HeightGrid { columns, rows, heights, first, steps }, filled: 0, deviations: [0.0; 2] };
        cells.gather(points, is_classified);
        cells.fill();
        Ok(cells)
    }

    /// Whether a point lies over the raster. Beyond it there is no ground that a block could stand on.
    fn has(&self, point: DVec3) -> bool {
        let from_first = (point.truncate() - self.grid.first) / self.grid.steps[0].x;
        let (column, row) = (from_first.x.round(), -from_first.y.round());
        (0.0..self.grid.columns as f64).contains(&column) && (0.0..self.grid.rows as f64).contains(&row)
    }

    /// Points over the cells, and those beyond them.
    pub(super) fn parted(&self, points: Vec<DVec3>) -> (Vec<DVec3>, Vec<DVec3>) {
        points.into_iter().partition(|point| self.has(*point))
    }

    /// The index of a point's cell; only rounding puts a point that the raster has beyond its border.
    fn cell(&self, point: DVec3) -> usize {
        let from_first = (point.truncate() - self.grid.first) / self.grid.steps[0].x;
        let column = (from_first.x.round().max(0.0) as usize).min(self.grid.columns - 1);
        let row = ((-from_first.y).round().max(0.0) as usize).min(self.grid.rows - 1);
        row * self.grid.columns + column
    }

    fn gather(&mut self, points: &[DVec3], is_mean: bool) {
        let mut sums = vec![(0.0, 0_u32); self.grid.heights.len()];
        for &point in points {
            let (sum, count) = &mut sums[self.cell(point)];
            *sum = if is_mean { *sum + point.z } else { if *count == 0 { point.z } else { point.z.min(*sum) } };
            *count += 1;
        }
        for (height, (sum, count)) in self.grid.heights.iter_mut().zip(&sums) {
            if *count > 0 {
                *height = (if is_mean { sum / f64::from(*count) } else { *sum }) as f32;
            }
        }
        if is_mean {
            let deviation = |&point: &DVec3| (point.z - f64::from(self.grid.heights[self.cell(point)])).abs();
            let mut all: Vec<f64> = points.iter().map(deviation).collect();
            let usual = ((all.len() - 1) as f64 * USUAL) as usize;
            let (_, &mut of_most, _) = all.select_nth_unstable_by(usual, f64::total_cmp);
            self.deviations = [of_most, all.iter().copied().fold(0.0, f64::max)];
        }
    }

    /// Fills cells without a point from the nearest coarser cells that have one (push-pull: Gortler et al., The
    /// Lumigraph, 1996).
    fn fill(&mut self) {
        self.filled = self.grid.heights.iter().filter(|height| height.is_nan()).count();
        let mut levels = vec![(self.grid.columns, self.grid.rows, self.grid.heights.clone())];
        while let Some((columns, rows, heights)) = levels.last()
            && heights.iter().any(|height| height.is_nan())
            && columns.max(rows) > &1
        {
            levels.push(halved(*columns, *rows, heights));
        }
        while let Some((columns, _, coarse)) = levels.pop() {
            let Some((finer_columns, _, finer)) = levels.last_mut() else {
                self.grid.heights = coarse;
                break;
            };
            for (at, height) in finer.iter_mut().enumerate().filter(|(_, height)| height.is_nan()) {
                *height = coarse[at / *finer_columns / 2 * columns + at % *finer_columns / 2];
            }
        }
    }

    /// The notes on the raster.
    pub(super) fn notes(&self, is_classified: bool) -> Vec<Message> {
        let cell = of_unit(self.grid.steps[0].x, "units of its map");
        let cells = self.grid.heights.len();
        let mut notes = Vec::new();
        if is_classified {
            let [usual, most] = self.deviations;
            notes.push(
                format!(
                    "is averaged over cells of {cell}; nine in ten of its ground points lie within \
                     {usual:.2} m of their cell's height, all within {most:.2} m"
                )
                .into(),
            );
        } else {
            notes.push(message![
                format!("has no points classified as ground, so the lowest point in each cell of {cell} is taken as ground");
                "classify its ground points, and export it again"
            ]);
        }
        if self.filled > 0 {
            let share = 100.0 * self.filled as f64 / cells as f64;
            notes.push(
                format!(
                    "has no ground points in {share:.0}% of these cells, such as below buildings; these have the heights of \
                     their neighbours"
                )
                .into(),
            );
        }
        notes
    }

    /// Makes blocks of a class's points, which the raster has: over each cell with such a point, from the ground up to the
    /// highest one.
    pub(super) fn blocks(&self, points: &[DVec3]) -> CellBlocks {
        let mut tops = vec![f64::NAN; self.grid.heights.len()];
        for &point in points {
            let cell = self.cell(point);
            tops[cell] = tops[cell].max(point.z);
        }
        let mut blocks = CellBlocks { positions: Vec::new(), triangles: Vec::new() };
        let (columns, rows) = (self.grid.columns as isize, self.grid.rows as isize);
        let ground = |cell: usize| f64::from(self.grid.heights[cell]);
        for (cell, &top) in tops.iter().enumerate().filter(|(cell, top)| **top > ground(*cell)) {
            let (column, row) = ((cell % self.grid.columns) as isize, (cell / self.grid.columns) as isize);
            let middle = self.grid.first + self.grid.steps[0] * column as f64 + self.grid.steps[1] * row as f64;
            let half = self.grid.steps[0].x / 2.0;
            let corner = |x: f64, y: f64| middle + DVec2::new(x, y) * half;
            let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
            blocks.quadrilateral(corners.map(|at| at.extend(top)));
            // south, east, north, west
            let neighbours = [(0, 1), (1, 0), (0, -1), (-1, 0)];
            for (side, (across, down)) in neighbours.into_iter().enumerate() {
                let (x, y) = (column + across, row + down);
                let is_inside = (0..columns).contains(&x) && (0..rows).contains(&y);
                let neighbour = is_inside.then(|| tops[(y * columns + x) as usize]).filter(|top| !top.is_nan());
                let foot = neighbour.unwrap_or_else(|| ground(cell)).max(ground(cell));
                if foot < top {
                    let [from, to] = [corners[side], corners[(side + 1) % 4]];
                    blocks.quadrilateral([from.extend(foot), to.extend(foot), to.extend(top), from.extend(top)]);
                }
            }
        }
        blocks
    }
}

impl CellBlocks {
    fn quadrilateral(&mut self, corners: [DVec3; 4]) {
        let first = self.positions.len() as u32;
        self.positions.extend(corners);
        self.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }
}

/// A raster of half the size, with the means of four cells.
fn halved(columns: usize, rows: usize, heights: &[f32]) -> (usize, usize, Vec<f32>) {
    let (half_columns, half_rows) = (columns.div_ceil(2), rows.div_ceil(2));
    let mean = |at: usize| {
        let (column, row) = (at % half_columns * 2, at / half_columns * 2);
        let four = [(0, 0), (1, 0), (0, 1), (1, 1)].into_iter().filter_map(|(across, down)| {
            let is_inside = column + across < columns && row + down < rows;
            is_inside.then(|| heights[(row + down) * columns + column + across]).filter(|height| !height.is_nan())
        });
        let (sum, count) = four.fold((0.0, 0.0), |(sum, count), height| (sum + height, count + 1.0));
        sum / count
    };
    (half_columns, half_rows, (0..half_columns * half_rows).map(mean).collect())
}

/// Rounds up to 1, 2 or 5 times a power of ten.
fn rounded_up(number: f64) -> f64 {
    let power = 10_f64.powf(number.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|step| step * power).find(|step| *step >= number).unwrap_or(number)
}
