//! Finds the cells of a raster that a triangle covers: scan conversion in double precision, one bit per cell.
//!
//! Coordinates are in cells, and centres are whole numbers. A cell is covered if its centre lies in a triangle or on
//! its edge. Two triangles that share an edge compute the same columns along it, since an edge's columns are always
//! computed from its upper to its lower end.

use glam::DVec2;
use std::cmp::Ordering;
use std::ops::Range;

/// Calls `tell` for each row in a range that a triangle reaches, with the first and last column. The corners must be
/// sorted by rows, then columns ([`by_rows`]).
pub(crate) fn spans([top, middle, bottom]: [DVec2; 3], of: Range<usize>, mut tell: impl FnMut(usize, f64, f64)) {
    let [long, upper, lower] =
        [TriangleSide::between(top, bottom), TriangleSide::between(top, middle), TriangleSide::between(middle, bottom)];
    for row in wholes([top.y, bottom.y], of) {
        let y = row as f64;
        // at the middle corner's height both short sides end
        let [one, other] = match (y <= middle.y, y >= middle.y) {
            (true, true) => [upper.x_at(y), lower.x_at(y)],
            (true, false) => [upper.x_at(y); 2],
            _ => [lower.x_at(y); 2],
        };
        let along = long.x_at(y);
        tell(row, along.min(one).min(other), along.max(one).max(other));
    }
}

/// Orders corners by rows, then columns.
pub(crate) fn by_rows(one: DVec2, other: DVec2) -> Ordering {
    one.y.total_cmp(&other.y).then(one.x.total_cmp(&other.x))
}

/// The whole numbers from one position to another, both included; empty if one is NaN.
pub(crate) fn wholes([from, to]: [f64; 2], of: Range<usize>) -> Range<usize> {
    // casts turn negative numbers and NaN into 0; rounding would be a library call on some processors
    let first = from as usize;
    let first = first.saturating_add(usize::from((first as f64) < from));
    let end = if to >= 0.0 { (to as usize).saturating_add(1) } else { 0 };
    first.clamp(of.start, of.end)..end.clamp(of.start, of.end)
}

/// The covered cells: one bit per cell, 64 per word.
pub(crate) struct Coverage {
    /// Row by row, each in whole words.
    words: Vec<u64>,
    /// Words in a row.
    in_row: usize,
    width: usize,
    height: usize,
}

impl Coverage {
    /// No cell is covered.
    pub(crate) fn empty(width: u32, height: u32) -> Coverage {
        let in_row = width.div_ceil(64) as usize;
        let words = vec![0; in_row * height as usize];
        Coverage { words, in_row, width: width as usize, height: height as usize }
    }

    /// Whether a cell is covered.
    pub(crate) fn get(&self, column: u32, row: u32) -> bool {
        self.words[row as usize * self.in_row + column as usize / 64] >> (column % 64) & 1 == 1
    }

    /// The covered cells, row by row: column and row.
    pub(crate) fn cells(&self) -> impl Iterator<Item = (usize, usize)> {
        self.words.iter().enumerate().flat_map(|(at, &word)| {
            let (row, first) = (at / self.in_row, at % self.in_row * 64);
            let mut rest = word;
            std::iter::from_fn(move || {
                let bit = (rest != 0).then(|| rest.trailing_zeros())?;
                rest &= rest - 1;
                Some((first + bit as usize, row))
            })
        })
    }

    /// The number of covered cells.
    pub(crate) fn count(&self) -> usize {
        self.words.iter().map(|word| word.count_ones() as usize).sum()
    }

    /// Covers all cells whose centres lie in a triangle or on its edge.
    pub(crate) fn cover(&mut self, mut corners: [DVec2; 3]) {
        corners.sort_unstable_by(|one, other| by_rows(*one, *other));
        let height = self.height;
        spans(corners, 0..height, |row, from, to| self.cover_row(row, from, to));
    }

    /// Covers the cells of a row whose centres lie between two positions.
    fn cover_row(&mut self, row: usize, from: f64, to: f64) {
        let columns = wholes([from, to], 0..self.width);
        if columns.is_empty() {
            return;
        }
        let words = &mut self.words[row * self.in_row..][..self.in_row];
        let (first, last) = (columns.start, columns.end - 1);
        let (from_bit, to_bit) = (u64::MAX << (first % 64), u64::MAX >> (63 - last % 64));
        match (first / 64, last / 64) {
            (one, other) if one == other => words[one] |= from_bit & to_bit,
            (one, other) => {
                words[one] |= from_bit;
                words[one + 1..other].fill(u64::MAX);
                words[other] |= to_bit;
            }
        }
    }
}

/// A side of a triangle, from its upper to its lower end.
pub(crate) struct TriangleSide {
    start: DVec2,
    end: DVec2,
    /// Columns per row; unused if the side is horizontal.
    slope: f64,
}

impl TriangleSide {
    /// A side from its upper to its lower end.
    pub(crate) fn between(start: DVec2, end: DVec2) -> TriangleSide {
        TriangleSide { start, end, slope: (end.x - start.x) / (end.y - start.y) }
    }

    /// Its column at a row between its ends.
    pub(crate) fn x_at(&self, y: f64) -> f64 {
        if y >= self.end.y { self.end.x } else { self.start.x + (y - self.start.y) * self.slope }
    }
}
