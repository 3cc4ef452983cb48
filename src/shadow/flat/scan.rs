//! Silhouettes → rows of bits: each edge marks where it crosses the rows, and sums run along the rows.

use super::casters::{Casters, FaceSide, FallingEdge};
use crate::view::Bits;
use rayon::prelude::*;
use std::cell::RefCell;

/// A raster that is drawn band by band, so that what is summed stays in the processor's cache.
///
/// Where an edge crosses a row depends on the edge and the row alone, so that a part of a raster is drawn as the whole
/// is.
pub(super) struct Scan {
    bits: Bits,
    part: RasterPart,
    /// Per band where faces end in the plane: the same under every sun, except for whether it sees them.
    sections: Vec<Vec<(EdgeCrossing, FaceSide)>>,
    /// Per task and band which edges of the silhouette cross it. Kept, so that no sun allocates anything.
    crossings: Vec<Vec<Vec<EdgeCrossing>>>,
}

/// Where an edge crosses some rows of a band.
struct EdgeCrossing {
    /// In the first of them, counted from the bits' first column.
    at: Fixed,
    /// Columns a row.
    slope: Fixed,
    /// The first of them, counted in the band.
    first: u16,
    count: u16,
    /// What the sum changes by.
    change: i32,
}

/// Columns in steps of 2⁻³⁰: whole steps from row to row lead to the same place wherever they begin. After a million
/// rows that is off by less than half a thousandth of a column.
#[derive(Clone, Copy)]
struct Fixed(i64);

impl Fixed {
    const ONE_LOG: u32 = 30;
    /// Columns that are farther away need not be told apart: no plan has so many.
    const FARTHEST: f64 = (1_u64 << 32) as f64;

    fn new(columns: f64) -> Fixed {
        let steps = columns * (1_u64 << Self::ONE_LOG) as f64;
        // to the nearest one, without the library call that rounding is on some processors
        Fixed((steps + 0.5_f64.copysign(steps)) as i64)
    }

    /// Counted from another column.
    fn from(self, column: u32) -> Fixed {
        Fixed(self.0 - (i64::from(column) << Self::ONE_LOG))
    }

    /// So many rows further.
    fn after(self, rows: u32, slope: Fixed) -> Fixed {
        // beyond an edge's end it may be anywhere
        Fixed(self.0.wrapping_add(slope.0.wrapping_mul(i64::from(rows))))
    }

    /// The first whole column that is not before it, 0 for those before the first.
    fn column(self) -> usize {
        ((self.0 + (1 << Self::ONE_LOG) - 1) >> Self::ONE_LOG).max(0) as usize
    }
}

/// What a band's sums may take, bytes.
const BAND_BYTES: usize = 1 << 18;
/// The most rows of a band; they are counted in 16 bits.
const MOST_ROWS: usize = 1 << 10;

impl Scan {
    pub(super) fn new(casters: &Casters, first: [u32; 2], [width, height]: [u32; 2]) -> Scan {
        let rows = (BAND_BYTES / size_of::<i32>() / width.max(1) as usize).clamp(1, MOST_ROWS);
        let rows_log = rows.ilog2();
        let right = f64::from(first[0]) + f64::from(width) - 1.0;
        let part = RasterPart { first, right, end: first[1] + height, rows_log };
        let mut sections = Vec::new();
        sections.resize_with((height as usize).div_ceil(1 << rows_log), Vec::new);
        for (section, side) in casters.sections() {
            section.cross(&part, |band, crossing| sections[band].push((crossing, side)));
        }
        Scan { bits: Bits::new(width, height), part, sections, crossings: Vec::new() }
    }

    /// Which cells the silhouette's faces cover.
    pub(super) fn draw(&mut self, casters: &Casters) -> &mut Bits {
        self.cross(casters);
        let Scan { bits, part, sections, crossings } = self;
        let rows = 1 << part.rows_log;
        let in_row = bits.in_row();
        let width = bits.width as usize;
        bits.words.par_chunks_mut(rows * in_row).zip(sections).enumerate().for_each(|(band, (words, sections))| {
            SUMS.with_borrow_mut(|sums| {
                sums.fit(width, words.len() / in_row);
                for (crossing, side) in &*sections {
                    sums.mark(crossing, casters.sign(*side));
                }
                for crossings in crossings.iter().filter_map(|bands| bands.get(band)) {
                    crossings.iter().for_each(|crossing| sums.mark(crossing, 1));
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
        let Scan { part, sections, crossings, .. } = self;
        let bands = sections.len();
        crossings.resize_with(4 * rayon::current_num_threads(), Vec::new);
        let run = casters.edges().div_ceil(crossings.len()).max(1);
        crossings.par_iter_mut().enumerate().for_each(|(task, crossings)| {
            crossings.resize_with(bands, Vec::new);
            crossings.iter_mut().for_each(Vec::clear);
            let run = (task * run).min(casters.edges())..((task + 1) * run).min(casters.edges());
            casters.silhouette(run, |edge| edge.cross(part, |band, crossing| crossings[band].push(crossing)));
        });
    }
}

/// What of a raster is drawn.
struct RasterPart {
    first: [u32; 2],
    /// The last column, and the row beyond the last.
    right: f64,
    end: u32,
    /// A band has so many rows, as a power of two.
    rows_log: u32,
}

impl FallingEdge {
    /// Tells the bands that the edge crosses.
    fn cross(&self, part: &RasterPart, mut tell: impl FnMut(usize, EdgeCrossing)) {
        let RasterPart { first: [left, top], right, end, rows_log } = *part;
        let is_up = self.from.y > self.to.y;
        let ends = [self.from, self.to];
        let [upper, lower] = [ends[usize::from(is_up)], ends[usize::from(!is_up)]];
        let change = if is_up { -self.change } else { self.change };
        // an edge has the row of its upper end and not that of its lower end, so that edges that meet share none
        let begin = ceil(upper.y);
        let (start, end) = (begin.max(top), ceil(lower.y).min(end));
        if start >= end || upper.x.min(lower.x) > right {
            return;
        }
        let slope = (lower.x - upper.x) / (lower.y - upper.y);
        let column = |row: u32| upper.x + (f64::from(row) - upper.y) * slope;
        let mut tell_rows = |row: u32, count: u32, at: Fixed, slope: Fixed| {
            let row = row - top;
            let (band, first) = (row >> rows_log, row & ((1 << rows_log) - 1));
            tell(band as usize, EdgeCrossing { at, slope, first: first as u16, count: count as u16, change });
        };
        if upper.x.abs().max(lower.x.abs()) > Fixed::FARTHEST {
            for row in start..end {
                tell_rows(row, 1, Fixed::new(column(row).clamp(-1.0, Fixed::FARTHEST)).from(left), Fixed(0));
            }
            return;
        }
        let mut row = start;
        let slope = Fixed::new(slope);
        let mut at = Fixed::new(column(begin)).from(left).after(start - begin, slope);
        while row < end {
            let next = ((((row - top) >> rows_log) + 1) << rows_log) + top;
            let count = next.min(end) - row;
            tell_rows(row, count, at, slope);
            (row, at) = (row + count, at.after(count, slope));
        }
    }
}

/// The first whole number that is not below a number, from 0 to the largest one.
fn ceil(number: f64) -> u32 {
    // a library call on processors without an instruction for it
    let number = number.min(f64::from(u32::MAX));
    let whole = number as u32;
    whole + u32::from(f64::from(whole) < number)
}

thread_local! {
    static SUMS: RefCell<BandSums> = const { RefCell::new(BandSums { width: 0, in_row: 0, changes: Vec::new(), marked: Vec::new() }) };
}

/// What changes in the cells of a band. All is 0 between bands.
struct BandSums {
    width: usize,
    /// Words of a row.
    in_row: usize,
    /// Per cell by how much the sum changes there.
    changes: Vec<i32>,
    /// Per cell whether it does, one bit each.
    marked: Vec<u64>,
}

impl BandSums {
    fn fit(&mut self, width: usize, rows: usize) {
        self.width = width;
        self.in_row = width.div_ceil(64);
        self.changes.resize(rows * width, 0);
        self.marked.resize(rows * self.in_row, 0);
    }

    /// Changes sums where an edge crosses the rows, so many times as much as it says.
    fn mark(&mut self, crossing: &EdgeCrossing, times: i32) {
        let first = usize::from(crossing.first);
        let mut place = crossing.at;
        let change = crossing.change * times;
        for row in first..first + usize::from(crossing.count) {
            // what begins before the row's begin covers it from there, and beyond its end nothing changes
            let at = place.column();
            if at < self.width {
                self.changes[row * self.width + at] += change;
                self.marked[row * self.in_row + at / 64] |= 1 << (at % 64);
            }
            place = place.after(1, crossing.slope);
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
