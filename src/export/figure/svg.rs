//! A block of the page: SVG in coordinates of its own, and its height.

use super::scale::Rgb;
use super::text::{self, FontWeight};
use crate::look::LOOK;
use std::fmt::Write;

/// The colours of text, of secondary text and of hairlines, and the only accent colour.
pub(super) const INK: Rgb = LOOK.ink;
pub(super) const GRAY: Rgb = [104, 108, 115];
pub(super) const HAIR: Rgb = [188, 184, 174];
pub(super) const ACCENT: Rgb = [190, 82, 44];

/// The style of a line of text.
#[derive(Clone, Copy)]
pub(super) struct LetterStyle {
    /// Page pixels.
    pub size: f64,
    pub weight: FontWeight,
    pub colour: Rgb,
}

impl LetterStyle {
    pub(super) const KICKER: LetterStyle = LetterStyle { size: 36.0, weight: FontWeight::Bold, colour: ACCENT };
    pub(super) const TITLE: LetterStyle = LetterStyle { size: 70.0, weight: FontWeight::Bold, colour: INK };
    pub(super) const LONG_TITLE: LetterStyle = LetterStyle { size: 52.0, weight: FontWeight::Bold, colour: INK };
    pub(super) const LEAD: LetterStyle = LetterStyle { size: 40.0, weight: FontWeight::Regular, colour: INK };
    pub(super) const HEAD: LetterStyle = LetterStyle { size: 33.0, weight: FontWeight::Bold, colour: INK };
    pub(super) const BODY: LetterStyle = LetterStyle { size: 32.0, weight: FontWeight::Regular, colour: INK };
    pub(super) const LABEL: LetterStyle = LetterStyle { size: 32.0, weight: FontWeight::Regular, colour: GRAY };
    pub(super) const FINE: LetterStyle = LetterStyle { size: 30.0, weight: FontWeight::Regular, colour: GRAY };

    /// The distance from one baseline to the next.
    pub(super) fn leading(&self) -> f64 {
        (self.size * 1.28).round()
    }
}

/// Which part of a line is at the given x.
#[derive(Clone, Copy)]
pub(super) enum TextAnchor {
    Start,
    Middle,
    End,
}

/// A part of the page.
#[derive(Default)]
pub(super) struct Block {
    pub svg: String,
    /// Page pixels.
    pub height: f64,
}

impl Block {
    /// Adds one line of text; `y` is its baseline.
    pub(super) fn text(&mut self, x: f64, y: f64, anchor: TextAnchor, style: LetterStyle, line: &str) {
        let anchor = match anchor {
            TextAnchor::Start => "start",
            TextAnchor::Middle => "middle",
            TextAnchor::End => "end",
        };
        let weight = match style.weight {
            FontWeight::Regular => 400,
            FontWeight::Bold => 700,
        };
        self.push(format_args!(
            "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{}\" font-weight=\"{weight}\" text-anchor=\"{anchor}\" fill=\"{}\">{}</text>",
            style.size,
            hex(style.colour),
            text::escape(line),
        ));
    }

    /// Adds lines of text at x below the present content; the block grows.
    pub(super) fn lines(&mut self, x: f64, style: LetterStyle, lines: &[String]) {
        for line in lines {
            let baseline = self.height + style.size;
            self.text(x, baseline, TextAnchor::Start, style, line);
            self.height += style.leading();
        }
    }

    /// A filled rectangle.
    pub(super) fn fill(&mut self, [x, y, width, height]: [f64; 4], colour: Rgb) {
        self.push(format_args!(
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" fill=\"{}\"/>",
            hex(colour),
        ));
    }

    /// A frame around a rectangle, completely outside of it.
    pub(super) fn frame(&mut self, [x, y, width, height]: [f64; 4], line: f64, colour: Rgb) {
        self.push(format_args!(
            "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{line}\"/>",
            x - line / 2.0,
            y - line / 2.0,
            width + line,
            height + line,
            hex(colour),
        ));
    }

    /// A filled polygon.
    pub(super) fn polygon(&mut self, points: &[[f64; 2]], colour: Rgb) {
        let mut list = String::new();
        for [x, y] in points {
            // Writing to a String cannot fail.
            let _ = write!(list, "{x:.1},{y:.1} ");
        }
        self.push(format_args!("<polygon points=\"{list}\" fill=\"{}\"/>", hex(colour)));
    }

    /// A line through points, or nothing if there are none.
    pub(super) fn polyline(&mut self, points: &[[f64; 2]], line: f64, colour: Rgb) {
        if points.is_empty() {
            return;
        }
        let mut list = String::new();
        for [x, y] in points {
            // Writing to a String cannot fail.
            let _ = write!(list, "{x:.1},{y:.1} ");
        }
        self.push(format_args!(
            "<polyline points=\"{list}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{line}\"/>",
            hex(colour),
        ));
    }

    /// The outline of a circle.
    pub(super) fn ring(&mut self, x: f64, y: f64, radius: f64, line: f64, colour: Rgb) {
        self.push(format_args!(
            "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{line}\"/>",
            hex(colour),
        ));
    }

    /// Adds another block at an offset; the height of this one does not change.
    pub(super) fn place(&mut self, x: f64, y: f64, block: &Block) {
        self.push(format_args!("<g transform=\"translate({x:.1} {y:.1})\">{}</g>", block.svg));
    }

    /// Adds one or more elements.
    pub(super) fn push(&mut self, element: std::fmt::Arguments) {
        // Writing to a String cannot fail.
        let _ = self.svg.write_fmt(element);
    }
}

/// A colour in SVG's notation.
pub(super) fn hex([r, g, b]: Rgb) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}
