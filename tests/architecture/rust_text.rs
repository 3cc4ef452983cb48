//! Finds comments and string literals in Rust source, so that they are not confused.

use std::ops::Range;

/// The comments of a source, with their slashes, and its string literals, without their quotes.
#[derive(Default)]
pub(crate) struct TextRanges {
    pub(crate) comments: Vec<Range<usize>>,
    pub(crate) literals: Vec<Range<usize>>,
}

impl TextRanges {
    pub(crate) fn of(source: &str) -> TextRanges {
        let bytes = source.as_bytes();
        let find = |from: usize, end: &str| source[from..].find(end).map_or(source.len(), |at| from + at);
        let mut found = TextRanges::default();
        let mut at = 0;
        while at < bytes.len() {
            let rest = &bytes[at..];
            at = if rest.starts_with(b"//") {
                let end = find(at, "\n");
                found.comments.push(at..end);
                end
            } else if rest.starts_with(b"/*") {
                let end = (find(at, "*/") + 2).min(source.len());
                found.comments.push(at..end);
                end
            } else if let Some(hashes) = hashes_of_raw(bytes, at) {
                let first = at + 1 + hashes + 1;
                let end = find(first, &format!("\"{}", "#".repeat(hashes)));
                found.literals.push(first..end);
                end + 1 + hashes
            } else if rest[0] == b'"' {
                let end = end_of_literal(bytes, at + 1);
                found.literals.push(at + 1..end);
                end + 1
            } else if rest[0] == b'\'' {
                at + length_of_character(&source[at..])
            } else {
                at + 1
            };
        }
        found
    }
}

/// How many hashes a raw string has that begins here.
fn hashes_of_raw(bytes: &[u8], at: usize) -> Option<usize> {
    let before = &bytes[..at];
    let is_name = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'_';
    let prefix = before.strip_suffix(b"b").or(before.strip_suffix(b"c")).unwrap_or(before);
    if bytes[at] != b'r' || prefix.last().is_some_and(is_name) {
        return None;
    }
    let hashes = bytes[at + 1..].iter().take_while(|byte| **byte == b'#').count();
    (bytes.get(at + 1 + hashes) == Some(&b'"')).then_some(hashes)
}

/// The place of the closing quote.
fn end_of_literal(bytes: &[u8], first: usize) -> usize {
    let mut end = first;
    while end < bytes.len() && bytes[end] != b'"' {
        end += if bytes[end] == b'\\' { 2 } else { 1 };
    }
    end.min(bytes.len())
}

/// The bytes of a character in its quotes, or the one of a lifetime's.
fn length_of_character(text: &str) -> usize {
    let mut characters = text[1..].chars();
    match characters.next() {
        Some('\\') => text.get(3..).and_then(|rest| rest.find('\'')).map_or(1, |at| 3 + at + 1),
        Some(character) if characters.next() == Some('\'') => 1 + character.len_utf8() + 1,
        _ => 1,
    }
}
