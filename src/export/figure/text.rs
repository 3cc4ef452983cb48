//! Lines of text: how wide they are, and how they are shortened.

use skrifa::instance::{LocationRef, Size};
use skrifa::{FontRef, MetadataProvider};

/// Regular or bold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FontWeight {
    Regular,
    Bold,
}

/// The width of a line, in the unit of `size`. Kerning, which can only make it narrower, is ignored.
pub(super) fn width(text: &str, weight: FontWeight, size: f64) -> f64 {
    let face = match weight {
        FontWeight::Regular => notosans::REGULAR_TTF,
        FontWeight::Bold => notosans::BOLD_TTF,
    };
    let letters = text.chars();
    // A letter that the font lacks is drawn by another font, or as a box: about as wide as the widest letters.
    let guess = size;
    let Ok(font) = FontRef::new(face) else {
        return guess * letters.count() as f64;
    };
    let map = font.charmap();
    let metrics = font.glyph_metrics(Size::new(size as f32), LocationRef::default());
    letters.map(|letter| map.map(letter).and_then(|glyph| metrics.advance_width(glyph)).map_or(guess, f64::from)).sum()
}

/// Text as one line without control characters or repeated blanks.
pub(super) fn clean(text: &str) -> String {
    let printable = |c: char| {
        if c.is_control() || matches!(c, '\u{FFFE}' | '\u{FFFF}') { ' ' } else { c }
    };
    let text: String = text.chars().map(printable).collect();
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Breaks the text into at most `most` lines of width `room`. What does not fit is replaced by an ellipsis.
pub(super) fn wrap(text: &str, weight: FontWeight, size: f64, room: f64, most: usize) -> Vec<String> {
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
    // A single word may still be too long in any line.
    lines.iter().map(|line| ellipsis(line, weight, size, room)).collect()
}

/// The line if it fits, otherwise as much of it as fits, and an ellipsis.
fn ellipsis(line: &str, weight: FontWeight, size: f64, room: f64) -> String {
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

/// Shortens two names so that they fit but still differ: without the folders that both begin with, then with an
/// ellipsis in the middle or, if that makes them equal, before the first difference.
pub(super) fn told_apart(names: &[String; 2], fits: impl Fn(&str) -> bool) -> [String; 2] {
    let names = names.each_ref().map(|name| clean(name));
    if names.iter().all(|name| fits(name)) {
        return names;
    }
    let alike = |[one, other]: [&str; 2]| {
        let pairs = one.chars().zip(other.chars());
        pairs.take_while(|(one, other)| one == other).map(|(letter, _)| letter.len_utf8()).sum::<usize>()
    };
    let [one, other] = names.each_ref().map(String::as_str);
    let folders = match one != other {
        true => one[..alike([one, other])].rfind(['/', '\\']).map_or(0, |slash| slash + 1),
        false => 0,
    };
    let [one, other] = [&one[folders..], &other[folders..]];
    let cut = [one, other].map(|name| without_middle(name, &fits));
    if cut[0] != cut[1] || one == other {
        return cut;
    }
    let differs = alike([one, other]);
    [one, other].map(|name| format!("…{}", &name[differs..]))
}

/// The name if it fits, otherwise its beginning and its end with an ellipsis between them.
pub fn without_middle(name: &str, fits: impl Fn(&str) -> bool) -> String {
    if fits(name) {
        return name.to_owned();
    }
    let letters: Vec<char> = name.chars().collect();
    let of = |kept: usize| {
        let (head, tail) = (&letters[..kept.div_ceil(2)], &letters[letters.len() - kept / 2..]);
        head.iter().chain(&['…']).chain(tail).collect::<String>()
    };
    (0..letters.len()).rev().map(of).find(|cut| fits(cut)).unwrap_or_else(|| of(0))
}

/// Reverses [`escape`].
pub(super) fn unescape(text: &str) -> String {
    let signs = [("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&apos;", "'"), ("&amp;", "&")];
    signs.into_iter().fold(text.to_owned(), |text, (written, sign)| text.replace(written, sign))
}

/// Escapes text for XML.
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
