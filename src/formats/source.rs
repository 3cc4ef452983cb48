//! Reads a file's bytes as lines, words and names, for the text formats.

use crate::message::{Message, message};
use std::path::{Component, Path, PathBuf};

/// Text in an encoding that contains ASCII: converts UTF-16 of either byte order to UTF-8, and removes a byte-order
/// mark.
pub(super) fn as_ascii(mut bytes: Vec<u8>) -> Vec<u8> {
    match bytes.as_slice() {
        [0xFF, 0xFE, rest @ ..] => from_utf16(rest, u16::from_le_bytes),
        [0xFE, 0xFF, rest @ ..] => from_utf16(rest, u16::from_be_bytes),
        [first, 0, second, 0, ..] if *first != 0 && *second != 0 => from_utf16(&bytes, u16::from_le_bytes),
        [0, first, 0, second, ..] if *first != 0 && *second != 0 => from_utf16(&bytes, u16::from_be_bytes),
        [0xEF, 0xBB, 0xBF, ..] => {
            bytes.drain(..3);
            bytes
        }
        _ => bytes,
    }
}

fn from_utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Vec<u8> {
    let units = bytes.as_chunks().0.iter().map(|two| unit(*two));
    let letters = char::decode_utf16(units).map(|letter| letter.unwrap_or(char::REPLACEMENT_CHARACTER));
    letters.collect::<String>().into_bytes()
}

/// Decodes text as UTF-8, otherwise as Latin-1, in which every byte is a character.
pub(super) fn text(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().copied().map(char::from).collect(),
    }
}

/// The words of a line.
pub(super) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

/// The first word of a line, and the rest of the line.
pub(super) fn keyword(line: &[u8]) -> Option<(&[u8], &[u8])> {
    let line = line.trim_ascii_start();
    let word = words(line).next()?;
    Some((word, line.get(word.len()..).unwrap_or_default()))
}

/// Reads a whole word as a finite number.
pub(super) fn number(word: &[u8]) -> Option<f64> {
    let number: f64 = std::str::from_utf8(word).ok()?.parse().ok()?;
    number.is_finite().then_some(number)
}

/// The lines of a text with any line ending.
#[derive(Clone)]
pub(super) struct TextLines<'a> {
    rest: Option<&'a [u8]>,
    /// The number of the line that was returned last, from 1.
    pub number: usize,
}

impl<'a> TextLines<'a> {
    pub(super) fn new(text: &'a [u8]) -> Self {
        Self { rest: Some(text).filter(|text| !text.is_empty()), number: 0 }
    }
}

impl<'a> Iterator for TextLines<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        let rest = self.rest?;
        self.number += 1;
        let Some(end) = rest.iter().position(|byte| matches!(byte, b'\n' | b'\r')) else {
            self.rest = None;
            return Some(rest);
        };
        let (line, behind) = rest.split_at(end);
        let behind = behind.strip_prefix(b"\r\n").or_else(|| behind.get(1..)).unwrap_or_default();
        self.rest = Some(behind).filter(|behind| !behind.is_empty());
        Some(line)
    }
}

/// An error in a line of a file.
pub(super) fn wrong_line(line: usize, what: &str) -> Message {
    message![format!("{what} in line {line}"); "the file is damaged or was edited: export it again"]
}

/// The path of a file that a model refers to, in the model's folder or below it; `None` if it is elsewhere.
pub(super) fn beside(model: &Path, name: &str) -> Option<PathBuf> {
    // a path means the same on all systems
    let name = name.trim().replace('\\', "/");
    let relative = Path::new(&name);
    let is_inside = |part| matches!(part, Component::Normal(_) | Component::CurDir);
    let is_within = !name.is_empty() && !name.contains(':') && relative.components().all(is_inside);
    is_within.then(|| super::on_disk(&model.parent().unwrap_or(Path::new("")).join(relative)))
}

/// The name of a part that has no name in its file: the file's.
pub(super) fn stem(path: &Path) -> String {
    super::left_out::label(&path.file_stem().unwrap_or_default().to_string_lossy())
}
