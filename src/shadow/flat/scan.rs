//! Silhouettes → rows of bits: each edge marks where it crosses the rows, and sums run along them.

use super::casters::{Casters, Falling};
use crate::view::Bits;
use glam::DVec2;
use rayon::prelude::*;
use std::cell::RefCell;

/// A raster that is drawn band by band, so that what is summed stays in the processor's cache.
///
/// Where an edge crosses a row depends on the edge and the row alone, so that a part of a raster is drawn as the whole is.
pub(super) struct Scan {
    bits: Bits,
    /// The raster's column and row with which the bits begin.
    first: [u32; 2],
    /// Rows of a band.
    rows: usize,
    /// Per task and band which edges cross it. Kept, so that no sun allocates anything.
    crossings: Vec<Vec<Vec<Crossing>>>,
}

/// Where an edge crosses some rows of a band.
struct Crossing {
    /// Where the edge begins.
    upper: DVec2,
    /// Columns a row.
    slope: f64,
    /// The first of them, counted in the band.
    first: u16,
    count: u16,
    /// What the sum changes by.
    change: i32,
}

/// What a band's sums may take, bytes.
const BAND_BYTES: usize = 1 << 18;
/// The most rows of a band; they are counted in 16 bits.
const MOST_ROWS: usize = 1 << 10;

impl Scan {
    pub(super) fn new(first: [u32; 2], [width, height]: [u32; 2]) -> Scan {
        let rows = (BAND_BYTES / size_of::<i32>() / width.max(1) as usize).clamp(1, MOST_ROWS);
        Scan { bits: Bits::new(width, height), first, rows, crossings: Vec::new() }
    }

    /// Which cells the silhouette's faces cover.
    pub(super) fn draw(&mut self, casters: &Casters) -> &mut Bits {
        self.cross(casters);
        let Scan { bits, first, rows, crossings } = self;
        let in_row = bits.in_row();
        let width = bits.width as usize;
        bits.words.par_chunks_mut(*rows * in_row).enumerate().for_each(|(band, words)| {
            SUMS.with_borrow_mut(|sums| {
                let top = [first[0], first[1] + (band * *rows) as u32];
                sums.fit(top, width, words.len() / in_row);
                for crossings in crossings.iter().filter_map(|bands| bands.get(band)) {
                    crossings.iter().for_each(|crossing| sums.mark(crossing));
                }
                sums.run(words);
            });
        });
        bits
    }

    /// As they were drawn last.
    pub(super) fn bits(&mut self) -> &mut Bits {
        &mut self.bits
    }

    /// Sorts the silhouette by bands.
    fn cross(&mut self, casters: &Casters) {
        let [left, top] = self.first.map(f64::from);
        let right = left + f64::from(self.bits.width) - 1.0;
        let reach = [top, top + f64::from(self.bits.height)];
        let bands = (self.bits.height as usize).div_ceil(self.rows);
        let rows = self.rows;
        self.crossings.resize_with(4 * rayon::current_num_threads(), Vec::new);
        let run = casters.edges().div_ceil(self.crossings.len()).max(1);
        self.crossings.par_iter_mut().enumerate().for_each(|(task, crossings)| {
            crossings.resize_with(bands, Vec::new);
            crossings.iter_mut().for_each(Vec::clear);
            let run = (task * run).min(casters.edges())..((task + 1) * run).min(casters.edges());
            for edge in casters.silhouette(run) {
                edge.crossings(right, reach, rows, |band, crossing| crossings[band].push(crossing));
            }
        });
    }
}

impl Falling {
    /// Tells the bands that the edge crosses, of the rows from `first` to `end`; `right` is their last column.
    fn crossings(&self, right: f64, [first, end]: [f64; 2], rows: usize, mut tell: impl FnMut(usize, Crossing)) {
        let (upper, lower, change) = match self.from.y <= self.to.y {
            true => (self.from, self.to, self.change),
            false => (self.to, self.from, -self.change),
        };
        // an edge has the row of its upper end and not that of its lower end, so that edges that meet share none
        let [start, end] = [upper.y, lower.y].map(|row| ceil(row.max(first), end));
        if start >= end || upper.x.min(lower.x) > right {
            return;
        }
        let first = first as usize;
        let slope = (lower.x - upper.x) / (lower.y - upper.y);
        let (mut row, end) = (start - first, end - first);
        while row < end {
            let band = row / rows;
            let count = end.min((band + 1) * rows) - row;
            let crossing = Crossing { upper, slope, first: (row % rows) as u16, count: count as u16, change };
            tell(band, crossing);
            row += count;
        }
    }
}

/// The first whole number that is not below a number, from 0 up to `most`, itself one; 0 for what is no number.
fn ceil(number: f64, most: f64) -> usize {
    // a library call on processors without an instruction for it
    let within = number.max(0.0).min(most);
    let whole = within as u32;
    whole as usize + usize::from(f64::from(whole) < within)
}

thread_local! {
    static SUMS: RefCell<Sums> = const { RefCell::new(Sums { top: [0; 2], width: 0, in_row: 0, changes: Vec::new(), marked: Vec::new() }) };
}

/// What changes in the cells of a band. All is 0 between bands.
struct Sums {
    /// The raster's column and row with which the band begins.
    top: [u32; 2],
    width: usize,
    /// Words of a row.
    in_row: usize,
    /// Per cell by how much the sum changes there.
    changes: Vec<i32>,
    /// Per cell whether it does, one bit each.
    marked: Vec<u64>,
}

impl Sums {
    fn fit(&mut self, top: [u32; 2], width: usize, rows: usize) {
        (self.top, self.width) = (top, width);
        self.in_row = width.div_ceil(64);
        self.changes.resize(rows * width, 0);
        self.marked.resize(rows * self.in_row, 0);
    }

    fn mark(&mut self, crossing: &Crossing) {
        let [left, top] = self.top;
        let right = f64::from(left) + self.width as f64;
        let first = usize::from(crossing.first);
        for row in first..first + usize::from(crossing.count) {
            let down = (top as usize + row) as f64 - crossing.upper.y;
            // what begins before the row's begin covers it from there, and beyond its end nothing changes
            let at = ceil((crossing.upper.x + down * crossing.slope).max(f64::from(left)), right) - left as usize;
            if at < self.width {
                self.changes[row * self.width + at] += crossing.change;
                self.marked[row * self.in_row + at / 64] |= 1 << (at % 64);
            }
        }
    }

    /// Sums along the rows, and clears what was marked.
    fn run(&mut self, words: &mut [u64]) {
        let rows = words.chunks_exact_mut(self.in_row).zip(self.marked.chunks_exact_mut(self.in_row));
        for ((words, marked), changes) in rows.zip(self.changes.chunks_exact_mut(self.width)) {
            let mut sum = 0;
            for (at, (word, marked)) in words.iter_mut().zip(marked).enumerate() {
                let mut bits = if sum == 0 { 0 } else { u64::MAX };
                while *marked != 0 {
                    let bit = marked.trailing_zeros() as usize;
                    *marked &= *marked - 1;
                    let was = sum == 0;
                    sum += std::mem::take(&mut changes[at * 64 + bit]);
                    bits ^= if was == (sum == 0) { 0 } else { u64::MAX << bit };
                }
                *word = bits;
            }
            if let (Some(last), over @ 1..) = (words.last_mut(), self.width % 64) {
                *last &= (1 << over) - 1;
            }
        }
    }
}
