//! The text of a table, and its lines: CSV.

use super::error::SiteError;
use std::io::Read;
use std::path::Path;

/// No longer is a table, bytes.
const MOST_BYTES: u64 = 64 << 20;

/// The text of a table's file, without the mark that some editors begin it with.
///
/// # Errors
/// What cannot be read, and what is not UTF-8.
pub(super) fn text_of(path: &Path) -> Result<String, SiteError> {
    let file = path.display().to_string();
    let unreadable = |why: String| SiteError::Unreadable { path: file.clone(), why };
    let mut bytes = Vec::new();
    let opened = std::fs::File::open(path).map_err(|error| unreadable(error.to_string()))?;
    opened.take(MOST_BYTES + 1).read_to_end(&mut bytes).map_err(|error| unreadable(error.to_string()))?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(unreadable(format!("a table has at most {} MB", MOST_BYTES >> 20)));
    }
    let text = String::from_utf8(bytes).map_err(|error| {
        let good = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = good.iter().filter(|byte| **byte == b'\n').count() + 1;
        SiteError::Encoding { file: file.clone(), what: format!("has a letter in line {line} that is not UTF-8") }
    })?;
    Ok(text.trim_start_matches('\u{feff}').to_owned())
}

/// The lines of a table as RFC 4180 has them: a field in quotes may hold separators, line breaks, and quotes twice.
pub(super) struct CsvLines<'a> {
    rest: &'a str,
    line: usize,
    separator: char,
}

impl<'a> CsvLines<'a> {
    /// The lines of a text with this letter between fields.
    pub(super) fn new(text: &'a str, separator: char) -> Self {
        CsvLines { rest: text, line: 1, separator }
    }

    /// The next line's number and fields; no fields where a quote has no end.
    pub(super) fn next(&mut self) -> Option<(usize, Option<Vec<String>>)> {
        if self.rest.is_empty() {
            return None;
        }
        let first = self.line;
        let (mut fields, mut field, mut is_quoted) = (Vec::new(), String::new(), false);
        let mut letters = self.rest.char_indices().peekable();
        while let Some((at, letter)) = letters.next() {
            self.line += usize::from(letter == '\n');
            match letter {
                '"' if is_quoted && letters.next_if(|(_, next)| *next == '"').is_some() => field.push('"'),
                '"' if is_quoted => is_quoted = false,
                '"' if field.trim().is_empty() => {
                    field.clear();
                    is_quoted = true;
                }
                letter if letter == self.separator && !is_quoted => fields.push(std::mem::take(&mut field)),
                '\r' if !is_quoted => {}
                '\n' if !is_quoted => {
                    fields.push(field);
                    self.rest = &self.rest[at + 1..];
                    return Some((first, Some(fields)));
                }
                letter => field.push(letter),
            }
        }
        self.rest = "";
        fields.push(field);
        Some((first, (!is_quoted).then_some(fields)))
    }
}
