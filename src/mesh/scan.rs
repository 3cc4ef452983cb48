//! Which cells of a raster a triangle covers: scan conversion in double precision, a bit a cell.
//!
//! Places are in cells, such that centres are whole numbers. A cell is covered where its centre lies in a triangle or on
//! its edge. Two triangles that share an edge find the same columns along it, as an edge's are computed from its upper to
//! its lower end whichever way it is run.

use glam::DVec2;

/// One bit a cell, 64 a word.
pub struct Bits {
    /// Row after row, each of whole words.
    pub words: Vec<u64>,
    /// Words in a row.
    pub in_row: usize,
    width: i64,
    height: i64,
}

impl Bits {
    /// Nothing is covered.
    pub fn empty(width: u32, height: u32) -> Bits {
        let in_row = width.div_ceil(64) as usize;
        Bits { words: vec![0; in_row * height as usize], in_row, width: width.into(), height: height.into() }
    }

    /// Covered by either.
    pub fn or(mut self, other: Bits) -> Bits {
        self.words.iter_mut().zip(other.words).for_each(|(word, other)| *word |= other);
        self
    }

    /// Whether a cell is covered.
    pub fn get(&self, column: u32, row: u32) -> bool {
        self.words[row as usize * self.in_row + column as usize / 64] >> (column % 64) & 1 == 1
    }

    /// Covers all cells whose centres lie in a triangle or on its edge.
    pub fn cover(&mut self, mut corners: [DVec2; 3]) {
        corners.sort_unstable_by(|a, b| a.y.total_cmp(&b.y).then(a.x.total_cmp(&b.x)));
        let [top, middle, bottom] = corners;
        // beyond the raster, or where it is no number
        let first = top.y.ceil().max(0.0);
        let last = bottom.y.floor().min((self.height - 1) as f64);
        let (west, east) = (top.x.min(middle.x).min(bottom.x), top.x.max(middle.x).max(bottom.x));
        if !(first <= last && west.ceil().max(0.0) <= east.floor().min((self.width - 1) as f64)) {
            return;
        }
        let [long, upper, lower] =
            [Side::between(top, bottom), Side::between(top, middle), Side::between(middle, bottom)];
        for row in first as i64..=last as i64 {
            let y = row as f64;
            // at the middle's height both short sides end
            let [one, other] = match (y <= middle.y, y >= middle.y) {
                (true, true) => [upper.x_at(y), lower.x_at(y)],
                (true, false) => [upper.x_at(y); 2],
                _ => [lower.x_at(y); 2],
            };
            let along = long.x_at(y);
            self.cover_row(row, along.min(one).min(other), along.max(one).max(other));
        }
    }

    /// Covers the cells of a row whose centres lie from one place to another.
    fn cover_row(&mut self, row: i64, from: f64, to: f64) {
        let first = from.ceil().max(0.0) as i64;
        let last = to.floor().min((self.width - 1) as f64) as i64;
        if first > last {
            return;
        }
        let words = &mut self.words[row as usize * self.in_row..][..self.in_row];
        let (first, last) = (first as usize, last as usize);
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

/// A triangle's side, from its upper to its lower end.
pub struct Side {
    start: DVec2,
    end: DVec2,
    /// Columns a row; not used where the side is level.
    slope: f64,
}

impl Side {
    /// From the upper end to the lower.
    pub fn between(start: DVec2, end: DVec2) -> Side {
        Side { start, end, slope: (end.x - start.x) / (end.y - start.y) }
    }

    /// Its column at a row between its ends.
    pub fn x_at(&self, y: f64) -> f64 {
        if y >= self.end.y { self.end.x } else { self.start.x + (y - self.start.y) * self.slope }
    }
}
