//! Silhouettes → rows of bits: each edge marks where it crosses the rows, and sums run along the rows.

use super::casters::{Casters, FaceSide, FallingEdge};
use super::clumps::RasterBounds;
use crate::view::Bits;
use glam::DVec3;
use rayon::prelude::*;
use std::cell::RefCell;
use std::ops::Range;

/// A raster that is drawn band by band, so that what is summed stays in the processor's cache.
///
/// Where an edge crosses a row depends on the edge and the row alone, so that a part of a raster is drawn as the whole
/// is.
pub(super) struct Scan {
    bits: Bits,
    part: RasterPart,
    /// Per band where faces end in the plane: the same under every sun, except for whether it sees them.
    sections: Vec<Vec<(EdgeCrossing, FaceSide)>>,
    /// Per clump of the casters the rows, counted from the first, in which faces end before the first column.
    before: Vec<Vec<(Range<u32>, i32, FaceSide)>>,
    /// Per task which edges of the silhouette cross. Kept, so that no sun allocates anything.
    crossings: Vec<Crossings>,
    /// Per band whether all of it is in shadow. More casters change nothing there: a face never takes away from the sum.
    dark: Vec<bool>,
}

/// Where edges cross.
#[derive(Default)]
struct Crossings {
    /// Per band.
    bands: Vec<Vec<EdgeCrossing>>,
    /// Per row by how much the change before the first column differs from that of the row above.
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

    /// The first whole column that is not before it; it is not before the first.
    fn column(self) -> usize {
        ((self.0 + (1 << Self::ONE_LOG) - 1) >> Self::ONE_LOG) as usize
    }
}

/// What a band's sums may take, bytes.
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

    /// Finds which cells the silhouette's faces cover.
    pub(super) fn draw(&mut self, casters: &Casters) {
        self.dark.fill(false);
        self.draw_further(casters);
    }

    /// Whether anything is not in shadow.
    pub(super) fn is_lit(&self) -> bool {
        self.dark.contains(&false)
    }

    /// The same, of more casters under the same sun.
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

    /// As they were drawn last.
    pub(super) fn bits(&mut self) -> &mut Bits {
        &mut self.bits
    }

    /// How many rows the edges of the last silhouette crossed within the raster.
    #[cfg(feature = "test-hooks")]
    pub(super) fn rows_crossed(&self) -> u64 {
        let crossings = self.crossings.iter().flat_map(|crossings| crossings.bands.iter().flatten());
        crossings.map(|crossing| u64::from(crossing.count)).sum()
    }

    /// A box around the centres that are drawn.
    pub(super) fn bounds(&self) -> RasterBounds {
        let RasterPart { first: [left, top], width, end, .. } = self.part;
        let last = [f64::from(left) + f64::from(width) - 1.0, f64::from(end) - 1.0];
        let [low, high] = [[left, top].map(f64::from), last].map(|[column, row]| DVec3::new(column, row, 0.0));
        RasterBounds { low, high }
    }

    /// Sorts the silhouette by bands.
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

    /// Per row the sum before the first column.
    fn before(&mut self, casters: &Casters) -> Vec<i32> {
        let Scan { before, crossings, .. } = self;
        // the first run's takes all
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

/// What of a raster is drawn.
struct RasterPart {
    first: [u32; 2],
    width: u32,
    /// The row beyond the last.
    end: u32,
    /// A band has so many rows, as a power of two.
    rows_log: u32,
}

/// Rows that an edge crosses.
enum CrossedRows {
    /// Before the first column or in it, counted from the first row, and what the sum changes by.
    Before(Range<u32>, i32),
    /// Within the raster, and in which band.
    Within(usize, EdgeCrossing),
}

impl FallingEdge {
    /// Tells where the edge crosses the raster's rows, but for what lies beyond the last column.
    fn cross(&self, part: &RasterPart, mut tell: impl FnMut(CrossedRows)) {
        let RasterPart { first: [left, top], width, end, .. } = *part;
        let is_up = self.from.y > self.to.y;
        let ends = [self.from, self.to];
        let [upper, lower] = [ends[usize::from(is_up)], ends[usize::from(!is_up)]];
        let change = if is_up { -self.change } else { self.change };
        // an edge has the row of its upper end and not that of its lower end, so that edges that meet share none
        let begin = ceil(upper.y);
        let (start, end) = (begin.max(top), ceil(lower.y).min(end));
        if start >= end || upper.x.min(lower.x) > f64::from(left) + f64::from(width) - 1.0 {
            return;
        }
        let slope = (lower.x - upper.x) / (lower.y - upper.y);
        let column = |row: u32| upper.x + (f64::from(row) - upper.y) * slope;
        if upper.x.abs().max(lower.x.abs()) > Fixed::FARTHEST {
            for row in start..end {
                let at = Fixed::new(column(row).clamp(-1.0, Fixed::FARTHEST)).from(left);
                part.tell_rows((row - top..row - top + 1, at, Fixed(0)), change, &mut tell);
            }
            return;
        }
        let slope = Fixed::new(slope);
        let at = Fixed::new(column(begin)).from(left).after(start - begin, slope);
        part.tell_rows((start - top..end - top, at, slope), change, &mut tell);
    }
}

impl RasterPart {
    /// Tells of rows, counted from the first: `at` is where the first of them is crossed, `slope` how far the next one is.
    fn tell_rows(
        &self,
        (rows, mut at, slope): (Range<u32>, Fixed, Fixed),
        change: i32,
        tell: &mut impl FnMut(CrossedRows),
    ) {
        let last_column = i64::from(self.width - 1) << Fixed::ONE_LOG;
        let mut within = rows.clone();
        let ends = [at, at.after(rows.len() as u32 - 1, slope)].map(|Fixed(at)| at);
        if ends.iter().any(|&at| at <= 0 || at > last_column) {
            // rows go from one side to the other; the first ones that are not beyond a border
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
            let at = place.column();
            self.changes[row * self.width + at] += change;
            self.marked[row * self.in_row + at / 64] |= 1 << (at % 64);
            place = place.after(1, crossing.slope);
        }
    }

    /// Sums along the rows, which begin with what is before them, clears what was marked, and tells whether all is covered.
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
