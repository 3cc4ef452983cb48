//! Letters that Noto Sans lacks: the system's fonts draw them, and a note lists those that no font has.

use crate::shared::program::{command, site, stderr};
use image::RgbImage;

/// No letter, and in no font.
const LETTER: char = '\u{A4CF}';

/// Noto Sans with a glyph for a letter that it lacks, in place of some others.
pub(crate) fn face(letter: char) -> Vec<u8> {
    let mut face = notosans::REGULAR_TTF.to_vec();
    let word = |face: &[u8], at: usize| u16::from_be_bytes([face[at], face[at + 1]]);
    let long = |face: &[u8], at: usize| (usize::from(word(face, at)) << 16) + usize::from(word(face, at + 2));
    let tables = usize::from(word(&face, 4));
    let table = (0..tables).map(|table| 12 + 16 * table).find(|at| face[*at..at + 4] == *b"cmap").unwrap();
    let cmap = long(&face, table + 8);
    let map = cmap + long(&face, cmap + 8);
    assert_eq!(word(&face, map), 4, "a map in segments");
    // their ends, a gap, their starts, what is added to come to a glyph
    let bytes = usize::from(word(&face, map + 6));
    let [ends, starts, deltas] = [14, 16 + bytes, 16 + 2 * bytes].map(|offset| map + offset);
    let letter = letter as u16;
    let at = (0..bytes).step_by(2).find(|at| word(&face, ends + at) > letter).unwrap();
    let start = word(&face, starts + at);
    assert!(start > letter, "it lies in a gap");
    let delta = word(&face, deltas + at).wrapping_add(start).wrapping_sub(letter);
    for (table, value) in [(ends, letter), (starts, letter), (deltas, delta)] {
        face[table + at..table + at + 2].copy_from_slice(&value.to_be_bytes());
    }
    face
}

/// The sheet of a site with this name, in a home with these fonts, and the messages.
fn sheet(name: &str, faces: &[Vec<u8>]) -> (RgbImage, String) {
    let folder = site();
    let path = folder.path();
    let text = std::fs::read_to_string(path.join("site.toml")).unwrap();
    std::fs::write(path.join("site.toml"), text.replace("name = \"Paris\"", &format!("name = \"{name}\""))).unwrap();
    std::fs::create_dir(path.join(".fonts")).unwrap();
    for (number, face) in faces.iter().enumerate() {
        std::fs::write(path.join(format!(".fonts/face-{number}.ttf")), face).unwrap();
    }
    let asked = "profile . --engine cpu --size 60 --write png --draw hours";
    let output = command(path, asked).env("HOME", path).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    let svg = std::fs::read_to_string(path.join("out/hours.svg")).unwrap();
    assert!(svg.contains(name), "the SVG has no letters but lines");
    (image::open(path.join("out/profile.png")).unwrap().into_rgb8(), stderr(&output))
}

/// Where two sheets differ: left, top, right, bottom.
fn differ(one: &RgbImage, other: &RgbImage) -> Option<[u32; 4]> {
    let places = one.enumerate_pixels().filter(|(x, y, pixel)| other.get_pixel(*x, *y) != *pixel);
    places.fold(None, |found, (x, y, _)| {
        let [left, top, right, bottom] = found.unwrap_or([x, y, x, y]);
        Some([left.min(x), top.min(y), right.max(x), bottom.max(y)])
    })
}

#[cfg(target_os = "linux")]
#[test]
fn the_systems_faces_draw_what_noto_sans_lacks() {
    let face = [face(LETTER)];
    let name = format!("Haus {LETTER} Nord");
    let (boxed, told) = sheet(&name, &[]);
    let note = format!("no font has the letters {LETTER} of \"{name}\"");
    assert!(told.contains(&note) && told.lines().filter(|line| line.contains("no font")).count() == 1, "{told}");
    let (drawn, told) = sheet(&name, &face);
    assert!(!told.contains("no font"), "{told}");
    // the one letter is another, what follows it makes room, and all else stands as it stood
    let [left, top, right, bottom] = differ(&boxed, &drawn).expect("the letter is drawn");
    assert!(right - left < 700 && bottom - top < 100, "{left} {top} {right} {bottom}");
    // where Noto Sans has all letters the system is not asked
    let ((one, told), (other, _)) = (sheet("Haus Žižkov Дом", &[]), sheet("Haus Žižkov Дом", &face));
    assert!(!told.contains("no font") && differ(&one, &other).is_none(), "{told}");
}

/// Another one.
const OTHER: char = '\u{A4CE}';

/// Two fonts, neither of which has the other's letter, draw both side by side.
#[cfg(target_os = "linux")]
#[test]
fn letters_of_two_faces_stand_in_one_line() {
    let name = format!("A{LETTER}B{OTHER}C");
    let (boxed, told) = sheet(&name, &[]);
    assert!(told.contains(&format!("no font has the letters {LETTER}{OTHER}")), "{told}");
    let (one, told) = sheet(&name, &[face(LETTER)]);
    assert!(told.contains(&format!("no font has the letters {OTHER}")), "{told}");
    let (both, told) = sheet(&name, &[face(LETTER), face(OTHER)]);
    assert!(!told.contains("no font"), "{told}");
    let [left, top, right, bottom] = differ(&boxed, &both).expect("they are drawn");
    assert!(right - left < 700 && bottom - top < 100, "{left} {top} {right} {bottom}");
    let [second, ..] = differ(&one, &both).expect("the other one is drawn, too");
    assert!(second > left, "{second} {left}");
}
