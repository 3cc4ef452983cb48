//! From cells to the page's pixels: colours averaged by area, lines drawn where neighbouring cells part.

use super::scale::Rgb;
use rayon::prelude::*;
use std::ops::Range;

/// The colour of the lines; nearly black, so that it also reads on the scale's dark end.
const LINE: Rgb = [24, 27, 34];

/// How a border between two cells is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pen {
    /// Half the line's width, page pixels.
    pub radius: f32,
    /// 0 nothing to 1 the line's full colour.
    pub strength: f32,
}

impl Pen {
    /// Against the sky or the ground, and where heights jump.
    pub(super) const OUTLINE: Pen = Pen { radius: 2.0, strength: 0.9 };
    /// A step between parts of buildings.
    pub(super) const STEP: Pen = Pen { radius: 1.4, strength: 0.75 };
    /// Where two faces meet at an angle.
    pub(super) const CREASE: Pen = Pen { radius: 0.9, strength: 0.45 };
}

/// A picture in the page's pixels.
pub(super) struct Picture {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Row 0 first.
    pub pixels: Vec<Rgb>,
}

/// A raster of cells and the page pixels it is to fill.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fit {
    /// Columns and rows of cells.
    pub cells: (u32, u32),
    /// Columns and rows of pixels, at least 1.
    pub pixels: (u32, u32),
}

impl Fit {
    /// The largest picture of the raster's proportion within `room`.
    pub(super) fn within(cells: (u32, u32), room: (f64, f64)) -> Fit {
        let (columns, rows) = (f64::from(cells.0.max(1)), f64::from(cells.1.max(1)));
        let scale = (room.0 / columns).min(room.1 / rows);
        let pixels = |cells: f64| (cells * scale).round().max(1.0) as u32;
        Fit { cells, pixels: (pixels(columns), pixels(rows)) }
    }

    /// Page pixels a cell, across.
    pub(super) fn scale(&self) -> f64 {
        f64::from(self.pixels.0) / f64::from(self.cells.0.max(1))
    }
}

/// What lies between cells that are larger than pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Between {
    /// A border: a cell is one judgement, and the legend's colours stay exact.
    Sharp,
    /// A blend, as between a photograph's pixels.
    Smooth,
}

/// Pixel rows that one task draws.
const BAND: usize = 32;

/// Draws `colours`, one a cell, with the line that `pen` gives for each pair of neighbours (west, east or north, south).
pub(super) fn compose(
    fit: Fit,
    between: Between,
    colours: &[Rgb],
    pen: impl Fn(usize, usize) -> Option<Pen> + Sync,
) -> Picture {
    let (width, height) = (fit.pixels.0 as usize, fit.pixels.1 as usize);
    let columns = spans(fit.cells.0 as usize, width, between);
    let rows = spans(fit.cells.1 as usize, height, between);
    let mut pixels = vec![LINE; width * height];
    pixels.par_chunks_mut(BAND * width).enumerate().for_each_init(Vec::new, |ink, (band, chunk)| {
        let top = band * BAND;
        draw_lines(fit, top, chunk.len() / width, ink, &pen);
        for (row, line) in chunk.chunks_exact_mut(width).enumerate() {
            for (column, pixel) in line.iter_mut().enumerate() {
                let paper = average(fit, colours, &columns[column], &rows[top + row]);
                *pixel = blend(paper, ink[row * width + column]);
            }
        }
    });
    Picture { width: fit.pixels.0, height: fit.pixels.1, pixels }
}

/// The cells that a pixel covers along one axis: from, to (exclusive), and the shares of the first and the last.
pub(super) struct Span {
    pub cells: Range<usize>,
    first: f32,
    last: f32,
}

pub(super) fn spans(cells: usize, pixels: usize, between: Between) -> Vec<Span> {
    let scale = cells as f64 / pixels as f64;
    if between == Between::Smooth && scale < 1.0 {
        return (0..pixels).map(|pixel| blended(cells, (pixel as f64 + 0.5) * scale - 0.5)).collect();
    }
    (0..pixels)
        .map(|pixel| {
            let (from, to) = (pixel as f64 * scale, (pixel + 1) as f64 * scale);
            let start = (from as usize).min(cells - 1);
            // A sliver below a thousandth of a cell is rounding.
            let end = ((to - 1e-3).ceil().max(0.0) as usize).clamp(start + 1, cells);
            Span {
                cells: start..end,
                first: (((start + 1) as f64).min(to) - from) as f32,
                last: (to - ((end - 1) as f64).max(from)) as f32,
            }
        })
        .collect()
}

/// The two cells whose centres `at` lies between, each by its nearness.
fn blended(cells: usize, at: f64) -> Span {
    let at = at.clamp(0.0, (cells - 1) as f64);
    let start = at as usize;
    let last = (at - start as f64) as f32;
    Span { cells: start..(start + 2).min(cells), first: 1.0 - last, last }
}

impl Span {
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

fn average(fit: Fit, colours: &[Rgb], columns: &Span, rows: &Span) -> Rgb {
    let width = fit.cells.0 as usize;
    let first = colours[rows.cells.start * width + columns.cells.start];
    if columns.cells.len() == 1 && rows.cells.len() == 1 {
        return first;
    }
    // most of a picture is of one colour
    let at = |row: usize, column: usize| colours[row * width + column];
    let is_one = match (rows.cells.len(), columns.cells.len()) {
        (1 | 2, 1 | 2) => {
            let (south, east) = (rows.cells.end - 1, columns.cells.end - 1);
            at(rows.cells.start, east) == first && at(south, columns.cells.start) == first && at(south, east) == first
        }
        _ => rows.cells.clone().all(|row| columns.cells.clone().all(|column| at(row, column) == first)),
    };
    if is_one {
        return first;
    }
    let mut sum = [0.0_f32; 3];
    let mut total = 0.0;
    for row in rows.cells.clone() {
        for column in columns.cells.clone() {
            let weight = rows.weight(row) * columns.weight(column);
            let colour = colours[row * width + column];
            for (sum, part) in sum.iter_mut().zip(colour) {
                *sum += weight * f32::from(part);
            }
            total += weight;
        }
    }
    sum.map(|sum| (sum / total + 0.5) as u8)
}

fn blend(paper: Rgb, ink: f32) -> Rgb {
    if ink <= 0.0 {
        return paper;
    }
    std::array::from_fn(|i| (f32::from(paper[i]) + (f32::from(LINE[i]) - f32::from(paper[i])) * ink + 0.5) as u8)
}

/// The strength of the lines in pixel rows `top..top + rows`.
fn draw_lines(fit: Fit, top: usize, rows: usize, strength: &mut Vec<f32>, pen: &impl Fn(usize, usize) -> Option<Pen>) {
    let (cells_x, cells_y) = (fit.cells.0 as usize, fit.cells.1 as usize);
    let scale = [fit.pixels.0 as f32 / cells_x as f32, fit.pixels.1 as f32 / cells_y as f32];
    strength.clear();
    strength.resize(fit.pixels.0 as usize * rows, 0.0);
    let mut ink = Ink { width: fit.pixels.0 as usize, top: top as f32, rows, strength };
    // Lines reach over the band's edge by their radius.
    let reach = Pen::OUTLINE.radius + 1.0;
    let first = ((top as f32 - reach) / scale[1]).floor().max(1.0) as usize - 1;
    let last = (((top + rows) as f32 + reach) / scale[1]).ceil() as usize + 1;
    for row in first..last.min(cells_y) {
        let (north, south) = (row as f32 * scale[1], (row + 1) as f32 * scale[1]);
        for column in 0..cells_x {
            let cell = row * cells_x + column;
            let (west, east) = (column as f32 * scale[0], (column + 1) as f32 * scale[0]);
            if column + 1 < cells_x
                && let Some(pen) = pen(cell, cell + 1)
            {
                ink.stroke([east, north], [east, south], pen);
            }
            if row + 1 < cells_y
                && let Some(pen) = pen(cell, cell + cells_x)
            {
                ink.stroke([west, south], [east, south], pen);
            }
        }
    }
}

struct Ink<'a> {
    width: usize,
    top: f32,
    rows: usize,
    strength: &'a mut [f32],
}

impl Ink<'_> {
    /// A stroke with round ends, along one axis; where strokes overlap the stronger one counts.
    fn stroke(&mut self, from: [f32; 2], to: [f32; 2], pen: Pen) {
        let reach = pen.radius + 0.5;
        let low = |at: f32| (at - reach).floor().max(0.0) as usize;
        let high = |at: f32, most: usize| ((at + reach).ceil().max(0.0) as usize).min(most);
        for y in low(from[1] - self.top)..high(to[1] - self.top, self.rows) {
            let dy = outside(y as f32 + 0.5 + self.top, from[1], to[1]);
            for x in low(from[0])..high(to[0], self.width) {
                let dx = outside(x as f32 + 0.5, from[0], to[0]);
                let cover = (reach - (dx * dx + dy * dy).sqrt()).clamp(0.0, 1.0) * pen.strength;
                let ink = &mut self.strength[y * self.width + x];
                *ink = ink.max(cover);
            }
        }
    }
}

/// How far `at` lies outside of from..to.
fn outside(at: f32, from: f32, to: f32) -> f32 {
    (from - at).max(at - to).max(0.0)
}
