//! The layout of a sheet: A3 landscape, the picture as large as possible, the panel beside or below it.

use super::panel::{self, COLUMN, Panel};
use super::paper::{HEIGHT, PAPER_METRES_A_PIXEL, WIDTH};
use super::picture::{Fit, PagePicture, Pixels};
use super::svg::{Block, GRAY, HAIR, hex};
use super::{fonts, scale::Rgb};
use crate::export::{ExportError, raster};
use rayon::prelude::*;
use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::Tree;

/// Off-white, so that the sheet's own white can represent light.
pub(super) const PAPER: Rgb = [249, 247, 242];

/// The distance from the page's edge to its frame, and from a frame to its content.
const MARGIN: f64 = 56.0;
const PAD: f64 = 44.0;
/// The least gap between blocks.
const GAP: f64 = 30.0;

/// The positions of everything on a page.
struct PageLayout {
    fit: Fit,
    /// The picture's north-west corner, in whole pixels.
    corner: (u32, u32),
    overlay: Block,
}

/// Lays out and draws the page; `draw` makes the picture once its size is known. `cell_m` is absent in perspective.
/// `finish` turns the sheet into the result, usually with [`png`].
///
/// # Errors
/// [`ExportError::Encode`] if the page cannot be drawn, and the errors of `finish`.
pub(super) fn page<P: Pixels, T>(
    panel: &Panel,
    cells: (u32, u32),
    cell_m: Option<f64>,
    draw: impl FnOnce(Fit) -> P,
    finish: impl FnOnce(&Sheet) -> Result<T, ExportError>,
) -> Result<T, ExportError> {
    let mut layout = beside_or_below(panel, cells, cell_m);
    frame(&mut layout);
    let picture = draw(layout.fit);
    let (width, height) = picture.size();
    let (left, top) = layout.corner;
    let (right, bottom) = (left + width, top + height);
    // the frame and all text lie around the picture
    let around = [[0, 0, WIDTH, top], [0, top, left, bottom], [right, top, WIDTH, bottom], [0, bottom, WIDTH, HEIGHT]];
    let around = around.into_iter().filter(|[west, north, east, south]| west < east && north < south);
    let mut pieces = around.map(SheetPart::blank).collect::<Result<Vec<_>, _>>()?;
    letter(&layout.overlay, &mut pieces)?;
    finish(&Sheet { pieces, picture: Some(((left, top), &picture)) })
}

/// As [`page`], for a picture of lines and text alone: the whole sheet is one block.
pub(super) fn whole(panel: &Panel, cells: (u32, u32), cell_m: f64, draw: impl FnOnce(Fit) -> Block) -> Block {
    let mut layout = beside_or_below(panel, cells, Some(cell_m));
    let picture = draw(layout.fit);
    layout.overlay.place(layout.corner.0.into(), layout.corner.1.into(), &picture);
    frame(&mut layout);
    layout.overlay
}

/// As [`page`] with the panel beside it, for a chart that fills all of its field except the margins (left, top, right,
/// bottom). `draw` makes it for a given number of pixels, together with lines and letters over it, which may reach into
/// the margins.
///
/// # Errors
/// [`ExportError::Encode`] if the page cannot be drawn or encoded.
pub(super) fn chart(
    panel: &Panel,
    [left, top, right, bottom]: [f64; 4],
    draw: impl FnOnce((u32, u32)) -> (PagePicture, Block),
) -> Result<Vec<u8>, ExportError> {
    let [x, y, width, height] = BESIDE;
    let field = [x + left, y + top, width - left - right, height - top - bottom];
    let mut layout = with_picture(field, (field[2] as u32, field[3] as u32));
    stand_beside(panel, None, &mut layout.overlay);
    let (picture, over) = draw(layout.fit.pixels);
    layout.overlay.place(layout.corner.0.into(), layout.corner.1.into(), &over);
    let mut sheet = SheetPart::blank([0, 0, WIDTH, HEIGHT])?;
    sheet.lay(layout.corner, &picture);
    let mut pieces = vec![sheet];
    letter(&layout.overlay, &mut pieces)?;
    png(&Sheet { pieces, picture: None })
}

/// As [`whole`] with the panel beside it, for what fills all of its field: `draw` is told how many pixels that has.
pub(super) fn whole_chart(panel: &Panel, draw: impl FnOnce((u32, u32)) -> Block) -> Block {
    let mut layout = with_picture(BESIDE, (BESIDE[2] as u32, BESIDE[3] as u32));
    stand_beside(panel, None, &mut layout.overlay);
    let field = draw(layout.fit.pixels);
    layout.overlay.place(layout.corner.0.into(), layout.corner.1.into(), &field);
    layout.overlay
}

/// How many times larger the picture must become to move the panel below it, where it is less convenient.
const WORTH_IT: f64 = 1.12;

/// Puts the panel beside the picture, or below a wide one.
fn beside_or_below(panel: &Panel, cells: (u32, u32), cell_m: Option<f64>) -> PageLayout {
    let beside = beside(panel, cells, cell_m);
    let below = below(panel, cells, cell_m);
    if below.fit.scale() > beside.fit.scale() * WORTH_IT { below } else { beside }
}

/// The sheet within its frame: x, y, width and height.
const SHEET: [f64; 4] = [MARGIN, MARGIN, WIDTH as f64 - 2.0 * MARGIN, HEIGHT as f64 - 2.0 * MARGIN];

/// The space for the picture if the panel is at the side.
const BESIDE: [f64; 4] = [SHEET[0], SHEET[1], SHEET[2] - COLUMN - 2.0 * PAD, SHEET[3]];

fn beside(panel: &Panel, cells: (u32, u32), cell_m: Option<f64>) -> PageLayout {
    let mut layout = with_picture(BESIDE, cells);
    stand_beside(panel, cell_m.map(|cell_m| cell_m / layout.fit.scale()), &mut layout.overlay);
    layout
}

/// Puts the panel at the right of the sheet.
fn stand_beside(panel: &Panel, metres_a_pixel: Option<f64>, overlay: &mut Block) {
    let x = BESIDE[0] + BESIDE[2];
    overlay.fill([x - 1.0, SHEET[1], 2.0, SHEET[3]], HAIR);

    let room = SHEET[3] - 2.0 * PAD;
    let mut top = vec![panel::title(panel), panel::facts(panel)];
    if !panel.sun.is_empty() {
        top.push(panel::sun_table(panel));
    }
    let mut foot = vec![panel::footer(panel)];
    if let Some(metres_a_pixel) = metres_a_pixel {
        foot.insert(0, panel::scale_and_north(panel, metres_a_pixel));
    }
    let taken: f64 = top.iter().chain(&foot).map(|block| block.height).sum();
    let gaps = (top.len() + foot.len()) as f64;
    let legend = panel::legend(panel, room - taken - gaps * GAP);
    // Spare height is distributed between the blocks; the footer stays at the bottom.
    let gap = ((room - taken - legend.height) / gaps).clamp(0.0, 76.0);
    let mut y = SHEET[1] + PAD;
    for (index, block) in top.iter().chain([&legend]).enumerate() {
        if index > 0 {
            y += gap;
            overlay.fill([x + PAD, y - gap / 2.0 - 1.0, COLUMN, 2.0], HAIR);
        }
        overlay.place(x + PAD, y, block);
        y += block.height;
    }
    let mut y = SHEET[1] + SHEET[3] - PAD;
    for block in foot.iter().rev() {
        y -= block.height;
        overlay.place(x + PAD, y, block);
        overlay.fill([x + PAD, y - gap / 2.0 - 1.0, COLUMN, 2.0], HAIR);
        y -= gap;
    }
}

fn below(panel: &Panel, cells: (u32, u32), cell_m: Option<f64>) -> PageLayout {
    const COLUMNS: f64 = 4.0;
    /// The height of the legend from which its rows are set closer.
    const LEGEND: f64 = 475.0;
    let (title, facts, sun) = (panel::title(panel), panel::facts(panel), panel::sun_table(panel));
    let (legend, footer) = (panel::legend(panel, LEGEND), panel::footer(panel));
    // The height of the scale's block does not depend on the scale.
    let scale_height = cell_m.map_or(0.0, |_| panel::scale_and_north(panel, 1.0).height + 2.0 * GAP);
    let height = [title.height + GAP + footer.height, facts.height, sun.height + scale_height, legend.height]
        .into_iter()
        .fold(0.0, f64::max);

    let field = [SHEET[0], SHEET[1], SHEET[2], SHEET[3] - height - 2.0 * PAD];
    let mut layout = with_picture(field, cells);
    let y = field[1] + field[3];
    layout.overlay.fill([SHEET[0], y - 1.0, SHEET[2], 2.0], HAIR);
    let pitch = (SHEET[2] - 2.0 * PAD - COLUMN) / (COLUMNS - 1.0);
    let column = |index: f64| SHEET[0] + PAD + index * pitch;
    let top = y + PAD;
    layout.overlay.place(column(0.0), top, &title);
    layout.overlay.place(column(0.0), top + height - footer.height, &footer);
    layout.overlay.place(column(1.0), top, &facts);
    layout.overlay.place(column(2.0), top, &sun);
    if let Some(cell_m) = cell_m {
        let scale = panel::scale_and_north(panel, cell_m / layout.fit.scale());
        layout.overlay.place(column(2.0), top + height - scale.height, &scale);
    }
    layout.overlay.place(column(3.0), top, &legend);
    layout
}

/// Centres the picture in its field, and frames the sheet.
fn with_picture(field: [f64; 4], cells: (u32, u32)) -> PageLayout {
    const AROUND: f64 = 36.0;
    let room = (field[2] - 2.0 * AROUND, field[3] - 2.0 * AROUND);
    let fit = Fit::within(cells, room);
    let middle =
        |from: f64, length: f64, pixels: u32| (from + (length - f64::from(pixels)) / 2.0).round().max(0.0) as u32;
    let corner = (middle(field[0], field[2], fit.pixels.0), middle(field[1], field[3], fit.pixels.1));
    let mut overlay = Block::default();
    overlay.frame(SHEET, 2.0, HAIR);
    PageLayout { fit, corner, overlay }
}

/// A line around the picture.
fn frame(layout: &mut PageLayout) {
    let PageLayout { fit, corner, overlay } = layout;
    overlay.frame([corner.0, corner.1, fit.pixels.0, fit.pixels.1].map(f64::from), 3.0, GRAY);
}

/// A part of the sheet with lines and text.
struct SheetPart {
    /// West, north, east and south on the page, pixels.
    place: [u32; 4],
    pixels: Pixmap,
}

impl SheetPart {
    /// An empty part.
    fn blank(place: [u32; 4]) -> Result<SheetPart, ExportError> {
        let [west, north, east, south] = place;
        let mut pixels = Pixmap::new(east - west, south - north).ok_or_else(|| failed("the page is too large"))?;
        let [r, g, b] = PAPER;
        pixels.fill(Color::from_rgba8(r, g, b, 255));
        Ok(SheetPart { place, pixels })
    }

    /// Copies a picture into the part.
    fn lay(&mut self, (left, top): (u32, u32), picture: &PagePicture) {
        let lines = self.pixels.data_mut().chunks_exact_mut(WIDTH as usize * 4).skip(top as usize);
        for (line, row) in lines.zip(picture.pixels.chunks_exact(picture.width as usize)) {
            for (to, [r, g, b]) in line.as_chunks_mut::<4>().0.iter_mut().skip(left as usize).zip(row) {
                *to = [*r, *g, *b, 255];
            }
        }
    }

    /// Copies this part's section of a row of the page.
    fn put(&self, row: u32, line: &mut [Rgb]) {
        let [west, north, east, south] = self.place;
        if (north..south).contains(&row) {
            let width = (east - west) as usize;
            let pixels = &self.pixels.data().as_chunks::<4>().0[(row - north) as usize * width..][..width];
            for (to, [r, g, b, _]) in line[west as usize..east as usize].iter_mut().zip(pixels) {
                *to = [*r, *g, *b];
            }
        }
    }
}

/// Draws all lines and text over the parts.
fn letter(overlay: &Block, pieces: &mut [SheetPart]) -> Result<(), ExportError> {
    let svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{HEIGHT}\" font-family=\"{}\">{}</svg>",
        fonts::FAMILY,
        overlay.svg
    );
    let svg = fonts::in_runs(&svg);
    let tree = Tree::from_str(&svg, &fonts::options(&svg)).map_err(|error| failed(&error.to_string()))?;
    pieces.par_iter_mut().for_each(|piece| {
        let [west, north, ..] = piece.place;
        let moved = Transform::from_translate(-(west as f32), -(north as f32));
        resvg::render(&tree, moved, &mut piece.pixels.as_mut());
    });
    Ok(())
}

/// A block alone on paper, without a sheet around it: so many pixels from its corner on.
pub(super) fn part(block: &Block, (width, height): (u32, u32)) -> Result<Vec<Rgb>, ExportError> {
    let mut pieces = [SheetPart::blank([0, 0, width, height])?];
    letter(block, &mut pieces)?;
    let [piece] = pieces;
    Ok(piece.pixels.data().as_chunks::<4>().0.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect())
}

/// A sheet as SVG, sized for A3. Without Noto Sans, another sans-serif font is used.
pub(super) fn svg(sheet: &Block) -> String {
    let paper = hex(PAPER);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"420mm\" height=\"297mm\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" \
         stroke=\"none\" font-family=\"'{}', Arial, Helvetica, sans-serif\">\n\
         <rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"{paper}\"/>{}</svg>\n",
        fonts::FAMILY,
        sheet.svg
    )
}

/// The number of rows that one task assembles.
const BAND: usize = 64;

/// The content of a page before it becomes a file. Its picture is drawn band by band.
pub(super) struct Sheet<'a> {
    pieces: Vec<SheetPart>,
    /// The picture with its north-west corner.
    picture: Option<((u32, u32), &'a dyn Pixels)>,
}

impl Sheet<'_> {
    /// A sheet that has only lines and text.
    pub(super) fn of(sheet: &Block) -> Result<Sheet<'static>, ExportError> {
        let mut pieces = vec![SheetPart::blank([0, 0, WIDTH, HEIGHT])?];
        letter(sheet, &mut pieces)?;
        Ok(Sheet { pieces, picture: None })
    }

    /// Draws and assembles the rows of a band.
    fn draw(&self, band: usize, rows: &mut [Rgb]) {
        let width = WIDTH as usize;
        let first = (band * BAND) as u32;
        for (row, line) in (first..).zip(rows.chunks_exact_mut(width)) {
            self.pieces.iter().for_each(|piece| piece.put(row, line));
        }
        let Some(((left, top), picture)) = self.picture else { return };
        let (columns, height) = picture.size();
        let shown = first.max(top)..(first + (rows.len() / width) as u32).min(top + height);
        if shown.is_empty() {
            return;
        }
        let mut pixels = vec![PAPER; shown.len() * columns as usize];
        picture.draw((shown.start - top) as usize, &mut pixels);
        for (row, pixels) in shown.zip(pixels.chunks_exact(columns as usize)) {
            let at = (row - first) as usize * width + left as usize;
            rows[at..at + pixels.len()].copy_from_slice(pixels);
        }
    }

    /// All pixels, for a screen.
    pub(super) fn pixels(&self) -> Vec<Rgb> {
        let mut pixels = vec![PAPER; WIDTH as usize * HEIGHT as usize];
        let bands = pixels.par_chunks_mut(BAND * WIDTH as usize).enumerate();
        bands.for_each(|(band, rows)| self.draw(band, rows));
        pixels
    }
}

/// The number of bands of a sheet that are drawn at once.
pub(super) fn tasks() -> usize {
    rayon::current_num_threads().min(8)
}

/// The sheet as a PNG with its size on paper. Bands are assembled while previous ones are compressed.
pub(super) fn png(sheet: &Sheet) -> Result<Vec<u8>, ExportError> {
    let width = WIDTH as usize;
    // several at once, for as many processors
    let at_once = tasks();
    let bands: Vec<usize> = (0..(HEIGHT as usize).div_ceil(BAND)).collect();
    let make = |bands: &[usize], rows: &mut Vec<Rgb>| {
        let first = bands.first().map_or(0, |band| band * BAND);
        let count = (bands.len() * BAND).min(HEIGHT as usize - first);
        rows.resize(count * width, PAPER);
        let chunks = rows.par_chunks_mut(BAND * width).zip(bands);
        chunks.for_each(|(rows, band)| sheet.draw(*band, rows));
    };
    let dots = (1.0 / PAPER_METRES_A_PIXEL).round() as u32;
    let (mut ready, mut next) = (Vec::new(), Vec::new());
    raster::png_rows((WIDTH, HEIGHT), (png::ColorType::Rgb, png::BitDepth::Eight), Some(dots), |write| {
        for bands in bands.chunks(at_once).map(Some).chain([None]) {
            let (written, ()) = rayon::join(
                || write(bytemuck::cast_slice(&ready)),
                || bands.map_or((), |bands| make(bands, &mut next)),
            );
            written?;
            std::mem::swap(&mut ready, &mut next);
        }
        Ok(())
    })
    .map_err(|error| ExportError::encode("drawing", error))
}

fn failed(why: &str) -> ExportError {
    ExportError::encode("drawing", why)
}
