//! A comparison sheet: panels in rows and columns with captions, lettered like the drawings, written as a small PNG.

use crate::picture::{Picture, Rgb};
use anyhow::{Context as _, Result};
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::fontdb::{Database, Source};
use resvg::usvg::{Options, Tree};
use skrifa::instance::{LocationRef, Size};
use skrifa::{FontRef, MetadataProvider as _};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;

/// Paper and inks of the drawings.
pub(crate) const PAPER: Rgb = [249, 247, 242];
pub(crate) const INK: Rgb = [35, 38, 44];
pub(crate) const GRAY: Rgb = [104, 108, 115];

/// Pixels: around the sheet, between panels, and of the letters.
const MARGIN: f64 = 36.0;
const GAP: f64 = 20.0;
const TITLE: f64 = 36.0;
const TEXT: f64 = 25.0;
const LEADING: f64 = 1.3;
/// What heads of rows take on the left.
const ROW_HEAD: f64 = 110.0;

/// A panel and the text below it: the first line in ink, others in gray.
pub(crate) struct Panel {
    pub(crate) picture: Picture,
    pub(crate) caption: Vec<String>,
}

/// A row of panels, with a word before it where there is one.
#[derive(Default)]
pub(crate) struct Row {
    pub(crate) head: String,
    pub(crate) panels: Vec<Panel>,
}

/// All that is on a sheet.
#[derive(Default)]
pub(crate) struct Sheet {
    pub(crate) title: String,
    /// A line below the title.
    pub(crate) note: String,
    /// What colours mean.
    pub(crate) legend: Vec<(Rgb, String)>,
    /// A word above each column, or none.
    pub(crate) columns: Vec<String>,
    pub(crate) rows: Vec<Row>,
}

impl Sheet {
    /// Draws the sheet into a PNG of at most 256 colours.
    pub(crate) fn write(&self, path: &Path) -> Result<()> {
        let mut page = Page::default();
        let mut y = MARGIN;
        y = page.line(MARGIN, y, TITLE, 700, INK, &self.title);
        if !self.note.is_empty() {
            y = page.line(MARGIN, y + 4.0, TEXT, 400, GRAY, &self.note);
        }
        if !self.legend.is_empty() {
            y = page.legend(y + 8.0, &self.legend);
        }
        let heads = self.rows.iter().any(|row| !row.head.is_empty());
        let left = MARGIN + if heads { ROW_HEAD } else { 0.0 };
        let columns = self.rows.iter().map(|row| row.panels.len()).max().unwrap_or(0);
        let width_of = |column: usize| {
            let widths = self.rows.iter().filter_map(|row| row.panels.get(column));
            widths.map(|panel| f64::from(panel.picture.width)).fold(0.0, f64::max)
        };
        let starts: Vec<f64> = (0..columns)
            .scan(left, |x, column| {
                let start = *x;
                *x += width_of(column) + GAP;
                Some(start)
            })
            .collect();
        y += 18.0;
        if !self.columns.is_empty() {
            for (&x, head) in starts.iter().zip(&self.columns) {
                page.line(x, y, TEXT, 700, INK, head);
            }
            y += TEXT * LEADING + 6.0;
        }
        for row in &self.rows {
            if !row.head.is_empty() {
                page.line(MARGIN, y, TEXT, 700, INK, &row.head);
            }
            let mut bottom = y;
            for (panel, &x) in row.panels.iter().zip(&starts) {
                page.pictures.push((x as u32, y as u32, &panel.picture));
                let mut below = y + f64::from(panel.picture.height) + 8.0;
                for (index, line) in panel.caption.iter().enumerate() {
                    below = page.line(x, below, TEXT, 400, if index == 0 { INK } else { GRAY }, line);
                }
                bottom = bottom.max(below);
            }
            y = (bottom + GAP * 0.7).round();
        }
        let right = starts.last().map_or(left, |start| start + width_of(columns - 1));
        page.render((right.max(page.right) + MARGIN) as u32, (y + MARGIN * 0.5) as u32)?.write(path)
    }
}

/// Letters and pictures, and where they go.
#[derive(Default)]
struct Page<'a> {
    svg: String,
    pictures: Vec<(u32, u32, &'a Picture)>,
    /// Where the longest line ends.
    right: f64,
}

impl<'a> Page<'a> {
    /// A line of text whose top is at y; returns where the next one may begin.
    fn line(&mut self, x: f64, y: f64, size: f64, weight: u32, colour: Rgb, text: &str) -> f64 {
        self.svg.push_str(&text_element([x, y + size * 0.95], size, weight, "start", colour, text));
        self.right = self.right.max(x + width(text, weight, size));
        (y + size * LEADING).round()
    }

    fn legend(&mut self, y: f64, entries: &[(Rgb, String)]) -> f64 {
        let mut x = MARGIN;
        for (colour, text) in entries {
            let side = TEXT * 0.8;
            self.svg.push_str(&rectangle([x, y + 5.0, side, side], *colour));
            self.line(x + side + 9.0, y, TEXT, 400, INK, text);
            x += side + 40.0 + width(text, 400, TEXT);
        }
        y + TEXT * LEADING + 4.0
    }

    fn render(&self, width: u32, height: u32) -> Result<Picture> {
        let mut page = Picture::filled(width, height, PAPER);
        for &(x, y, picture) in &self.pictures {
            page.place(x, y, picture);
        }
        drawn_over(page, &self.svg)
    }
}

/// How wide a line of text is.
fn width(text: &str, weight: u32, size: f64) -> f64 {
    let face = if weight == 400 { notosans::REGULAR_TTF } else { notosans::BOLD_TTF };
    let Ok(font) = FontRef::new(face) else { return 0.0 };
    let (map, metrics) = (font.charmap(), font.glyph_metrics(Size::new(size as f32), LocationRef::default()));
    text.chars().filter_map(|letter| metrics.advance_width(map.map(letter)?)).map(f64::from).sum()
}

/// A filled rectangle, as SVG.
pub(crate) fn rectangle([x, y, width, height]: [f64; 4], colour: Rgb) -> String {
    let colour = hex(colour);
    format!("<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" fill=\"{colour}\"/>")
}

/// A line of text on its baseline, as SVG.
pub(crate) fn text_element([x, y]: [f64; 2], size: f64, weight: u32, anchor: &str, colour: Rgb, text: &str) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;");
    let colour = hex(colour);
    format!(
        "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{size}\" font-weight=\"{weight}\" text-anchor=\"{anchor}\" fill=\"{colour}\">{text}</text>"
    )
}

fn hex([r, g, b]: Rgb) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// A picture with SVG over it, in Noto Sans.
pub(crate) fn drawn_over(mut picture: Picture, svg: &str) -> Result<Picture> {
    let (width, height) = (picture.width, picture.height);
    let mut text = String::new();
    write!(
        text,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" font-family=\"Noto Sans\">{svg}</svg>"
    )?;
    let mut fonts = Database::new();
    for face in [notosans::REGULAR_TTF, notosans::BOLD_TTF] {
        fonts.load_font_source(Source::Binary(Arc::new(face)));
    }
    let options = Options { fontdb: Arc::new(fonts), font_family: "Noto Sans".into(), ..Options::default() };
    let tree = Tree::from_str(&text, &options)?;
    let mut pixmap = Pixmap::new(width, height).context("a sheet has a size")?;
    for (to, [r, g, b]) in pixmap.data_mut().chunks_exact_mut(4).zip(&picture.pixels) {
        to.copy_from_slice(&[*r, *g, *b, 255]);
    }
    resvg::render(&tree, Transform::identity(), &mut pixmap.as_mut());
    for (to, from) in picture.pixels.iter_mut().zip(pixmap.data().chunks_exact(4)) {
        to.copy_from_slice(&from[..3]);
    }
    Ok(picture)
}

impl Picture {
    /// Writes a palette PNG.
    pub(crate) fn write(&self, path: &Path) -> Result<()> {
        let (palette, of_colour) = palette(&self.pixels);
        let indices: Vec<u8> = self.pixels.iter().map(|pixel| of_colour[pixel]).collect();
        let mut encoder = png::Encoder::new(std::fs::File::create(path)?, self.width, self.height);
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_compression(png::Compression::High);
        encoder.set_filter(png::Filter::NoFilter);
        encoder.set_palette(palette.concat());
        encoder.write_header()?.write_image_data(&indices)?;
        Ok(())
    }
}

/// At most 256 colours that stand for all (Heckbert's median cut), and which one for each.
fn palette(pixels: &[Rgb]) -> (Vec<Rgb>, BTreeMap<Rgb, u8>) {
    let mut counts: BTreeMap<Rgb, usize> = BTreeMap::new();
    for &pixel in pixels {
        *counts.entry(pixel).or_default() += 1;
    }
    let mut boxes: Vec<Vec<(Rgb, usize)>> = vec![counts.into_iter().collect()];
    let widest = |colours: &[(Rgb, usize)]| {
        let range = |channel: usize| {
            let values = colours.iter().map(|(colour, _)| colour[channel]);
            values.clone().max().unwrap_or(0) - values.min().unwrap_or(0)
        };
        (0..3).map(|channel| (range(channel), channel)).max().unwrap_or((0, 0))
    };
    let weight = |colours: &[(Rgb, usize)]| {
        let count: usize = colours.iter().map(|(_, count)| count).sum();
        f64::from(widest(colours).0).powi(2) * (count as f64).sqrt()
    };
    while boxes.len() < 256 {
        let heaviest = (0..boxes.len()).max_by(|&a, &b| weight(&boxes[a]).total_cmp(&weight(&boxes[b])));
        let Some(heaviest) = heaviest.filter(|&index| boxes[index].len() > 1) else { break };
        let mut colours = boxes.swap_remove(heaviest);
        let channel = widest(&colours).1;
        colours.sort_by_key(|(colour, _)| colour[channel]);
        // in the middle of its range: rare colours count as much as frequent ones
        let (low, high) = (colours[0].0[channel], colours[colours.len() - 1].0[channel]);
        let middle = low + (high - low) / 2;
        let other = colours.split_off(colours.partition_point(|(colour, _)| colour[channel] <= middle));
        boxes.extend([colours, other]);
    }
    let mean = |colours: &[(Rgb, usize)], channel: usize| {
        let sum: usize = colours.iter().map(|(colour, count)| usize::from(colour[channel]) * count).sum();
        let count: usize = colours.iter().map(|(_, count)| count).sum();
        ((sum + count / 2) / count) as u8
    };
    let colours = boxes.iter().map(|colours| std::array::from_fn(|channel| mean(colours, channel))).collect();
    let of_colour = boxes
        .iter()
        .enumerate()
        .flat_map(|(index, colours)| colours.iter().map(move |(colour, _)| (*colour, index as u8)));
    (colours, of_colour.collect())
}
