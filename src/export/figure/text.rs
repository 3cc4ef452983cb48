//! Letters: Noto Sans and nothing else, so that a drawing looks the same on every machine.

use resvg::usvg::fontdb::{Database, Source};
use skrifa::instance::{LocationRef, Size};
use skrifa::{FontRef, MetadataProvider};
use std::sync::{Arc, OnceLock};

/// The family's name in the drawings' SVG.
pub(super) const FAMILY: &str = "Noto Sans";

/// Regular or bold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Weight {
    Regular,
    Bold,
}

/// The two faces, and never the system's.
pub(super) fn fonts() -> Arc<Database> {
    static FONTS: OnceLock<Arc<Database>> = OnceLock::new();
    let load = || {
        let mut fonts = Database::new();
        for face in [notosans::REGULAR_TTF, notosans::BOLD_TTF] {
            fonts.load_font_source(Source::Binary(Arc::new(face)));
        }
        Arc::new(fonts)
    };
    Arc::clone(FONTS.get_or_init(load))
}

/// How wide a line is, in the unit of `size`; kerning, which only tightens, is left out.
pub(super) fn width(text: &str, weight: Weight, size: f64) -> f64 {
    let face = match weight {
        Weight::Regular => notosans::REGULAR_TTF,
        Weight::Bold => notosans::BOLD_TTF,
    };
    let letters = text.chars();
    // A character that the face lacks is drawn as a box, about as wide as the widest letters.
    let guess = size;
    let Ok(font) = FontRef::new(face) else {
        return guess * letters.count() as f64;
    };
    let map = font.charmap();
    let metrics = font.glyph_metrics(Size::new(size as f32), LocationRef::default());
    letters.map(|letter| map.map(letter).and_then(|glyph| metrics.advance_width(glyph)).map_or(guess, f64::from)).sum()
}

/// One line of plain text: no control characters, no runs of blanks.
pub(super) fn clean(text: &str) -> String {
    let printable = |c: char| {
        if c.is_control() || matches!(c, '\u{FFFE}' | '\u{FFFF}') { ' ' } else { c }
    };
    let text: String = text.chars().map(printable).collect();
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The text in at most `most` lines of `room`; what does not fit ends in an ellipsis.
pub(super) fn wrap(text: &str, weight: Weight, size: f64, room: f64, most: usize) -> Vec<String> {
    let fits = |line: &str| width(line, weight, size) <= room;
    let mut lines: Vec<String> = Vec::new();
    let mut line = String::new();
    for word in clean(text).split(' ') {
        let longer = if line.is_empty() { word.to_owned() } else { format!("{line} {word}") };
        if fits(&longer) || line.is_empty() {
            line = longer;
        } else {
            lines.push(std::mem::replace(&mut line, word.to_owned()));
        }
    }
    lines.push(line);
    if lines.len() > most.max(1) {
        let rest = lines.split_off(most.max(1) - 1).join(" ");
        lines.push(rest);
    }
    // A single word may still be too long, in any line.
    lines.iter().map(|line| ellipsis(line, weight, size, room)).collect()
}

/// The line if it fits, else as much of it as does, and an ellipsis.
fn ellipsis(line: &str, weight: Weight, size: f64, room: f64) -> String {
    if width(line, weight, size) <= room {
        return line.to_owned();
    }
    let room = room - width("…", weight, size);
    let mut used = 0.0;
    let mut kept = String::new();
    for letter in line.chars() {
        used += width(letter.encode_utf8(&mut [0; 4]), weight, size);
        if used > room {
            break;
        }
        kept.push(letter);
    }
    format!("{}…", kept.trim_end())
}

/// Text as XML wants it.
pub(super) fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&apos;"),
            c => safe.push(c),
        }
    }
    safe
}
