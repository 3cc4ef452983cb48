//! Places labels on lines so that they can be read and, if possible, cover nothing else.

use super::{distance, length};
use crate::export::figure::scale::Rgb;
use crate::export::figure::svg::{Block, LetterStyle, hex};
use crate::export::figure::text;

/// The halo behind labels.
const HALO: Rgb = [255, 255, 255];

/// A position for a label: its middle, and the angle of the text in radians, clockwise from horizontal.
#[derive(Clone, Copy)]
pub(super) struct Spot {
    pub(super) at: [f64; 2],
    pub(super) angle: f64,
    /// The cost of the position itself; a pixel of another line under the label adds 1.
    pub(super) cost: f64,
}

/// The labels of a picture.
pub(super) struct Labels {
    size: [f64; 2],
    style: LetterStyle,
    columns: usize,
    /// For squares of [`SQUARE`] pixels: the length of lines in each, and whether a label covers it.
    lines: Vec<f32>,
    letters: Vec<bool>,
    placed: Vec<(Spot, String, Rgb)>,
    /// The least distance between equal labels, pixels.
    apart: f64,
}

/// Side of a square, pixels.
const SQUARE: f64 = 6.0;
/// The margin around a label, pixels.
const AROUND: f64 = 6.0;

impl Labels {
    /// An empty set of labels for a picture of this size in pixels.
    pub(super) fn new(pixels: (u32, u32), style: LetterStyle, apart: f64) -> Labels {
        let size = [f64::from(pixels.0), f64::from(pixels.1)];
        let [columns, rows] = size.map(|length| (length / SQUARE).ceil() as usize + 1);
        let (lines, letters) = (vec![0.0; columns * rows], vec![false; columns * rows]);
        Labels { size, style, columns, lines, letters, placed: Vec::new(), apart }
    }

    /// Adds a line that labels should avoid.
    pub(super) fn avoid(&mut self, line: &[[f64; 2]]) {
        for ends in line.windows(2) {
            let [from, to] = [ends[0], ends[1]];
            let steps = (distance(from, to) / (0.5 * SQUARE)).ceil().max(1.0);
            for step in 0..steps as usize {
                let share = (step as f64 + 0.5) / steps;
                let at = [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * share);
                if let Some(square) = self.square(at) {
                    self.lines[square] += (distance(from, to) / steps) as f32;
                }
            }
        }
    }

    /// Marks the place of text that is drawn otherwise, so that no label covers it.
    pub(super) fn cover(&mut self, at: [f64; 2], half: [f64; 2]) {
        let spot = Spot { at, angle: 0.0, cost: 0.0 };
        for square in self.under(&spot, half).unwrap_or_default() {
            self.letters[square] = true;
        }
    }

    fn square(&self, at: [f64; 2]) -> Option<usize> {
        let is_within = (0..2).all(|axis| at[axis] >= 0.0 && at[axis] <= self.size[axis]);
        is_within.then(|| (at[1] / SQUARE) as usize * self.columns + (at[0] / SQUARE) as usize)
    }

    /// Half of a label's width and height.
    pub(super) fn half(&self, said: &str) -> [f64; 2] {
        [text::width(said, self.style.weight, self.style.size) / 2.0, self.style.size * 0.40]
    }

    /// Whether a label at this position would cover no line.
    pub(super) fn is_clear(&self, said: &str, spot: &Spot) -> bool {
        let squares = self.under(spot, self.half(said).map(|half| half + AROUND));
        squares.is_some_and(|squares| squares.iter().all(|&square| self.lines[square] == 0.0))
    }

    /// Puts a label at the position with the lowest cost. Returns whether there was room at all.
    pub(super) fn place(&mut self, said: &str, colour: Rgb, spots: &mut [Spot]) -> bool {
        spots.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        let same: Vec<_> = self.placed.iter().filter(|placed| placed.1 == said).map(|placed| placed.0.at).collect();
        let half = self.half(said).map(|half| half + AROUND);
        let mut best: Option<(f64, Spot, Vec<usize>)> = None;
        for spot in spots.iter().copied() {
            if best.as_ref().is_some_and(|best| best.0 <= spot.cost) {
                break;
            }
            if same.iter().any(|at| distance(*at, spot.at) < self.apart) {
                continue;
            }
            let Some(squares) = self.under(&spot, half) else { continue };
            let cost = spot.cost + squares.iter().map(|&square| f64::from(self.lines[square])).sum::<f64>();
            if best.as_ref().is_none_or(|best| cost < best.0) {
                best = Some((cost, spot, squares));
            }
        }
        let Some((_, spot, squares)) = best else { return false };
        squares.into_iter().for_each(|square| self.letters[square] = true);
        self.placed.push((spot, said.to_owned(), colour));
        true
    }

    /// The squares under a label; `None` if it would leave the picture or touch another label.
    fn under(&self, spot: &Spot, half: [f64; 2]) -> Option<Vec<usize>> {
        let (sin, cos) = spot.angle.sin_cos();
        let [columns, rows] = half.map(|half| (2.0 * half / SQUARE).ceil().max(1.0) as usize);
        let mut squares = Vec::with_capacity((columns + 1) * (rows + 1));
        for row in 0..=rows {
            for column in 0..=columns {
                let along = (column as f64 / columns as f64 * 2.0 - 1.0) * half[0];
                let down = (row as f64 / rows as f64 * 2.0 - 1.0) * half[1];
                let at = [spot.at[0] + along * cos - down * sin, spot.at[1] + along * sin + down * cos];
                let square = self.square(at).filter(|&square| !self.letters[square])?;
                squares.push(square);
            }
        }
        squares.sort_unstable();
        squares.dedup();
        Some(squares)
    }

    /// Draws the labels: first a halo that separates them from what they cover, then the text.
    pub(super) fn draw(&self, block: &mut Block) {
        let LetterStyle { size, .. } = self.style;
        let draw = |block: &mut Block, how: &dyn Fn(Rgb) -> String| {
            for (Spot { at: [x, y], angle, .. }, said, colour) in &self.placed {
                let angle = angle.to_degrees();
                let turned = if angle.abs() < 0.05 { String::new() } else { format!(" rotate({angle:.1})") };
                block.push(format_args!(
                    "<text transform=\"translate({x:.1} {y:.1}){turned}\" y=\"{:.1}\" font-size=\"{size}\" \
                     font-weight=\"700\" text-anchor=\"middle\" {}>{}</text>",
                    size * 0.36,
                    how(*colour),
                    text::escape(said),
                ));
            }
        };
        let halo = hex(HALO);
        super::group(block, "halos", |block| {
            let clear = format!("fill=\"{halo}\" stroke=\"{halo}\" stroke-width=\"9\" stroke-linejoin=\"round\"");
            draw(block, &|_| clear.clone());
        });
        super::group(block, "labels", |block| draw(block, &|colour| format!("fill=\"{}\"", hex(colour))));
    }
}

/// Positions along a line between the lengths `from` and `to`, for a label of this width: where the line is straight
/// enough, with the text upright.
pub(super) fn along(line: &[[f64; 2]], [from, to]: [f64; 2], width: f64) -> Vec<Spot> {
    /// The distance between positions, pixels.
    const PITCH: f64 = 9.0;
    /// The angle from which text is turned to read the other way: 80°.
    const STEEP: f64 = 1.4;
    /// How much longer than the straight distance the line under a label may be.
    const BENT: f64 = 1.09;
    let [from, to] = [from.max(width / 2.0), to.min(length(line) - width / 2.0)];
    let count = ((to - from) / PITCH).floor();
    if count < 0.0 {
        return Vec::new();
    }
    let mut places = LinePoints::new(line);
    let spots = (0..=count as usize).filter_map(|step| {
        let middle = from + step as f64 * PITCH;
        let [a, at, b] = [-0.5, 0.0, 0.5].map(|share| places.at(middle + share * width));
        let across = distance(a, b);
        if across * BENT < width {
            return None;
        }
        let mut angle = (b[1] - a[1]).atan2(b[0] - a[0]);
        // steep text always reads from the right
        if angle > STEEP {
            angle -= std::f64::consts::PI;
        } else if angle <= STEEP - std::f64::consts::PI {
            angle += std::f64::consts::PI;
        }
        // at a bend the line would leave the middle of the letters
        let at = [0, 1].map(|axis| (at[axis] * 2.0 + a[axis] + b[axis]) / 4.0);
        Some(Spot { at, angle, cost: (width - across) * 4.0 })
    });
    spots.collect()
}

/// Points at given lengths of a line.
struct LinePoints<'a> {
    line: &'a [[f64; 2]],
    lengths: Vec<f64>,
}

impl LinePoints<'_> {
    fn new(line: &[[f64; 2]]) -> LinePoints<'_> {
        let mut sum = 0.0;
        let to_each = line.windows(2).map(|ends| {
            sum += distance(ends[0], ends[1]);
            sum
        });
        LinePoints { line, lengths: to_each.collect() }
    }

    fn at(&mut self, length: f64) -> [f64; 2] {
        let segment = self.lengths.partition_point(|end| *end < length).min(self.lengths.len() - 1);
        let before = if segment == 0 { 0.0 } else { self.lengths[segment - 1] };
        let share = ((length - before) / (self.lengths[segment] - before).max(1e-9)).clamp(0.0, 1.0);
        [0, 1].map(|axis| {
            let [from, to] = [self.line[segment][axis], self.line[segment + 1][axis]];
            from + (to - from) * share
        })
    }
}
