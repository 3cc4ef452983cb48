//! A raster of heights → as few triangles as lie within a stated error of all its samples.
//!
//! Right-triangulated irregular networks (Evans, Kirkpatrick and Townsend, 2001): squares of the raster are halved along
//! their diagonal, and each right triangle again from its right angle to the middle of its longest side, until it lies close
//! enough to the samples in it. Two triangles that share a longest side share the decision to halve it, and what decides is
//! never less than what decides for the halves, so no crack opens and no corner hangs in a side. Unlike the common form of
//! it, which looks at the middle of the longest side alone, each triangle is held against all samples in it, so the error
//! that is asked is a bound.

use super::grid::HeightGrid;
use glam::DVec3;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, Ordering};

/// How often the side of a square is halved until it is a cell.
const HALVINGS: usize = 8;
/// Cells along the side of a square.
const SQUARE: usize = 1 << HALVINGS;
/// How often a square's triangles can be halved.
const DEPTH: usize = 2 * HALVINGS;
/// A sample that is no corner.
const ABSENT: u32 = u32::MAX;

/// What comes of a raster.
pub(super) struct Sheet {
    /// In the file's coordinates.
    pub positions: Vec<DVec3>,
    /// Counter-clockwise seen from above.
    pub triangles: Vec<[u32; 3]>,
}

/// A sample's column and row.
type Sample = [usize; 2];

/// A right triangle: the ends of its longest side, and its right angle.
#[derive(Clone, Copy)]
struct RightTriangle {
    ends: [Sample; 2],
    apex: Sample,
}

impl RightTriangle {
    fn middle(&self) -> Sample {
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

    fn corners(&self) -> [Sample; 3] {
        [self.ends[0], self.ends[1], self.apex]
    }
}

/// The squares that cover a raster, and per sample the error of the triangles whose longest side it halves.
struct Squares<'a> {
    grid: &'a HeightGrid,
    /// Squares in a row, and in a column.
    count: [usize; 2],
    /// Samples in a row of all squares.
    width: usize,
    /// Bits of a number that is not negative, whose order is that of the numbers.
    errors: Vec<AtomicU32>,
}

/// The triangles whose corners lie within `error_m` of a raster's samples, and all samples within that of them.
pub(super) fn sheet(grid: &HeightGrid, error_m: f32) -> Sheet {
    let count = [grid.columns, grid.rows].map(|samples| samples.saturating_sub(1).div_ceil(SQUARE));
    let [width, height] = count.map(|squares| squares * SQUARE + 1);
    let errors = (0..width * height).into_par_iter().map(|_| AtomicU32::new(0)).collect();
    let squares = Squares { grid, count, width, errors };
    // what decides for a triangle is known when that for its halves is: the smallest first
    for depth in (0..DEPTH).rev() {
        squares.each_root().into_par_iter().for_each(|root| squares.judge(root, depth));
    }
    squares.sheet(error_m)
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

    fn error(&self, [column, row]: Sample) -> f32 {
        self.errors.get(row * self.width + column).map_or(0.0, |bits| f32::from_bits(bits.load(Ordering::Relaxed)))
    }

    /// Judges the triangles below a root that have been halved `depth` times.
    fn judge(&self, triangle: RightTriangle, depth: usize) {
        if depth > 0 {
            return triangle.halves().into_iter().for_each(|half| self.judge(half, depth - 1));
        }
        let mut error = self.deviation(&triangle);
        let [column, row] = triangle.middle();
        // the halves of what has cells for halves are not halved
        let side = triangle.ends[0][0].abs_diff(triangle.ends[1][0]) + triangle.ends[0][1].abs_diff(triangle.ends[1][1]);
        if side > 2 {
            error = triangle.halves().iter().map(|half| self.error(half.middle())).fold(error, f32::max);
        }
        if let Some(bits) = self.errors.get(row * self.width + column) {
            bits.fetch_max(error.to_bits(), Ordering::Relaxed);
        }
    }

    /// How far the samples in a triangle lie from its plane at most; infinite where some of them have no height and some do.
    fn deviation(&self, triangle: &RightTriangle) -> f32 {
        let [a, b, c] = triangle.corners().map(|[column, row]| [column as i64, row as i64]);
        let area = cross(a, b, c);
        let heights = triangle.corners().map(|[column, row]| self.grid.height(column, row));
        let [low, high] = [0, 1].map(|axis| {
            let all = [a[axis], b[axis], c[axis]];
            (all.iter().copied().fold(i64::MAX, i64::min), all.iter().copied().fold(i64::MIN, i64::max))
        });
        let (mut most, mut with, mut without) = (0.0_f32, false, false);
        for row in low.1.min(high.0)..=high.1 {
            for column in low.0..=low.1 {
                let at = [column, row];
                let shares = [cross(b, c, at), cross(c, a, at), cross(a, b, at)];
                if shares.iter().any(|&share| share.signum() == -area.signum()) {
                    continue;
                }
                let height = self.grid.height(column as usize, row as usize);
                if height.is_nan() {
                    without = true;
                } else {
                    with = true;
                    let plane: f32 =
                        shares.iter().zip(heights).map(|(&share, height)| share as f32 / area as f32 * height).sum();
                    most = most.max((plane - height).abs());
                }
                if with && without {
                    return f32::INFINITY;
                }
            }
        }
        if with { most } else { 0.0 }
    }

    fn sheet(&self, error_m: f32) -> Sheet {
        let mut corners = Vec::new();
        for root in self.each_root() {
            self.gather(root, DEPTH, error_m, &mut corners);
        }
        let mut numbers = vec![ABSENT; self.errors.len()];
        let mut sheet = Sheet { positions: Vec::new(), triangles: Vec::with_capacity(corners.len()) };
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

    /// The triangles below one that are close enough, or cannot be halved; without those that have no height.
    fn gather(&self, triangle: RightTriangle, halvings: usize, error_m: f32, found: &mut Vec<[Sample; 3]>) {
        if halvings > 0 && self.error(triangle.middle()) > error_m {
            return triangle.halves().into_iter().for_each(|half| self.gather(half, halvings - 1, error_m, found));
        }
        let [a, b, c] = triangle.corners();
        if [a, b, c].iter().all(|&[column, row]| !self.grid.height(column, row).is_nan()) {
            found.push([a, c, b]);
        }
    }
}

/// Twice the area of a triangle of samples.
fn cross(a: [i64; 2], b: [i64; 2], c: [i64; 2]) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}
