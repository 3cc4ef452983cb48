//! Line drawings: a plan of lines, flat colours and text, as one SVG. Its PNG is rendered from that SVG.
//!
//! Coordinates are pixels of the page from the picture's north-west corner, except for those of contours, which are
//! cells.

mod base;
mod heights;
mod hours;
mod labels;
mod outlines;
mod sky;

pub use heights::heights;
pub use hours::iso_hours;
pub use outlines::{MOST_OUTLINES, Outline, outlines};
pub use sky::{SkyContext, card_picture, sky_card, sky_colours, sky_pictures, sky_sheet};

use super::Panel;
use super::page::{self, Sheet};
use super::picture::Fit;
use super::scale::Rgb;
use super::svg::{Block, hex};
use crate::contour::Contour;
use crate::export::ExportError;
use std::fmt::Write;

/// A line drawing on its sheet.
pub struct LineDrawing(Block);

impl LineDrawing {
    /// Lays out the sheet; `draw` makes the picture once its size is known.
    fn new(panel: &Panel, cells: (u32, u32), cell_m: f64, draw: impl FnOnce(Fit) -> Block) -> LineDrawing {
        LineDrawing(page::whole(panel, cells, cell_m, draw))
    }

    /// The drawing as SVG, of the sheet's size on paper. Text stays text.
    pub fn svg(&self) -> String {
        page::svg(&self.0)
    }

    /// The drawing as PNG, of the size that all drawings have.
    ///
    /// # Errors
    /// [`ExportError::Encode`] if the sheet cannot be drawn or encoded.
    pub fn png(&self) -> Result<Vec<u8>, ExportError> {
        page::png(&Sheet::of(&self.0)?)
    }
}

/// Converts cells to page pixels.
#[derive(Clone, Copy)]
struct Scale([f64; 2]);

impl Scale {
    fn of(fit: Fit) -> Scale {
        let scale = |pixels: u32, cells: u32| f64::from(pixels) / f64::from(cells.max(1));
        Scale([scale(fit.pixels.0, fit.cells.0), scale(fit.pixels.1, fit.cells.1)])
    }

    fn point(self, [column, row]: [f64; 2]) -> [f64; 2] {
        [column * self.0[0], row * self.0[1]]
    }

    /// The drawn parts of contours, as lines.
    fn lines(self, contours: &[Contour]) -> LineGroup {
        /// The area up to which a contour counts as small, square pixels.
        const SMALL: f64 = 3000.0;
        let mut lines = LineGroup::default();
        for contour in contours {
            let is_small = contour.area().abs() * self.0[0] * self.0[1] < SMALL;
            let to = if is_small { &mut lines.small } else { &mut lines.large };
            let to_page = |line: Vec<[f64; 2]>| line.into_iter().map(|point| self.point(point)).collect();
            to.extend(contour.lines().into_iter().map(to_page));
        }
        lines.large.sort_by(|a: &Line, b| length(b).total_cmp(&length(a)));
        lines
    }

    /// The areas within contours, as a path's data.
    fn areas(self, contours: &[Contour]) -> String {
        let mut data = String::new();
        for contour in contours {
            line(&mut data, contour.points.iter().map(|point| self.point(*point)));
            data.push('Z');
        }
        data
    }
}

/// A line in page pixels.
type Line = Vec<[f64; 2]>;

/// Lines of one kind.
#[derive(Default)]
struct LineGroup {
    /// The longest first.
    large: Vec<Line>,
    /// Lines around areas that are so small that a full line would hide them.
    small: Vec<Line>,
}

impl LineGroup {
    fn all(&self) -> impl Iterator<Item = &Line> {
        self.large.iter().chain(&self.small)
    }

    fn draw(&self, block: &mut Block, width: f64, colour: Rgb, title: &str) {
        const OF_SMALL: f64 = 0.45;
        stroke(block, &paths(&self.large), width, colour, title);
        stroke(block, &paths(&self.small), width * OF_SMALL, colour, title);
    }
}

fn length(line: &[[f64; 2]]) -> f64 {
    line.windows(2).map(|ends| distance(ends[0], ends[1])).sum()
}

fn distance([ax, ay]: [f64; 2], [bx, by]: [f64; 2]) -> f64 {
    (bx - ax).hypot(by - ay)
}

/// Appends a line to a path's data. A line that ends where it begins is closed.
fn line(data: &mut String, points: impl Iterator<Item = [f64; 2]>) {
    for (at, [x, y]) in points.enumerate() {
        // Writing to a String cannot fail.
        let _ = write!(data, "{}{} {}", if at == 0 { 'M' } else { 'L' }, SvgNumber(x), SvgNumber(y));
    }
}

fn paths(lines: &[Line]) -> String {
    let mut data = String::new();
    for points in lines {
        line(&mut data, points.iter().copied());
        if points.first() == points.last() {
            data.push('Z');
        }
    }
    data
}

/// A number to a hundredth of a pixel, without trailing zeros.
struct SvgNumber(f64);

impl std::fmt::Display for SvgNumber {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let hundredths = (self.0 * 100.0).round() as i64;
        let sign = if hundredths < 0 { "-" } else { "" };
        let (whole, part) = (hundredths.abs() / 100, hundredths.abs() % 100);
        match part {
            0 => write!(to, "{sign}{whole}"),
            part if part % 10 == 0 => write!(to, "{sign}{whole}.{}", part / 10),
            part => write!(to, "{sign}{whole}.{part:02}"),
        }
    }
}

/// A named group of the SVG, which drawing programs show as a layer.
fn group(block: &mut Block, name: &str, what: impl FnOnce(&mut Block)) {
    let mut group = Block::default();
    what(&mut group);
    if !group.svg.is_empty() {
        block.push(format_args!("<g id=\"{name}\">{}</g>", group.svg));
    }
}

/// The same, with what lies beyond an outline cut off.
fn group_within(block: &mut Block, name: &str, outline: &str, what: impl FnOnce(&mut Block)) {
    let mut group = Block::default();
    what(&mut group);
    if !group.svg.is_empty() {
        block.push(format_args!(
            "<clipPath id=\"within-{name}\"><path d=\"{outline}\" clip-rule=\"evenodd\"/></clipPath>\
             <g id=\"{name}\" clip-path=\"url(#within-{name})\">{}</g>",
            group.svg
        ));
    }
}

/// Fills contours with a flat colour.
fn fill(block: &mut Block, data: &str, colour: Rgb, opacity: f64) {
    if data.is_empty() {
        return;
    }
    let colour = hex(colour);
    if opacity < 1.0 {
        block.push(format_args!(
            "<path d=\"{data}\" fill=\"{colour}\" fill-opacity=\"{opacity:.3}\" fill-rule=\"evenodd\"/>"
        ));
    } else {
        block.push(format_args!("<path d=\"{data}\" fill=\"{colour}\" fill-rule=\"evenodd\"/>"));
    }
}

/// Draws lines of one width and colour, with a `title` that describes them.
fn stroke(block: &mut Block, data: &str, width: f64, colour: Rgb, title: &str) {
    if data.is_empty() {
        return;
    }
    let title = if title.is_empty() { String::new() } else { format!("<title>{title}</title>") };
    block.push(format_args!(
        "<path d=\"{data}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{width}\" stroke-linejoin=\"round\" \
         stroke-linecap=\"round\">{title}</path>",
        hex(colour),
    ));
}
