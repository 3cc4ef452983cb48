//! Fonts. Noto Sans is used for every letter that it has, so that a drawing looks the same on every machine; the
//! system's fonts supply the other letters.
//!
//! A line that needs several fonts is split into runs, each in a font that has all of its letters. A renderer that
//! replaces the font of a whole line fails if the other font produces a different number of glyphs, as emoji fonts do;
//! letters of further fonts then become boxes, too.

use super::text::{escape, unescape};
use resvg::usvg::fontdb::{Database, FaceInfo, ID, Source, Style};
use resvg::usvg::{FontFamily, FontResolver, Node, Options, Tree};
use skrifa::{FontRef, MetadataProvider};
use std::borrow::Cow;
use std::fmt::Write as _;
use std::sync::{Arc, OnceLock};
use unicode_bidi::{BidiInfo, Level};

/// The family's name in the drawings' SVG.
pub(super) const FAMILY: &str = "Noto Sans";
/// The prefix of a run's family name; the font's index in the database follows.
const FACE: &str = "face-";

/// The options for rendering a drawing's SVG. The system's fonts are searched only if the drawing needs them.
pub(super) fn options(svg: &str) -> Options<'static> {
    let fontdb = if svg.chars().any(is_foreign) { with_system() } else { own() };
    let numbered = |family: &FontFamily| match family {
        FontFamily::Named(name) => name.strip_prefix(FACE)?.parse().ok(),
        _ => None,
    };
    let font_resolver = FontResolver {
        select_font: Box::new(move |font, faces| match font.families().iter().find_map(numbered) {
            Some(number) => faces.faces().nth(number).map(|face| face.id),
            None => own_face(font.weight(), faces),
        }),
        select_fallback: Box::new(|letter, used, faces| fallback(letter, used, faces)),
    };
    Options { fontdb, font_family: FAMILY.to_owned(), font_resolver, ..Options::default() }
}

/// Regular or bold Noto Sans, whichever is nearer to the weight. The system may have a different Noto Sans.
fn own_face(weight: u16, faces: &Database) -> Option<ID> {
    faces.faces().take(2).min_by_key(|face| face.weight.0.abs_diff(weight)).map(|face| face.id)
}

/// A drawing's SVG in which every line that needs several fonts is split into runs. Everything else is unchanged.
pub(super) fn in_runs(svg: &str) -> Cow<'_, str> {
    if !svg.chars().any(is_foreign) {
        return Cow::Borrowed(svg);
    }
    let faces = with_system();
    let mut set = String::with_capacity(svg.len());
    let mut rest = svg;
    while let Some(start) = rest.find("<text ") {
        let (before, text) = rest.split_at(start);
        let Some(end) = text.find("</text>") else { break };
        let (line, after) = text.split_at(end + "</text>".len());
        set.push_str(before);
        set.push_str(&line_in_runs(line, &faces).unwrap_or_else(|| line.to_owned()));
        rest = after;
    }
    set.push_str(rest);
    Cow::Owned(set)
}

/// Splits a line into runs; `None` if one font is enough, or if the line has no x of its own.
fn line_in_runs(line: &str, faces: &Database) -> Option<String> {
    let (head, said) = line.strip_suffix("</text>")?.split_once('>')?;
    if !said.chars().any(is_foreign) {
        return None;
    }
    let of = |name: &str| Some(head.split_once(&format!(" {name}=\""))?.1.split_once('"')?.0);
    let (x, anchor, weight) = (of("x")?, of("text-anchor")?, of("font-weight")?);
    let runs = runs(&unescape(said), weight.parse().ok()?, faces);
    if runs.len() < 2 {
        return None;
    }
    let at = |x: f64, family: &str, said: &str| {
        let head = head.replacen(&format!(" x=\"{}\"", of("x").unwrap_or_default()), &format!(" x=\"{x:.2}\""), 1);
        let head = head.replacen(&format!("text-anchor=\"{anchor}\""), "text-anchor=\"start\"", 1);
        format!("{head} font-family=\"{family}\" xml:space=\"preserve\">{}</text>", escape(said))
    };
    let set: Vec<(f64, String, &str)> = runs
        .iter()
        .map(|(face, said)| {
            let number = face.and_then(|face| faces.faces().position(|other| other.id == face));
            let family = number.map_or_else(|| FAMILY.to_owned(), |number| format!("{FACE}{number}"));
            (width(&at(0.0, &family, said)), family, said.as_str())
        })
        .collect();
    let whole: f64 = set.iter().map(|(width, ..)| width).sum();
    let share = match anchor {
        "middle" => 0.5,
        "end" => 1.0,
        _ => 0.0,
    };
    let mut left = x.parse::<f64>().ok()? - share * whole;
    let mut lines = String::new();
    for (width, family, said) in &set {
        // Writing to a String cannot fail.
        let _ = write!(lines, "{}", at(left, family, said));
        left += width;
    }
    Some(lines)
}

/// The width of a line that begins at 0.
fn width(line: &str) -> f64 {
    let svg = format!("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"1\" height=\"1\">{line}</svg>");
    let tree = Tree::from_str(&svg, &options(&svg));
    let of = |node: &Node| match node {
        Node::Text(text) => f64::from(text.bounding_box().right()),
        _ => 0.0,
    };
    tree.map_or(0.0, |tree| tree.root().children().iter().map(of).fold(0.0, f64::max))
}

/// The runs of a line from left to right, each with the font that has its letters; `None` for Noto Sans, in the given
/// `weight`. Letters that no font has stay with Noto Sans, which draws a box.
pub fn runs(line: &str, weight: u16, faces: &Database) -> Vec<(Option<ID>, String)> {
    let bidi = BidiInfo::new(line, Some(Level::ltr()));
    let mut runs = Vec::new();
    // the system font that was used last: it keeps what it can draw
    let mut last = None;
    for paragraph in &bidi.paragraphs {
        let (levels, parts) = bidi.visual_runs(paragraph, paragraph.range.clone());
        for part in parts {
            let mut of_part = split(&line[part.clone()], weight, faces, &mut last);
            if levels[part.start].is_rtl() {
                of_part.reverse();
            }
            runs.append(&mut of_part);
        }
    }
    runs
}

/// The runs of a part that has one direction of writing, in the order of that direction.
fn split(part: &str, weight: u16, faces: &Database, last: &mut Option<ID>) -> Vec<(Option<ID>, String)> {
    let base: Vec<ID> = own_face(weight, faces).into_iter().collect();
    let in_face =
        |face: ID, letter: char| faces.with_face_data(face, |data, index| has(data, index, letter)).unwrap_or_default();
    let mut runs: Vec<(Option<ID>, String)> = Vec::new();
    for letter in part.chars() {
        let now = runs.last().and_then(|(face, _)| *face);
        let face = match now {
            // what joins letters, or changes the letter before it, stays with that letter
            _ if is_unseen(letter) => now,
            Some(face) if is_attached(letter) && in_face(face, letter) => now,
            _ if !is_foreign(letter) => None,
            _ => last.filter(|face| in_face(*face, letter)).or_else(|| fallback(letter, &base, faces)),
        };
        *last = face.or(*last);
        match runs.last_mut() {
            Some((of, said)) if *of == face => said.push(letter),
            _ => runs.push((face, letter.to_string())),
        }
    }
    // blanks and signs between letters of one font are set in that font: words stay whole and in order
    let mut joined: Vec<(Option<ID>, String)> = Vec::new();
    for (face, said) in runs {
        if let [.., (Some(before), text), (None, between)] = joined.as_mut_slice()
            && face == Some(*before)
            && between.chars().all(|letter| !letter.is_alphabetic() && in_face(*before, letter))
        {
            text.push_str(between);
            text.push_str(&said);
            joined.pop();
        } else {
            joined.push((face, said));
        }
    }
    joined
}

/// The letters of a text that no font has, each once. They are drawn as boxes.
pub fn without_face(text: &str) -> String {
    let mut missing = String::new();
    for letter in text.chars().filter(|letter| is_foreign(*letter)) {
        if !missing.contains(letter) && fallback(letter, &[], &with_system()).is_none() {
            missing.push(letter);
        }
    }
    missing
}

/// A font of the system that has a letter that Noto Sans lacks: the content of its file, and the face's index there.
#[cfg(feature = "desktop")]
pub fn face_with(letter: char) -> Option<(Vec<u8>, u32)> {
    let faces = with_system();
    let found = fallback(letter, &[], &faces)?;
    faces.with_face_data(found, |data, index| (data.to_vec(), index))
}

/// Whether Noto Sans lacks a letter. Control characters and variation selectors do not count as letters.
fn is_foreign(letter: char) -> bool {
    !letter.is_ascii() && !is_unseen(letter) && !has(notosans::REGULAR_TTF, 0, letter)
}

/// Characters that are not drawn themselves: control characters, joiners, and variation selectors.
fn is_unseen(letter: char) -> bool {
    letter.is_control()
        || matches!(letter, '\u{200B}'..='\u{200F}' | '\u{2060}'..='\u{2064}' | '\u{FE00}'..='\u{FE0F}' | '\u{E0000}'..='\u{E0FFF}')
}

/// Characters that are drawn onto the previous letter: accents, enclosing signs, and skin tones of emoji.
fn is_attached(letter: char) -> bool {
    matches!(
        letter,
        '\u{300}'..='\u{36F}' | '\u{1AB0}'..='\u{1AFF}' | '\u{1DC0}'..='\u{1DFF}' | '\u{20D0}'..='\u{20FF}'
            | '\u{FE20}'..='\u{FE2F}' | '\u{1F3FB}'..='\u{1F3FF}'
    )
}

/// Whether a font can draw a letter. A font that has only bitmaps, as some emoji fonts do, cannot draw any here.
fn has(face: &[u8], index: u32, letter: char) -> bool {
    FontRef::from_index(face, index)
        .is_ok_and(|face| face.outline_glyphs().format().is_some() && face.charmap().map(letter).is_some())
}

/// The font that has a letter and best suits the first of the fonts in use: upright, of similar weight, and not
/// monospaced.
fn fallback(letter: char, used: &[ID], faces: &Database) -> Option<ID> {
    let weight = used.first().and_then(|first| faces.face(*first)).map_or(400, |face| face.weight.0);
    let mut fitting: Vec<&FaceInfo> = faces.faces().filter(|face| !used.contains(&face.id)).collect();
    fitting.sort_by_cached_key(|face| {
        let is_serif = face.post_script_name.contains("Serif");
        let off = face.weight.0.abs_diff(weight);
        (face.style != Style::Normal, face.monospaced, is_serif, off, face.post_script_name.clone())
    });
    let has_letter =
        |face: &&FaceInfo| faces.with_face_data(face.id, |data, index| has(data, index, letter)) == Some(true);
    fitting.into_iter().find(has_letter).map(|face| face.id)
}

/// The database with Noto Sans, regular and bold.
fn own() -> Arc<Database> {
    static FACES: OnceLock<Arc<Database>> = OnceLock::new();
    let load = || {
        let mut faces = Database::new();
        for face in [notosans::REGULAR_TTF, notosans::BOLD_TTF] {
            faces.load_font_source(Source::Binary(Arc::new(face)));
        }
        Arc::new(faces)
    };
    Arc::clone(FACES.get_or_init(load))
}

/// The same database with the system's fonts added.
fn with_system() -> Arc<Database> {
    static FACES: OnceLock<Arc<Database>> = OnceLock::new();
    let load = || {
        let mut faces = Database::clone(&own());
        faces.load_system_fonts();
        Arc::new(faces)
    };
    Arc::clone(FACES.get_or_init(load))
}
