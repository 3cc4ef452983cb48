//! Faces: Noto Sans for every letter that it has, so that a drawing looks the same on every machine, and the system's for
//! all others.

use resvg::usvg::fontdb::{Database, FaceInfo, ID, Source, Style};
use resvg::usvg::{FontResolver, Options};
use skrifa::{FontRef, MetadataProvider};
use std::sync::{Arc, OnceLock};

/// The family's name in the drawings' SVG.
pub(super) const FAMILY: &str = "Noto Sans";

/// How a drawing's SVG is read. The system is asked for its faces where the drawing has letters for them, and not before.
pub(super) fn options(svg: &str) -> Options<'static> {
    let fontdb = if svg.chars().any(is_foreign) { with_system() } else { own() };
    let font_resolver = FontResolver {
        // Noto Sans of the system may be another one
        select_font: Box::new(|font, faces| {
            faces.faces().take(2).min_by_key(|face| face.weight.0.abs_diff(font.weight())).map(|face| face.id)
        }),
        select_fallback: Box::new(|letter, used, faces| fallback(letter, used, faces)),
    };
    Options { fontdb, font_family: FAMILY.to_owned(), font_resolver, ..Options::default() }
}

/// The letters of a text that no face has, each once: they are drawn as boxes.
pub fn without_face(text: &str) -> String {
    let mut missing = String::new();
    for letter in text.chars().filter(|letter| is_foreign(*letter)) {
        if !missing.contains(letter) && fallback(letter, &[], &with_system()).is_none() {
            missing.push(letter);
        }
    }
    missing
}

/// Whether Noto Sans lacks a letter; control characters are no letters, nor is what only chooses how one looks.
fn is_foreign(letter: char) -> bool {
    let is_unseen = letter.is_control() || matches!(letter, '\u{200B}'..='\u{200F}' | '\u{FE00}'..='\u{FE0F}');
    !letter.is_ascii() && !is_unseen && !has(notosans::REGULAR_TTF, 0, letter)
}

fn has(face: &[u8], index: u32, letter: char) -> bool {
    FontRef::from_index(face, index).is_ok_and(|face| face.charmap().map(letter).is_some())
}

/// The face that has a letter and stands best beside the first of those in use: upright, of like weight, and not of
/// typewriters.
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

/// Regular and bold.
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

/// Those, and after them the system's.
fn with_system() -> Arc<Database> {
    static FACES: OnceLock<Arc<Database>> = OnceLock::new();
    let load = || {
        let mut faces = Database::clone(&own());
        faces.load_system_fonts();
        Arc::new(faces)
    };
    Arc::clone(FACES.get_or_init(load))
}
