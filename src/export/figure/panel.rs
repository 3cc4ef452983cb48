//! The panel beside the picture: title, facts, the sun's table, legend, scale and north.

use super::scale::Rgb;
use super::svg::{ACCENT, Block, GRAY, HAIR, INK, LetterStyle, TextAnchor};
use super::text;

/// The width of the panel's column, page pixels.
pub(super) const COLUMN: f64 = 790.0;

/// The content of the panel.
pub(super) struct Panel {
    /// What kind of drawing it is.
    pub kicker: String,
    /// The place's name.
    pub title: String,
    /// The date and the time window.
    pub lead: Vec<String>,
    /// Label and value.
    pub facts: Vec<(&'static str, String)>,
    /// For each instant shown: its name, time, azimuth and altitude.
    pub sun: Vec<[String; 4]>,
    /// What the colours measure.
    pub legend_head: String,
    /// From the lightest to the darkest.
    pub legend: Vec<(Rgb, String)>,
    /// The meaning of lines, below the legend.
    pub keys: Vec<(Rgb, String)>,
    /// The tz version of the clock's rules.
    pub tz: String,
    /// Whether the picture has north at the top.
    pub north_up: bool,
}

pub(super) fn title(panel: &Panel) -> Block {
    let mut block = Block::default();
    block.fill([0.0, 4.0, 84.0, 10.0], ACCENT);
    block.height = 38.0;
    wrapped(&mut block, 0.0, LetterStyle::KICKER, &panel.kicker, 1);
    block.height += 8.0;
    let lines = |style: LetterStyle, most| text::wrap(&panel.title, style.weight, style.size, COLUMN, most);
    // A long name is set in a smaller size before it is shortened.
    let large = lines(LetterStyle::TITLE, 2);
    if large.iter().any(|line| line.ends_with('…')) {
        block.lines(0.0, LetterStyle::LONG_TITLE, &lines(LetterStyle::LONG_TITLE, 3));
    } else {
        block.lines(0.0, LetterStyle::TITLE, &large);
    }
    block.height += 14.0;
    for line in &panel.lead {
        wrapped(&mut block, 0.0, LetterStyle::LEAD, line, 2);
    }
    block
}

/// The distance from a fact's label to its value, and the greatest number of lines of the value.
const INDENT: f64 = 200.0;
const FACT_LINES: usize = 3;

/// Whether the panel has room for the whole value of a fact.
pub(super) fn holds(value: &str) -> bool {
    let lines = text::wrap(value, LetterStyle::BODY.weight, LetterStyle::BODY.size, COLUMN - INDENT, FACT_LINES);
    lines.join(" ") == value
}

pub(super) fn facts(panel: &Panel) -> Block {
    let mut block = Block::default();
    for (label, value) in &panel.facts {
        let baseline = block.height + LetterStyle::LABEL.size;
        block.text(0.0, baseline, TextAnchor::Start, LetterStyle::LABEL, label);
        wrapped(&mut block, INDENT, LetterStyle::BODY, value, FACT_LINES);
        block.height += 7.0;
    }
    block.height -= 7.0;
    block
}

pub(super) fn sun_table(panel: &Panel) -> Block {
    const RIGHT: [f64; 3] = [370.0, 580.0, COLUMN];
    const PITCH: f64 = 46.0;
    let mut block = Block::default();
    let mut row = |cells: [&str; 4], first: LetterStyle, rest: LetterStyle| {
        let baseline = block.height + first.size;
        block.text(0.0, baseline, TextAnchor::Start, first, cells[0]);
        for (cell, right) in cells[1..].iter().zip(RIGHT) {
            block.text(right, baseline, TextAnchor::End, rest, cell);
        }
        block.height += PITCH;
    };
    row(["Sun", "time", "azimuth", "altitude"], LetterStyle::HEAD, LetterStyle::LABEL);
    for [what, time, azimuth, altitude] in &panel.sun {
        row([what, time, azimuth, altitude], LetterStyle::LABEL, LetterStyle::BODY);
    }
    block.height -= 10.0;
    block
}

/// The width of a colour beside its label in the legend, and the gap between the two.
const SWATCH: f64 = 96.0;
const SWATCH_GAP: f64 = 24.0;
/// The distance between two columns of a legend.
const HALF: f64 = COLUMN / 2.0 + 6.0;

/// The thickness of a line in the legend.
const KEY: f64 = 7.0;
/// The gap between the colours and the lines of a legend.
const KEYS_GAP: f64 = 14.0;

/// The number of rows of the legend: if there are more than `most` short entries, it has two columns.
fn legend_rows(entries: &[(Rgb, String)], most: usize) -> usize {
    let room = COLUMN - HALF - SWATCH - SWATCH_GAP;
    let short =
        |(_, label): &(Rgb, String)| text::width(label, LetterStyle::BODY.weight, LetterStyle::BODY.size) <= room;
    if entries.len() > most && entries.iter().all(short) { entries.len().div_ceil(2) } else { entries.len() }
}

/// The legend. Its rows are between 36 and 52 high, and together at most `room` if possible.
pub(super) fn legend(panel: &Panel, room: f64) -> Block {
    const HEAD: f64 = 62.0;
    let rows = legend_rows(&panel.legend, 8);
    let key_rows = legend_rows(&panel.keys, 4);
    let keys_gap = if panel.keys.is_empty() { 0.0 } else { KEYS_GAP };
    let mut block = Block::default();
    wrapped(&mut block, 0.0, LetterStyle::HEAD, &panel.legend_head, 1);
    let pitch = ((room - HEAD - keys_gap) / (rows + key_rows).max(1) as f64).floor().clamp(36.0, 52.0);
    let said = |block: &mut Block, x: f64, y: f64, label: &str| {
        let baseline = y + pitch / 2.0 + LetterStyle::BODY.size * 0.36;
        let label =
            text::wrap(label, LetterStyle::BODY.weight, LetterStyle::BODY.size, COLUMN - x - SWATCH - SWATCH_GAP, 1);
        block.text(x + SWATCH + SWATCH_GAP, baseline, TextAnchor::Start, LetterStyle::BODY, &label.concat());
    };
    for (column, entries) in panel.legend.chunks(rows.max(1)).enumerate() {
        let x = column as f64 * HALF;
        for (row, (colour, label)) in entries.iter().enumerate() {
            let y = HEAD + row as f64 * pitch;
            block.fill([x, y, SWATCH, pitch], *colour);
            said(&mut block, x, y, label);
            if row > 0 {
                block.fill([x, y - 1.0, SWATCH, 2.0], HAIR);
            }
        }
        block.frame([x, HEAD, SWATCH, entries.len() as f64 * pitch], 2.0, GRAY);
    }
    let below = HEAD + rows as f64 * pitch + keys_gap;
    for (column, keys) in panel.keys.chunks(key_rows.max(1)).enumerate() {
        let x = column as f64 * HALF;
        for (row, (colour, label)) in keys.iter().enumerate() {
            let y = below + row as f64 * pitch;
            block.fill([x, y + (pitch - KEY) / 2.0, SWATCH, KEY], *colour);
            said(&mut block, x, y, label);
        }
    }
    block.height = below + key_rows as f64 * pitch;
    block
}

/// The scale bar, and for a plan the north arrow; its height does not depend on the scale.
pub(super) fn scale_and_north(panel: &Panel, metres_a_pixel: f64) -> Block {
    const ROOM: f64 = 560.0;
    let mut block = Block { height: 172.0, ..Block::default() };
    let bar = ScaleBar::within(metres_a_pixel, ROOM);
    let (y, thick) = (84.0, 16.0);
    let part = bar.pixels / 4.0;
    block.fill([0.0, y, bar.pixels, thick], [255, 255, 255]);
    for dark in [0.0, 2.0] {
        block.fill([dark * part, y, part, thick], INK);
    }
    block.frame([1.0, y + 1.0, bar.pixels - 2.0, thick - 2.0], 2.0, INK);
    block.text(0.0, y - 18.0, TextAnchor::Start, LetterStyle::BODY, "0");
    block.text(bar.pixels / 2.0, y - 18.0, TextAnchor::Middle, LetterStyle::BODY, &bar.half_label());
    block.text(bar.pixels, y - 18.0, TextAnchor::Middle, LetterStyle::BODY, &bar.label());
    block.text(0.0, y + 66.0, TextAnchor::Start, LetterStyle::FINE, &paper_scale(metres_a_pixel));

    if !panel.north_up {
        return block;
    }
    let (x, middle, radius) = (COLUMN - 72.0, 104.0, 66.0);
    block.ring(x, middle, radius, 3.0, INK);
    let (tip, tail, wing) = (middle - radius + 6.0, middle + 44.0, 30.0);
    block.polygon(&[[x, tip], [x - wing, tail], [x, tail - 20.0]], ACCENT);
    block.polygon(&[[x, tip], [x + wing, tail], [x, tail - 20.0]], INK);
    block.text(x, middle - radius - 9.0, TextAnchor::Middle, LetterStyle::HEAD, "N");
    block
}

/// The scale when the whole page is printed on A3, to three digits.
fn paper_scale(metres_a_pixel: f64) -> String {
    let ratio = metres_a_pixel / super::paper::PAPER_METRES_A_PIXEL;
    let digits = 10_f64.powf((ratio.max(1e-9).log10().floor() - 2.0).max(0.0));
    let ratio = (ratio / digits).round() * digits;
    let said = if ratio >= 10.0 { thousands(ratio) } else { format!("{ratio:.1}") };
    format!("about 1 : {said} printed on A3")
}

/// A whole number in groups of three digits.
pub(super) fn thousands(value: f64) -> String {
    let digits = format!("{value:.0}");
    let mut said = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            said.push('\u{2009}');
        }
        said.push(digit);
    }
    said
}

/// A length of 1, 2 or 5 times a power of ten metres, and its length on the page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaleBar {
    /// Metres.
    pub metres: f64,
    /// Page pixels.
    pub pixels: f64,
}

impl ScaleBar {
    /// The longest round length within `room` pixels.
    pub fn within(metres_a_pixel: f64, room: f64) -> ScaleBar {
        let most = metres_a_pixel * room;
        let power = 10_f64.powf(most.log10().floor());
        // The last one is used if rounding makes `most` slightly less than its own power of ten.
        let metres = [5.0, 2.0, 1.0, 0.5]
            .into_iter()
            .map(|digit| digit * power)
            .find(|metres| *metres <= most * (1.0 + 1e-9))
            .unwrap_or(power);
        ScaleBar { metres, pixels: metres / metres_a_pixel }
    }

    /// `100 m`, `2 km`, `50 cm`.
    pub fn label(&self) -> String {
        let (factor, unit) = self.unit();
        format!("{} {unit}", number(self.metres * factor))
    }

    fn half_label(&self) -> String {
        number(self.metres / 2.0 * self.unit().0)
    }

    fn unit(&self) -> (f64, &'static str) {
        // Slightly less than a power of ten counts as that power.
        match self.metres * (1.0 + 1e-9) {
            m if m >= 1000.0 => (1e-3, "km"),
            m if m >= 1.0 => (1.0, "m"),
            m if m >= 0.01 => (100.0, "cm"),
            _ => (1000.0, "mm"),
        }
    }
}

/// A number with at most two decimals, without trailing zeros.
fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// The footer: which program computed the drawing, and the advice to check it.
pub(super) fn footer(panel: &Panel) -> Block {
    let mut block = Block::default();
    let by = format!("Gnomon {}, tz {}", env!("CARGO_PKG_VERSION"), panel.tz);
    let said = by + " — computed from the model as given; check with your authority";
    wrapped(&mut block, 0.0, LetterStyle::FINE, &said, 2);
    block
}

fn wrapped(block: &mut Block, x: f64, style: LetterStyle, said: &str, most: usize) {
    let lines = text::wrap(said, style.weight, style.size, COLUMN - x, most);
    block.lines(x, style, &lines);
}
