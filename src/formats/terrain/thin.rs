//! Thins a raster of heights to as few triangles as possible within a given distance of all its samples.
//!
//! The method is right-triangulated irregular networks (Evans, Kirkpatrick and Townsend, 2001): squares of the raster
//! are split along their diagonal, and each right triangle is bisected from its right angle to the middle of its
//! hypotenuse, until it is close enough to the samples in it. Two triangles that share a hypotenuse are split together,
//! and a triangle is split if one of its halves is, so there are no cracks or T-junctions. The usual form of the method
//! tests only the middle of the hypotenuse; here each triangle is tested against all samples in it, so the given error
//! is a bound.

use super::grid::{HeightGrid, SQUARE};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};

/// How often the side of a square is halved until it is a cell.
const HALVINGS: usize = SQUARE.ilog2() as usize;
/// How often a square's triangles can be halved.
const DEPTH: usize = 2 * HALVINGS;
/// A sample that is not a corner.
const ABSENT: u32 = u32::MAX;

/// The result of thinning.
pub(super) struct ThinnedSheet {
    /// The vertices, in the file's coordinates.
    pub positions: Vec<DVec3>,
    /// The triangles, counter-clockwise seen from above.
    pub triangles: Vec<[u32; 3]>,
}

/// A sample's column and row.
type RasterSample = [usize; 2];

/// A right triangle: the ends of its hypotenuse, and its right-angled corner.
#[derive(Clone, Copy)]
struct RightTriangle {
    ends: [RasterSample; 2],
    apex: RasterSample,
}

impl RightTriangle {
    fn middle(&self) -> RasterSample {
        let [one, other] = self.ends;
        [(one[0] + other[0]) / 2, (one[1] + other[1]) / 2]
    }

    fn halves(&self) -> [RightTriangle; 2] {
        let middle = self.middle();
        [
            RightTriangle { ends: [self.apex, self.ends[0]], apex: middle },
            RightTriangle { ends: [self.ends[1], self.apex], apex: middle },
        ]
    }

    fn corners(&self) -> [RasterSample; 3] {
        [self.ends[0], self.ends[1], self.apex]
    }
}

/// The squares that cover a raster, and for each sample whether it splits the hypotenuse of triangles.
struct Squares<'a> {
    grid: &'a HeightGrid,
    /// The number of squares in a row, and in a column.
    count: [usize; 2],
    /// The number of samples in a row of all squares.
    width: usize,
    halves: Vec<AtomicBool>,
    error_m: f32,
}

/// Thins a raster: all samples are within `error_m` of the triangles.
pub(super) fn sheet(grid: &HeightGrid, error_m: f32) -> ThinnedSheet {
    let count = [grid.columns, grid.rows].map(|samples| samples.saturating_sub(1).div_ceil(SQUARE));
    let [width, height] = count.map(|squares| squares * SQUARE + 1);
    let halves = (0..width * height).into_par_iter().map(|_| AtomicBool::new(false)).collect();
    let squares = Squares { grid, count, width, halves, error_m };
    // the smallest first: a triangle is split if one of its halves is
    for depth in (0..DEPTH).rev() {
        squares.each_root().into_par_iter().for_each(|root| squares.judge(root, depth));
    }
    squares.sheet()
}

impl Squares<'_> {
    /// The two triangles of each square.
    fn each_root(&self) -> Vec<RightTriangle> {
        let [across, down] = self.count;
        let square = |at: usize| {
            let [west, north] = [at % across * SQUARE, at / across * SQUARE];
            let [east, south] = [west + SQUARE, north + SQUARE];
            [
                RightTriangle { ends: [[west, north], [east, south]], apex: [east, north] },
                RightTriangle { ends: [[east, south], [west, north]], apex: [west, south] },
            ]
        };
        (0..across * down).flat_map(square).collect()
    }

    fn is_halved(&self, [column, row]: RasterSample) -> bool {
        self.halves.get(row * self.width + column).is_some_and(|is_halved| is_halved.load(Ordering::Relaxed))
    }

    /// Tests the triangles below a root at a depth of `depth` bisections.
    fn judge(&self, triangle: RightTriangle, depth: usize) {
        if self.is_beyond(&triangle) {
            return;
        }
        if depth > 0 {
            return triangle.halves().into_iter().for_each(|half| self.judge(half, depth - 1));
        }
        // the halves of a square of two cells are cells, which are not split
        let [one, other] = triangle.ends;
        let has_halved = one[0].abs_diff(other[0]) + one[1].abs_diff(other[1]) > 2
            && triangle.halves().iter().any(|half| self.is_halved(half.middle()));
        let [column, row] = triangle.middle();
        if (has_halved || self.deviates(&triangle))
            && let Some(is_halved) = self.halves.get(row * self.width + column)
        {
            is_halved.store(true, Ordering::Relaxed);
        }
    }

    /// Whether no sample of the raster lies in a triangle.
    fn is_beyond(&self, triangle: &RightTriangle) -> bool {
        let first = |axis: usize| triangle.corners().iter().map(|corner| corner[axis]).min().unwrap_or(0);
        first(0) >= self.grid.columns || first(1) >= self.grid.rows
    }

    /// Whether a sample in a triangle is too far from its plane, or only some of its samples have a height.
    fn deviates(&self, triangle: &RightTriangle) -> bool {
        let [a, b, c] = triangle.corners();
        let [height_a, height_b, height_c] = [a, b, c].map(|[column, row]| self.grid.height(column, row));
        // the plane's slopes, from the two legs, each of which may be along either axis
        let at = |corner: RasterSample| {
            DVec2::new(corner[0] as f64, corner[1] as f64) - DVec2::new(c[0] as f64, c[1] as f64)
        };
        let (to_a, to_b) = (at(a), at(b));
        let [rise_a, rise_b] = [height_a, height_b].map(|height| f64::from(height) - f64::from(height_c));
        let slope = (to_a * rise_a / to_a.length_squared() + to_b * rise_b / to_b.length_squared()).as_vec2();
        let has_height = !height_c.is_nan();
        let rows =
            [a, b, c].iter().fold((usize::MAX, 0), |(low, high), corner| (low.min(corner[1]), high.max(corner[1])));
        for row in rows.0..=rows.1 {
            let (from, to) = columns_of(&[a, b, c], row);
            let start = height_c + slope.y * (row as f32 - c[1] as f32) - slope.x * c[0] as f32;
            for column in from..=to {
                let height = self.grid.height(column, row);
                let is_far = match has_height && !height.is_nan() {
                    // NaN: a corner has no height, so the triangle is split
                    true => {
                        let off = (start + slope.x * column as f32 - height).abs();
                        off.is_nan() || off > self.error_m
                    }
                    false => has_height == height.is_nan(),
                };
                if is_far {
                    return true;
                }
            }
        }
        false
    }

    fn sheet(&self) -> ThinnedSheet {
        let mut corners = Vec::new();
        for root in self.each_root() {
            self.gather(root, DEPTH, &mut corners);
        }
        let mut numbers = vec![ABSENT; self.halves.len()];
        let mut sheet = ThinnedSheet { positions: Vec::new(), triangles: Vec::with_capacity(corners.len()) };
        for triangle in corners {
            let mut numbered = triangle.map(|[column, row]| {
                let number = &mut numbers[row * self.width + column];
                if *number == ABSENT {
                    *number = sheet.positions.len() as u32;
                    sheet.positions.push(self.grid.point(column, row));
                }
                *number
            });
            if self.grid.is_mirrored() {
                numbered.swap(0, 1);
            }
            sheet.triangles.push(numbered);
        }
        sheet
    }

    /// Collects the triangles below one that are close enough or cannot be split, without those that have no height.
    fn gather(&self, triangle: RightTriangle, halvings: usize, found: &mut Vec<[RasterSample; 3]>) {
        if halvings > 0 && self.is_halved(triangle.middle()) {
            return triangle.halves().into_iter().for_each(|half| self.gather(half, halvings - 1, found));
        }
        let [a, b, c] = triangle.corners();
        if [a, b, c].iter().all(|&[column, row]| !self.grid.height(column, row).is_nan()) {
            found.push([a, c, b]);
        }
    }
}

/// The first and the last column of a row in a triangle whose sides are horizontal, vertical or at 45°.
fn columns_of(corners: &[RasterSample; 3], row: usize) -> (usize, usize) {
    let mut found = (usize::MAX, 0);
    for (one, other) in [(0, 1), (1, 2), (2, 0)] {
        let [one, other] = [corners[one], corners[other]];
        let (upper, lower) = if one[1] <= other[1] { (one, other) } else { (other, one) };
        if !(upper[1]..=lower[1]).contains(&row) {
            continue;
        }
        let along = row - upper[1];
        let each = match lower[1] - upper[1] {
            0 => [upper[0], lower[0]],
            _ if upper[0] < lower[0] => [upper[0] + along; 2],
            _ if upper[0] > lower[0] => [upper[0] - along; 2],
            _ => [upper[0]; 2],
        };
        each.into_iter().for_each(|column| found = (found.0.min(column), found.1.max(column)));
    }
    found
}
