//! The palette of a GIF: at most 256 colours for all frames, so that nothing flickers.
//!
//! The method is median cut (Heckbert, *Color Image Quantization for Frame Buffer Display*, 1982), with two changes.
//! The next box to cut is the one with the largest sum of squared differences from the mean, and it is cut at the mean.
//! A box is represented by its most frequent colour, not by its mean, so that the flat colours of a drawing stay the
//! same to the bit. There is no dithering: its grain would look like cells and would crawl from frame to frame.

use crate::export::figure::{Screen, scale::Rgb};
use rustc_hash::FxHashMap;

/// The greatest number of colours of a GIF.
const MOST_COLOURS: usize = 256;

/// The number of pixels of each colour.
#[derive(Default)]
pub(super) struct Counts(FxHashMap<Rgb, u64>);

impl Counts {
    pub(super) fn add(&mut self, frame: &Screen) {
        for run in frame.pixels.chunk_by(|a, b| a == b) {
            *self.0.entry(run[0]).or_default() += run.len() as u64;
        }
    }

    pub(super) fn palette(self) -> Palette {
        let mut colours: Vec<ColourCount> = self.0.into_iter().collect();
        // the order in a map is not the same everywhere
        colours.sort_unstable();
        let mut boxes = vec![Box::of(colours)];
        while boxes.len() < MOST_COLOURS {
            let widest = boxes.iter().enumerate().max_by(|(_, a), (_, b)| a.spread.total_cmp(&b.spread));
            let Some((at, _)) = widest.filter(|(_, widest)| widest.spread > 0.0) else { break };
            let [low, high] = boxes.swap_remove(at).cut();
            boxes.extend([low, high]);
        }
        let most =
            |of: &Box| of.colours.iter().max_by_key(|(colour, count)| (*count, *colour)).map(|(colour, _)| *colour);
        Palette { colours: boxes.iter().filter_map(most).collect(), known: FxHashMap::default() }
    }
}

type ColourCount = (Rgb, u64);

/// Colours that are close to each other.
struct Box {
    colours: Vec<ColourCount>,
    /// The component (red, green or blue) in which the colours vary most, and its mean.
    part: usize,
    mean: f64,
    /// The sum of squared differences from that mean over all pixels; 0 if there is one colour.
    spread: f64,
}

impl Box {
    fn of(colours: Vec<ColourCount>) -> Box {
        let pixels = colours.iter().map(|(_, count)| *count as f64).sum::<f64>().max(1.0);
        let of_part = |part: usize| {
            let sum = |value: &dyn Fn(f64) -> f64| {
                let each = colours.iter().map(|(colour, count)| *count as f64 * value(f64::from(colour[part])));
                each.sum::<f64>()
            };
            let mean = sum(&|value| value) / pixels;
            (part, mean, sum(&|value| (value - mean).powi(2)))
        };
        let widest = (0..3).map(of_part).max_by(|(.., a), (.., b)| a.total_cmp(b));
        let (part, mean, spread) = widest.unwrap_or((0, 0.0, 0.0));
        let spread = if colours.len() > 1 { spread } else { 0.0 };
        Box { colours, part, mean, spread }
    }

    /// Splits the box into the colours below the mean and the rest. Neither is empty if the spread is not 0.
    fn cut(self) -> [Box; 2] {
        let Box { colours, part, mean, .. } = self;
        let (low, high) = colours.into_iter().partition(|(colour, _)| f64::from(colour[part]) < mean);
        [Box::of(low), Box::of(high)]
    }
}

/// The palette, and the nearest colour for each colour that was looked up before.
pub(super) struct Palette {
    colours: Vec<Rgb>,
    known: FxHashMap<Rgb, u8>,
}

impl Palette {
    /// Red, green and blue of each colour, one after another.
    pub(super) fn bytes(&self) -> Vec<u8> {
        self.colours.concat()
    }

    /// Converts a frame to palette indices.
    pub(super) fn of(&mut self, frame: &Screen) -> Vec<u8> {
        /// How many looked-up colours are remembered at most, so that a long animation does not fill the memory.
        const MOST_KNOWN: usize = 1 << 20;
        if self.known.len() > MOST_KNOWN {
            self.known.clear();
        }
        let Palette { colours, known } = self;
        let mut numbers = Vec::with_capacity(frame.pixels.len());
        for run in frame.pixels.chunk_by(|a, b| a == b) {
            let number = *known.entry(run[0]).or_insert_with(|| nearest(colours, run[0]));
            numbers.resize(numbers.len() + run.len(), number);
        }
        numbers
    }
}

/// The index of the colour nearest to a given one.
pub(super) fn nearest(colours: &[Rgb], asked: Rgb) -> u8 {
    let distance = |colour: &Rgb| -> i32 {
        let parts = colour.iter().zip(asked).map(|(one, other)| i32::from(*one) - i32::from(other));
        parts.map(|apart| apart * apart).sum()
    };
    let nearest = colours.iter().enumerate().min_by_key(|(_, colour)| distance(colour));
    // there are at most 256
    nearest.map_or(0, |(at, _)| at as u8)
}
