//! From cells to the page's pixels: colours are averaged by area, and lines are drawn where neighbouring cells differ.

use super::scale::Rgb;
use crate::look::LOOK;
use rayon::prelude::*;
use std::ops::Range;

/// How a border between two cells is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pen {
    /// Half the line's width, page pixels.
    pub radius: f32,
    /// 0 nothing to 1 the line's full colour.
    pub strength: f32,
}

impl Pen {
    /// The pen against the sky or the ground, and where heights jump.
    pub(super) const OUTLINE: Pen = Pen { radius: 2.0, strength: LOOK.outline };
    /// The pen of a step between parts of buildings.
    pub(super) const STEP: Pen = Pen { radius: 1.4, strength: LOOK.step };
    /// The pen where buildings meet the ground, in a camera's picture.
    pub(super) const FOOT: Pen = Pen { radius: 1.2, strength: LOOK.foot };
    /// The pen where two faces meet at an angle.
    pub(super) const CREASE: Pen = Pen { radius: 0.9, strength: LOOK.crease };
}

/// A picture in the page's pixels, drawn some rows at a time, so that the whole sheet is never in memory.
pub(super) trait Pixels: Sync {
    /// Columns and rows.
    fn size(&self) -> (u32, u32);

    /// Draws the rows from `top` on, as many as `into` holds.
    fn draw(&self, top: usize, into: &mut [Rgb]);
}

/// A picture in memory.
pub(super) struct PagePicture {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Row 0 first.
    pub pixels: Vec<Rgb>,
}

impl Pixels for PagePicture {
    fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    fn draw(&self, top: usize, into: &mut [Rgb]) {
        let first = top * self.width as usize;
        into.copy_from_slice(&self.pixels[first..first + into.len()]);
    }
}

/// The size of a raster in cells and in page pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fit {
    /// Columns and rows of cells.
    pub cells: (u32, u32),
    /// Columns and rows of pixels, at least 1.
    pub pixels: (u32, u32),
}

impl Fit {
    /// The largest picture with the raster's proportion within `room`.
    pub(super) fn within(cells: (u32, u32), room: (f64, f64)) -> Fit {
        let (columns, rows) = (f64::from(cells.0.max(1)), f64::from(cells.1.max(1)));
        let scale = (room.0 / columns).min(room.1 / rows);
        let pixels = |cells: f64| (cells * scale).round().max(1.0) as u32;
        Fit { cells, pixels: (pixels(columns), pixels(rows)) }
    }

    /// The page pixels per cell, across.
    pub(super) fn scale(&self) -> f64 {
        f64::from(self.pixels.0) / f64::from(self.cells.0.max(1))
    }
}

/// How the border between cells that are larger than pixels is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CellBorder {
    /// A sharp border: each cell is one judgement, and the legend's colours stay exact.
    Sharp,
    /// A blend, as between the pixels of a photograph.
    Smooth,
}

/// The pixel rows of one task.
const BAND: usize = 64;
/// How many pixel rows above and below a task's rows can have lines that reach into them.
const REACH: usize = Pen::OUTLINE.radius as usize + 2;
/// The number of cells that a task reads at once.
const AT_ONCE: usize = 1 << 18;

/// Some rows of cells, ready to be drawn.
#[derive(Default)]
pub(super) struct Cells {
    /// Columns.
    width: usize,
    /// The colour of each cell, packed, so that equal ones are found quickly.
    colours: Vec<u32>,
    /// Borders on a cell's east side: row, column, pen.
    east: Vec<(u32, u32, Pen)>,
    /// Borders on the south side of neighbours in a row: row, first column, the column after the last, pen.
    south: Vec<(u32, u32, u32, Pen)>,
}

impl Cells {
    /// No cells yet; rows will have `width` columns.
    pub(super) fn new(width: u32) -> Cells {
        Cells { width: width as usize, ..Cells::default() }
    }

    /// Borders on a cell's east side: row, column, pen.
    pub(super) fn east(&self) -> &[(u32, u32, Pen)] {
        &self.east
    }

    /// Borders on the south side of neighbours in a row: row, first column, the column after the last, pen.
    pub(super) fn south(&self) -> &[(u32, u32, u32, Pen)] {
        &self.south
    }

    /// The cells' colours, along the rows.
    pub(super) fn paint(&mut self, colours: impl Iterator<Item = Rgb>) {
        self.colours.extend(colours.map(|[r, g, b]| u32::from_le_bytes([r, g, b, 0])));
    }

    /// As [`Cells::border`], but without lines between cells that have equal keys.
    pub(super) fn border_of(&mut self, keys: &[u32], pen: impl Fn(usize, usize) -> Option<Pen>) {
        /// The number of columns that are compared at once.
        const AT_ONCE: usize = 32;
        let width = self.width;
        let rows = keys.len() / width.max(1);
        for row in 0..rows {
            let of_row = &keys[row * width..(row + 1) * width];
            // the last row has no southern neighbours
            let below = if row + 1 < rows { &keys[(row + 1) * width..(row + 2) * width] } else { of_row };
            for from in (0..width).step_by(AT_ONCE) {
                let to = (from + AT_ONCE).min(width);
                let run = &of_row[from..to];
                let parts = |sum: u32, (one, other): (&u32, &u32)| sum | (one ^ other);
                let apart = run.iter().zip(&of_row[from + 1..]).fold(0, parts);
                if run.iter().zip(&below[from..to]).fold(apart, parts) == 0 {
                    continue;
                }
                for column in from..to {
                    self.ask(row, column, rows, |a, b| if keys[a] == keys[b] { None } else { pen(a, b) });
                }
            }
        }
    }

    /// Adds the borders between all neighbours in `rows` rows; `pen` gets the west and the east cell, or the north and
    /// the south cell.
    pub(super) fn border(&mut self, rows: usize, pen: impl Fn(usize, usize) -> Option<Pen>) {
        for row in 0..rows {
            for column in 0..self.width {
                self.ask(row, column, rows, &pen);
            }
        }
    }

    /// Adds the borders on a cell's east and south side.
    fn ask(&mut self, row: usize, column: usize, rows: usize, pen: impl Fn(usize, usize) -> Option<Pen>) {
        let cell = row * self.width + column;
        let (at, from) = (row as u32, column as u32);
        if column + 1 < self.width
            && let Some(pen) = pen(cell, cell + 1)
        {
            self.east.push((at, from, pen));
        }
        if row + 1 < rows
            && let Some(pen) = pen(cell, cell + self.width)
        {
            match self.south.last_mut() {
                // one stroke for all equal ones in a row
                Some((last, _, to, its)) if (*last, *to, *its) == (at, from, pen) => *to += 1,
                _ => self.south.push((at, from, from + 1, pen)),
            }
        }
    }
}

/// A raster of cells that is drawn on demand: `tell` fills in some rows of cells.
pub(super) struct LazyRaster<F> {
    fit: Fit,
    columns: Vec<CellSpan>,
    rows: Vec<CellSpan>,
    tell: F,
}

impl<F: Fn(Range<usize>, &mut Cells) + Sync> LazyRaster<F> {
    pub(super) fn new(fit: Fit, between: CellBorder, tell: F) -> LazyRaster<F> {
        let columns = spans(fit.cells.0 as usize, fit.pixels.0 as usize, between);
        let rows = spans(fit.cells.1 as usize, fit.pixels.1 as usize, between);
        LazyRaster { fit, columns, rows, tell }
    }

    /// The whole picture in memory.
    fn picture(&self) -> PagePicture {
        let (width, height) = self.fit.pixels;
        let mut pixels = vec![LOOK.line; width as usize * height as usize];
        pixels.par_chunks_mut(BAND * width as usize).enumerate().for_each(|(band, rows)| self.draw(band * BAND, rows));
        PagePicture { width, height, pixels }
    }

    /// The number of pixel rows whose cells are read at once, at least 1.
    fn at_once(fit: &Fit) -> usize {
        let rows = AT_ONCE / fit.cells.0.max(1) as usize;
        ((rows as f64 * f64::from(fit.pixels.1) / f64::from(fit.cells.1.max(1))) as usize).max(1)
    }
}

impl<F: Fn(Range<usize>, &mut Cells) + Sync> Pixels for LazyRaster<F> {
    fn size(&self) -> (u32, u32) {
        self.fit.pixels
    }

    fn draw(&self, top: usize, into: &mut [Rgb]) {
        let (width, height) = (self.fit.pixels.0 as usize, self.fit.pixels.1 as usize);
        let count = into.len() / width;
        let mut ink = Ink { width, top: top as f32, rows: count, strength: vec![0.0; width * count] };
        let (first, last) = (top.saturating_sub(REACH), (top + count + REACH).min(height));
        for from in (first..last).step_by(Self::at_once(&self.fit)) {
            let to = (from + Self::at_once(&self.fit)).min(last);
            // and the row below, for the borders to it
            let rows = self.rows[from].cells.start..(self.rows[to - 1].cells.end + 1).min(self.fit.cells.1 as usize);
            let mut cells = Cells::new(self.fit.cells.0);
            (self.tell)(rows.clone(), &mut cells);
            ink.lines(self.fit, rows.start, &cells);
            for row in from.max(top)..to.min(top + count) {
                self.paint(row, rows.start, &cells, &mut into[(row - top) * width..(row - top + 1) * width]);
            }
        }
        for (pixel, &ink) in into.iter_mut().zip(&ink.strength).filter(|(_, ink)| **ink > 0.0) {
            *pixel = blend(*pixel, ink);
        }
    }
}

impl<F> LazyRaster<F> {
    /// Draws a row of pixels without its lines; the first row of `cells` is `first`.
    fn paint(&self, row: usize, first: usize, cells: &Cells, line: &mut [Rgb]) {
        let span = &self.rows[row];
        let of_row = |row: usize| &cells.colours[(row - first) * cells.width..][..cells.width];
        if span.cells.len() <= 2 {
            let (north, south) = (of_row(span.cells.start), of_row(span.cells.end - 1));
            for (columns, pixel) in self.columns.iter().zip(line) {
                let (west, east) = (columns.cells.start, columns.cells.end - 1);
                let first = north[west];
                // most pixels cover cells of one colour
                let is_one = east - west < 2 && first == north[east] && first == south[west] && first == south[east];
                *pixel = if is_one { rgb(first) } else { average(of_row, columns, span) };
            }
        } else {
            for (columns, pixel) in self.columns.iter().zip(line) {
                *pixel = average(of_row, columns, span);
            }
        }
    }
}

/// The most memory that one task needs for its cells, bytes: what they see, their heights, hours and colours.
pub(super) fn task_bytes(fit: &Fit) -> u64 {
    let rows_a_pixel = f64::from(fit.cells.1) / f64::from(fit.pixels.1.max(1));
    let at_once = LazyRaster::<fn(Range<usize>, &mut Cells)>::at_once(fit).min(BAND + 2 * REACH);
    let rows = (at_once as f64 * rows_a_pixel).ceil() as u64 + 2;
    rows * u64::from(fit.cells.0) * 32
}

/// Draws `colours`, one per cell, with the line that `pen` returns for each pair of neighbours (west and east, or north
/// and south).
pub(super) fn compose(
    fit: Fit,
    between: CellBorder,
    colours: &[Rgb],
    pen: impl Fn(usize, usize) -> Option<Pen> + Sync,
) -> PagePicture {
    let width = fit.cells.0 as usize;
    let tell = |rows: Range<usize>, cells: &mut Cells| {
        let first = rows.start * width;
        cells.paint(colours[first..rows.end * width].iter().copied());
        cells.border(rows.len(), |a, b| pen(first + a, first + b));
    };
    LazyRaster::new(fit, between, tell).picture()
}

fn rgb(packed: u32) -> Rgb {
    let [r, g, b, _] = packed.to_le_bytes();
    [r, g, b]
}

/// The cells that a pixel covers along one axis, and how much of the first and of the last one it covers.
pub(super) struct CellSpan {
    pub cells: Range<usize>,
    first: f32,
    last: f32,
}

pub(super) fn spans(cells: usize, pixels: usize, between: CellBorder) -> Vec<CellSpan> {
    let scale = cells as f64 / pixels as f64;
    if between == CellBorder::Smooth && scale < 1.0 {
        return (0..pixels).map(|pixel| blended(cells, (pixel as f64 + 0.5) * scale - 0.5)).collect();
    }
    (0..pixels)
        .map(|pixel| {
            let (from, to) = (pixel as f64 * scale, (pixel + 1) as f64 * scale);
            let start = (from as usize).min(cells - 1);
            // Less than a thousandth of a cell is a rounding error.
            let end = ((to - 1e-3).ceil().max(0.0) as usize).clamp(start + 1, cells);
            CellSpan {
                cells: start..end,
                first: (((start + 1) as f64).min(to) - from) as f32,
                last: (to - ((end - 1) as f64).max(from)) as f32,
            }
        })
        .collect()
}

/// The two cells whose centres enclose `at`, each with its weight.
fn blended(cells: usize, at: f64) -> CellSpan {
    let at = at.clamp(0.0, (cells - 1) as f64);
    let start = at as usize;
    let last = (at - start as f64) as f32;
    CellSpan { cells: start..(start + 2).min(cells), first: 1.0 - last, last }
}

impl CellSpan {
    /// The share of a cell that the pixel covers.
    pub(super) fn weight(&self, cell: usize) -> f32 {
        if cell == self.cells.start {
            self.first
        } else if cell + 1 == self.cells.end {
            self.last
        } else {
            1.0
        }
    }
}

fn average<'a>(of_row: impl Fn(usize) -> &'a [u32], columns: &CellSpan, rows: &CellSpan) -> Rgb {
    let first = of_row(rows.cells.start)[columns.cells.start];
    if rows.cells.clone().all(|row| of_row(row)[columns.cells.clone()].iter().all(|colour| *colour == first)) {
        return rgb(first);
    }
    let mut sum = [0.0_f32; 3];
    let mut total = 0.0;
    for row in rows.cells.clone() {
        let colours = of_row(row);
        for column in columns.cells.clone() {
            let weight = rows.weight(row) * columns.weight(column);
            for (sum, part) in sum.iter_mut().zip(rgb(colours[column])) {
                *sum += weight * f32::from(part);
            }
            total += weight;
        }
    }
    sum.map(|sum| (sum / total + 0.5) as u8)
}

fn blend(paper: Rgb, ink: f32) -> Rgb {
    std::array::from_fn(|i| (f32::from(paper[i]) + (f32::from(LOOK.line[i]) - f32::from(paper[i])) * ink + 0.5) as u8)
}

/// The strength of the lines in some rows of pixels.
struct Ink {
    width: usize,
    top: f32,
    rows: usize,
    strength: Vec<f32>,
}

impl Ink {
    /// Draws the lines between cells; the first row of `cells` is `first`.
    fn lines(&mut self, fit: Fit, first: usize, cells: &Cells) {
        let scale = [fit.pixels.0 as f32 / fit.cells.0 as f32, fit.pixels.1 as f32 / fit.cells.1 as f32];
        let x = |column: u32| column as f32 * scale[0];
        let y = |row: u32| (first as u32 + row) as f32 * scale[1];
        for &(row, column, pen) in &cells.east {
            self.stroke([x(column + 1), y(row)], [x(column + 1), y(row + 1)], pen);
        }
        for &(row, from, to, pen) in &cells.south {
            self.stroke([x(from), y(row + 1)], [x(to), y(row + 1)], pen);
        }
    }

    /// Draws a stroke with round ends, along one axis. Where strokes overlap, the stronger one counts.
    fn stroke(&mut self, from: [f32; 2], to: [f32; 2], pen: Pen) {
        let reach = pen.radius + 0.5;
        // a cast, since floor and ceil are library calls on processors that have no instruction for them
        let low = |at: f32| (at - reach).max(0.0) as usize;
        let high = |at: f32, most: usize| {
            let at = (at + reach).max(0.0);
            (at as usize + usize::from(at as usize as f32 != at)).min(most)
        };
        let columns = low(from[0])..high(to[0], self.width);
        for y in low(from[1] - self.top)..high(to[1] - self.top, self.rows) {
            let dy = outside(y as f32 + 0.5 + self.top, from[1], to[1]);
            if columns.is_empty() || dy >= reach {
                continue;
            }
            let inks = &mut self.strength[y * self.width..][columns.clone()];
            for (x, ink) in columns.clone().zip(inks) {
                let dx = outside(x as f32 + 0.5, from[0], to[0]);
                let cover = (reach - (dx * dx + dy * dy).sqrt()).clamp(0.0, 1.0) * pen.strength;
                *ink = ink.max(cover);
            }
        }
    }
}

/// The distance of `at` from the range from..to.
fn outside(at: f32, from: f32, to: f32) -> f32 {
    (from - at).max(at - to).max(0.0)
}
