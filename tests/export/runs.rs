//! Which font draws which letters of a line.

use crate::command::letters::face;
use fontdb::{Database, ID, Source};
use gnomon::export::figure::runs;
use std::sync::Arc;

/// Letters that Noto Sans lacks: two that are read to the right, two to the left.
const LETTERS: [char; 4] = ['\u{A4CF}', '\u{A4D0}', '\u{5D0}', '\u{5D1}'];

/// Noto Sans, regular and bold, then for each letter a face that has it and no other of them.
fn faces() -> (Database, [ID; 4]) {
    let mut faces = Database::new();
    let mut load = |bytes: Vec<u8>| faces.load_font_source(Source::Binary(Arc::new(bytes)))[0];
    load(notosans::REGULAR_TTF.to_vec());
    load(notosans::BOLD_TTF.to_vec());
    let ids = LETTERS.map(|letter| load(face(letter)));
    (faces, ids)
}

#[test]
fn each_run_is_of_a_face_that_has_its_letters() {
    let (faces, [one, other, right, left]) = faces();
    let [a, b, alef, bet] = LETTERS;
    let of = |line: &str| runs(line, 400, &faces);
    let run = |face: Option<ID>, said: &str| (face, said.to_owned());
    assert_eq!(of("Haus Nord"), [run(None, "Haus Nord")]);
    let line = format!("Haus {a}{a}-{a} {b} Nord");
    let expected =
        [run(None, "Haus "), run(Some(one), &format!("{a}{a}-{a}")), run(None, " "), run(Some(other), &b.to_string())];
    assert_eq!(of(&line), [&expected[..], &[run(None, " Nord")]].concat());
    // words of Noto Sans stay its own between letters of one face
    let line = format!("{a} Nord {a}");
    let letter = run(Some(one), &a.to_string());
    assert_eq!(of(&line), [letter.clone(), run(None, " Nord "), letter.clone()]);
    // what joins letters, or changes how one looks, stays with that
    let line = format!("{a}\u{FE0F}\u{200D}{a}{b}\u{FE0F}");
    assert_eq!(
        of(&line),
        [run(Some(one), &format!("{a}\u{FE0F}\u{200D}{a}")), run(Some(other), &format!("{b}\u{FE0F}"))]
    );
    // no face has it: Noto Sans draws its box, and the others are drawn all the same
    assert_eq!(of(&format!("\u{A4D1}{a}")), [run(None, "\u{A4D1}"), letter]);
    // what is read to the left stands from right to left
    let [alef_run, bet_run] = [run(Some(right), &alef.to_string()), run(Some(left), &bet.to_string())];
    assert_eq!(of(&format!("A{alef}{bet}B")), [run(None, "A"), bet_run, alef_run, run(None, "B")]);
}
