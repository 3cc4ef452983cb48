//! Fills rows of bits from a silhouette: edges mark where they cross rows, and sums run along the rows.

use super::casters::{Casters, FallingEdge};
use super::clumps::RasterBounds;
use super::edges::FaceSide;
use crate::view::Bits;
use glam::DVec3;
use rayon::prelude::*;
use std::cell::RefCell;
use std::ops::Range;

/// A raster that is drawn in bands, so that sums stay in the processor's cache.
///
/// The position where an edge crosses a row depends on the edge and the row alone, so a part of a raster is drawn
/// exactly as the whole is.
pub(super) struct Scan {
    bits: Bits,
    part: RasterPart,
    /// For each band, the sections with the plane. They are the same for every sun, except for their sign.
    sections: Vec<Vec<(EdgeCrossing, FaceSide)>>,
    /// For each clump of the casters, the rows (from the first) with a section before the first column.
    before: Vec<Vec<(Range<u32>, i32, FaceSide)>>,
    /// For each task, the crossings of the silhouette. Kept, so that no allocation is needed per sun.
    crossings: Vec<Crossings>,
    /// For each band, whether all of it is in shadow. More casters change nothing there, as faces only add to the sum.
    dark: Vec<bool>,
}

/// The crossings of edges.
#[derive(Default)]
struct Crossings {
    /// By band.
    bands: Vec<Vec<EdgeCrossing>>,
    /// For each row, the difference between its change before the first column and that of the row above.
    before: Vec<i32>,
}

impl Crossings {
    fn clear(&mut self, bands: usize, rows: usize) {
        self.bands.resize_with(bands, Vec::new);
        self.bands.iter_mut().for_each(Vec::clear);
        self.before.clear();
        self.before.resize(rows + 1, 0);
    }

    /// Changes the sum before the first column in some rows.
    fn change_before(&mut self, rows: Range<u32>, change: i32) {
        self.before[rows.start as usize] += change;
        self.before[rows.end as usize] -= change;
    }
}

/// The crossings of an edge with consecutive rows of a band.
struct EdgeCrossing {
    /// The position in the first row, from the bits' first column.
    at: FixedColumn,
    /// Columns per row.
    slope: FixedColumn,
    /// The first row, within the band.
    first: u16,
    count: u16,
    /// The change of the sum.
    change: i32,
}

/// A column in steps of 2⁻³⁰: integer steps from row to row give the same position wherever they begin. After a million
/// rows the error is below half a thousandth of a column.
#[derive(Clone, Copy)]
struct FixedColumn(i64);

impl FixedColumn {
    const ONE_LOG: u32 = 30;
    /// Columns beyond this need not be distinguished: no plan has that many.
    const FARTHEST: f64 = (1_u64 << 32) as f64;

    fn new(columns: f64) -> FixedColumn {
        let steps = columns * (1_u64 << Self::ONE_LOG) as f64;
        // rounds to nearest without the library call that some processors need
        FixedColumn((steps + 0.5_f64.copysign(steps)) as i64)
    }

    /// The same relative to another column.
    fn from(self, column: u32) -> FixedColumn {
        FixedColumn(self.0 - (i64::from(column) << Self::ONE_LOG))
    }

    /// The position some rows later.
    fn after(self, rows: u32, slope: FixedColumn) -> FixedColumn {
        // beyond an edge's end the value is unused
        FixedColumn(self.0.wrapping_add(slope.0.wrapping_mul(i64::from(rows))))
    }

    /// The first whole column at or after it, at least 0.
    fn column(self) -> usize {
        ((self.0 + (1 << Self::ONE_LOG) - 1) >> Self::ONE_LOG) as usize
    }
}

/// The memory for a band's sums, bytes.
const BAND_BYTES: usize = 1 << 18;
/// The most rows of a band; they are counted in 16 bits.
const MOST_ROWS: usize = 1 << 10;

impl Scan {
    pub(super) fn new(casters: &Casters, first: [u32; 2], [width, height]: [u32; 2]) -> Scan {
        let rows = (BAND_BYTES / size_of::<i32>() / width.max(1) as usize).clamp(1, MOST_ROWS);
        let part = RasterPart { first, width, end: first[1] + height, rows_log: rows.ilog2() };
        let mut sections = Vec::new();
        sections.resize_with((height as usize).div_ceil(1 << part.rows_log), Vec::new);
        let mut before = Vec::new();
        before.resize_with(casters.clumps(), Vec::new);
        for (edge, section) in casters.sections() {
            edge.cross(&part, |place| match place {
                CrossedRows::Before(rows, change) => {
                    before[section.clump as usize].push((rows, change, section.side));
                }
                CrossedRows::Within(band, crossing) => sections[band].push((crossing, section.side)),
            });
        }
        let dark = vec![false; sections.len()];
        Scan { bits: Bits::new(width, height), part, sections, before, crossings: Vec::new(), dark }
    }

    /// Draws the cells that the faces of the silhouette cover.
    pub(super) fn draw(&mut self, casters: &Casters) {
        self.dark.fill(false);
        self.draw_further(casters);
    }

    /// Whether any cell is not in shadow.
    pub(super) fn is_lit(&self) -> bool {
        self.dark.contains(&false)
    }

    /// Adds more casters under the same sun.
    pub(super) fn draw_further(&mut self, casters: &Casters) {
        self.cross(casters);
        let before = self.before(casters);
        let Scan { bits, part, sections, crossings, dark, .. } = self;
        let rows = 1 << part.rows_log;
        let in_row = bits.in_row();
        let width = bits.width as usize;
        let bands = bits.words.par_chunks_mut(rows * in_row).zip(before.par_chunks(rows)).zip(sections).zip(dark);
        bands.enumerate().filter(|(_, (_, dark))| !**dark).for_each(|(band, (((words, before), sections), dark))| {
            SUMS.with_borrow_mut(|sums| {
                sums.fit(width, words.len() / in_row);
                for (crossing, side) in &*sections {
                    sums.mark(crossing, casters.sign(*side));
                }
                for crossings in crossings.iter().filter_map(|crossings| crossings.bands.get(band)) {
                    crossings.iter().for_each(|crossing| sums.mark(crossing, 1));
                }
                *dark = sums.run(words, before);
            });
        });
    }

    /// The last result.
    pub(super) fn bits(&mut self) -> &mut Bits {
        &mut self.bits
    }

    /// The number of rows that the edges of the last silhouette crossed within the raster.
    #[cfg(feature = "test-hooks")]
    pub(super) fn rows_crossed(&self) -> u64 {
        let crossings = self.crossings.iter().flat_map(|crossings| crossings.bands.iter().flatten());
        crossings.map(|crossing| u64::from(crossing.count)).sum()
    }

    /// A box around the centres of the drawn cells.
    pub(super) fn bounds(&self) -> RasterBounds {
        let RasterPart { first: [left, top], width, end, .. } = self.part;
        let last = [f64::from(left) + f64::from(width) - 1.0, f64::from(end) - 1.0];
        let [low, high] = [[left, top].map(f64::from), last].map(|[column, row]| DVec3::new(column, row, 0.0));
        RasterBounds { low, high }
    }

    /// Sorts the silhouette into bands.
    fn cross(&mut self, casters: &Casters) {
        let Scan { part, sections, crossings, bits, dark, .. } = self;
        let (bands, rows) = (sections.len(), bits.height as usize);
        crossings.resize_with(4 * rayon::current_num_threads(), Crossings::default);
        let runs = casters.runs(crossings.len());
        crossings.par_iter_mut().zip(runs).for_each(|(crossings, runs)| {
            crossings.clear(bands, rows);
            for run in runs {
                casters.silhouette(run, |edge| {
                    edge.cross(part, |place| match place {
                        CrossedRows::Before(rows, change) => crossings.change_before(rows, change),
                        CrossedRows::Within(band, crossing) if !dark[band] => crossings.bands[band].push(crossing),
                        CrossedRows::Within(..) => {}
                    });
                });
            }
        });
    }

    /// For each row, the sum before the first column.
    fn before(&mut self, casters: &Casters) -> Vec<i32> {
        let Scan { before, crossings, .. } = self;
        // sums all tasks into the first
        let Some((all, others)) = crossings.split_first_mut() else { return Vec::new() };
        for &clump in casters.reaching() {
            for (rows, change, side) in &before[clump as usize] {
                all.change_before(rows.clone(), change * casters.sign(*side));
            }
        }
        for other in others {
            all.before.iter_mut().zip(&other.before).for_each(|(all, other)| *all += other);
        }
        let mut sum = 0;
        let sums = all.before.iter().map(|change| {
            sum += change;
            sum
        });
        sums.collect()
    }
}

/// The drawn part of a raster.
struct RasterPart {
    first: [u32; 2],
    width: u32,
    /// The end of the rows.
    end: u32,
    /// The rows of a band, as a power of two.
    rows_log: u32,
}

/// Rows that an edge crosses.
enum CrossedRows {
    /// At or before the first column: the rows (from the first), and the change of the sum.
    Before(Range<u32>, i32),
    /// Within the raster: the band, and the crossing.
    Within(usize, EdgeCrossing),
}

impl FallingEdge {
    /// Calls `tell` with the edge's crossings of the raster's rows, except beyond the last column.
    fn cross(&self, part: &RasterPart, mut tell: impl FnMut(CrossedRows)) {
        let RasterPart { first: [left, top], width, end, .. } = *part;
        let is_up = self.from.y > self.to.y;
        let ends = [self.from, self.to];
        let [upper, lower] = [ends[usize::from(is_up)], ends[usize::from(!is_up)]];
        let change = if is_up { -self.change } else { self.change };
        // an edge has its upper end's row but not its lower end's, so edges that meet share no row
        let begin = ceil(upper.y);
        let (start, end) = (begin.max(top), ceil(lower.y).min(end));
        if start >= end || upper.x.min(lower.x) > f64::from(left) + f64::from(width) - 1.0 {
            return;
        }
        let slope = (lower.x - upper.x) / (lower.y - upper.y);
        let column = |row: u32| upper.x + (f64::from(row) - upper.y) * slope;
        if upper.x.abs().max(lower.x.abs()) > FixedColumn::FARTHEST {
            for row in start..end {
                let at = FixedColumn::new(column(row).clamp(-1.0, FixedColumn::FARTHEST)).from(left);
                part.tell_rows((row - top..row - top + 1, at, FixedColumn(0)), change, &mut tell);
            }
            return;
        }
        let slope = FixedColumn::new(slope);
        let at = FixedColumn::new(column(begin)).from(left).after(start - begin, slope);
        part.tell_rows((start - top..end - top, at, slope), change, &mut tell);
    }
}

impl RasterPart {
    /// Calls `tell` for some rows, from the first: `at` is the crossing of the first of them, `slope` the step to the
    /// next.
    fn tell_rows(
        &self,
        (rows, mut at, slope): (Range<u32>, FixedColumn, FixedColumn),
        change: i32,
        tell: &mut impl FnMut(CrossedRows),
    ) {
        let last_column = i64::from(self.width - 1) << FixedColumn::ONE_LOG;
        let mut within = rows.clone();
        let ends = [at, at.after(rows.len() as u32 - 1, slope)].map(|FixedColumn(at)| at);
        if ends.iter().any(|&at| at <= 0 || at > last_column) {
            // the crossings move from one side to the other; the first rows that are not beyond a border
            let until = |border: i64| {
                let [to_go, step] = if slope.0 >= 0 {
                    [border.saturating_sub(at.0), slope.0]
                } else {
                    [at.0.saturating_sub(border + 1), slope.0.saturating_neg()]
                };
                let count = if to_go < 0 {
                    0
                } else {
                    to_go.checked_div(step).map_or(i64::MAX, |steps| steps.saturating_add(1))
                };
                rows.start + count.min(rows.len() as i64) as u32
            };
            let borders = [until(0), until(last_column)];
            let before = if slope.0 >= 0 { rows.start..borders[0] } else { borders[0]..rows.end };
            within = if slope.0 >= 0 { borders[0]..borders[1] } else { borders[1]..borders[0] };
            if !before.is_empty() {
                tell(CrossedRows::Before(before, change));
            }
        }
        at = at.after(within.start - rows.start, slope);
        let mut row = within.start;
        while row < within.end {
            let (band, first) = (row >> self.rows_log, row & ((1 << self.rows_log) - 1));
            let count = (((band + 1) << self.rows_log).min(within.end)) - row;
            let crossing = EdgeCrossing { at, slope, first: first as u16, count: count as u16, change };
            tell(CrossedRows::Within(band as usize, crossing));
            (row, at) = (row + count, at.after(count, slope));
        }
    }
}

/// The first whole number at or above a number, limited to 32 bits.
fn ceil(number: f64) -> u32 {
    // `ceil` is a library call on some processors
    let number = number.min(f64::from(u32::MAX));
    let whole = number as u32;
    whole + u32::from(f64::from(whole) < number)
}

thread_local! {
    static SUMS: RefCell<BandSums> = const { RefCell::new(BandSums { width: 0, in_row: 0, changes: Vec::new(), marked: Vec::new() }) };
}

/// The changes in the cells of a band. All are 0 between bands.
struct BandSums {
    width: usize,
    /// The words in a row.
    in_row: usize,
    /// For each cell, the change of the sum there.
    changes: Vec<i32>,
    /// For each cell, whether there is a change, one bit each.
    marked: Vec<u64>,
}

impl BandSums {
    fn fit(&mut self, width: usize, rows: usize) {
        self.width = width;
        self.in_row = width.div_ceil(64);
        self.changes.resize(rows * width, 0);
        self.marked.resize(rows * self.in_row, 0);
    }

    /// Adds an edge's change, times a factor, at its crossings.
    fn mark(&mut self, crossing: &EdgeCrossing, times: i32) {
        let first = usize::from(crossing.first);
        let mut place = crossing.at;
        let change = crossing.change * times;
        for row in first..first + usize::from(crossing.count) {
            let at = place.column();
            self.changes[row * self.width + at] += change;
            self.marked[row * self.in_row + at / 64] |= 1 << (at % 64);
            place = place.after(1, crossing.slope);
        }
    }

    /// Sums along the rows, from the sums before them, and clears the marks. Returns whether all cells are covered.
    fn run(&mut self, words: &mut [u64], before: &[i32]) -> bool {
        let mut is_dark = true;
        let rows = words.chunks_exact_mut(self.in_row).zip(self.marked.chunks_exact_mut(self.in_row));
        for (((words, marked), changes), before) in rows.zip(self.changes.chunks_exact_mut(self.width)).zip(before) {
            let mut sum = *before;
            let last = self.in_row - 1;
            for (at, (word, marked)) in words.iter_mut().zip(marked).enumerate() {
                let mut bits = if sum == 0 { 0 } else { u64::MAX };
                while *marked != 0 {
                    let bit = marked.trailing_zeros() as usize;
                    *marked &= *marked - 1;
                    let was = sum == 0;
                    sum += std::mem::take(&mut changes[at * 64 + bit]);
                    bits ^= if was == (sum == 0) { 0 } else { u64::MAX << bit };
                }
                let all = if at == last { u64::MAX >> (63 - (self.width - 1) % 64) } else { u64::MAX };
                *word = bits & all;
                is_dark &= *word == all;
            }
        }
        is_dark
    }
}
