//! Converts Latin-1 text, which the XML parser does not read, to UTF-8.

use crate::formats::ModelFault;
use crate::message::message;
use std::io::{BufRead, BufReader, Cursor, Read};

/// The bytes at a file's beginning in which the encoding is declared.
const HEAD_BYTES: u64 = 200;

/// The text of a file in UTF-8, whatever encoding its first line declares.
pub(super) fn decoded(mut file: impl Read + 'static) -> Result<Box<dyn BufRead>, ModelFault> {
    let mut head = Vec::new();
    file.by_ref().take(HEAD_BYTES).read_to_end(&mut head).map_err(ModelFault::unreadable)?;
    if head.starts_with(&[0xFE, 0xFF]) || head.starts_with(&[0xFF, 0xFE]) {
        return Err(message!["is XML in UTF-16"; "save it in UTF-8"].into());
    }
    let text = String::from_utf8_lossy(&head).to_ascii_lowercase();
    let first_line = text.split("?>").next().unwrap_or_default().to_owned();
    let is_latin = ["8859-1", "8859-15", "windows-1252", "cp1252"].iter().any(|name| first_line.contains(name));
    let bytes = Cursor::new(head).chain(file);
    Ok(if is_latin { Box::new(BufReader::new(Latin { bytes, rest: None })) } else { Box::new(BufReader::new(bytes)) })
}

/// Converts Latin-1 to UTF-8 byte by byte. Characters of Windows-1252 between 128 and 160 occur only in names, and
/// become spaces.
struct Latin<R> {
    bytes: R,
    /// The second byte of a character whose first is already written.
    rest: Option<u8>,
}

impl<R: Read> Read for Latin<R> {
    fn read(&mut self, to: &mut [u8]) -> std::io::Result<usize> {
        // each byte becomes at most two, and one may be left over
        let Some(room) = to.len().checked_sub(1) else { return Ok(0) };
        let mut from = [0; 4096];
        let many = (room / 2).min(from.len());
        if many == 0 {
            return self.read_one(to);
        }
        let read = self.bytes.read(&mut from[..many])?;
        let letters = from[..read].iter().flat_map(|&byte| {
            let letter = char::from(byte);
            let mut utf8 = [0; 4];
            let length = letter.encode_utf8(&mut utf8).len();
            utf8.into_iter().take(length)
        });
        let mut written = 0;
        for (slot, byte) in to.iter_mut().zip(self.rest.take().into_iter().chain(letters)) {
            *slot = byte;
            written += 1;
        }
        Ok(written)
    }
}

impl<R: Read> Latin<R> {
    /// Reads a single byte, if there is no room for a whole character.
    fn read_one(&mut self, to: &mut [u8]) -> std::io::Result<usize> {
        let mut byte = [0];
        let next = match self.rest.take() {
            Some(rest) => rest,
            None if self.bytes.read(&mut byte)? == 0 => return Ok(0),
            None => {
                let mut utf8 = [0; 4];
                let length = char::from(byte[0]).encode_utf8(&mut utf8).len();
                self.rest = (length > 1).then_some(utf8[1]);
                utf8[0]
            }
        };
        to[0] = next;
        Ok(1)
    }
}
