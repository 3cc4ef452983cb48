//! Buffers → bytes: the binary chunk of a `.glb`, base64 in the JSON, or a file beside the model.
//!
//! A buffer is read when the first accessor needs it, so one that only holds textures may be missing. A path may not
//! leave the model's folder, and nothing is fetched from the web: a model must not be able to read what its reader
//! does not mean to show. (A symbolic link in the folder is followed, for it is the user's own.)

use super::document::Document;
use super::{Fault, container};
use crate::formats::on_disk;
use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::DecodePaddingMode;
use base64::engine::general_purpose::{GeneralPurpose, GeneralPurposeConfig};
use std::cell::{OnceCell, RefCell};
use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};
use std::rc::Rc;

/// Exporters do not agree on whether to pad.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// The bytes of a file's buffers, each read once.
pub(super) struct Buffers<'a> {
    document: &'a Document,
    binary: Option<&'a [u8]>,
    folder: &'a Path,
    loaded: Vec<OnceCell<Bytes<'a>>>,
    /// Many buffers may name one file, which must not cost its memory many times.
    files: RefCell<BTreeMap<PathBuf, Rc<[u8]>>>,
}

enum Bytes<'a> {
    Borrowed(&'a [u8]),
    Owned(Rc<[u8]>),
}

impl<'a> Buffers<'a> {
    /// `binary` is the `.glb`'s chunk, `folder` where the model file lies.
    pub(super) fn new(document: &'a Document, binary: Option<&'a [u8]>, folder: &'a Path) -> Self {
        Self {
            document,
            binary,
            folder,
            loaded: document.buffers.iter().map(|_| OnceCell::new()).collect(),
            files: RefCell::default(),
        }
    }

    /// All bytes there are, which may be more or fewer than the file says.
    pub(super) fn get(&self, index: usize, user: &str) -> Result<&[u8], Fault> {
        let Some(cell) = self.loaded.get(index) else {
            return Err(Fault::NoSuch { user: user.into(), what: "buffer", index, count: self.loaded.len() });
        };
        let bytes = match cell.get() {
            Some(bytes) => bytes,
            None => {
                let bytes = self.load(index)?;
                cell.get_or_init(|| bytes)
            }
        };
        Ok(match bytes {
            Bytes::Borrowed(bytes) => bytes,
            Bytes::Owned(bytes) => bytes,
        })
    }

    /// Whether the buffer only stands for what a compressed one unpacks to.
    pub(super) fn is_placeholder(&self, index: usize) -> bool {
        let buffer = self.document.buffers.get(index);
        let extensions = buffer.and_then(|buffer| buffer.extensions.as_ref());
        extensions.is_some_and(|found| {
            let mut others = found.others.iter();
            others.any(|(name, value)| name.ends_with("_meshopt_compression") && value["fallback"] == true)
        }) && buffer.is_some_and(|buffer| buffer.uri.is_none())
    }

    fn load(&self, index: usize) -> Result<Bytes<'a>, Fault> {
        let uri = self.document.buffers.get(index).and_then(|buffer| buffer.uri.as_deref());
        match (uri, self.binary) {
            (Some(uri), _) => match strip_data_scheme(uri) {
                Some(data) => Ok(Bytes::Owned(decode(index, data)?.into())),
                None => Ok(Bytes::Owned(self.read(index, uri)?)),
            },
            (None, Some(binary)) if index == 0 => Ok(Bytes::Borrowed(binary)),
            (None, _) => Err(fault(index, "has neither an address nor bytes: export the model as one .glb")),
        }
    }

    /// Reads a file in the model's folder or below it.
    fn read(&self, index: usize, uri: &str) -> Result<Rc<[u8]>, Fault> {
        let address = shorten(uri);
        if has_scheme(uri) || uri.starts_with("//") {
            return Err(fault(
                index,
                format!("lies at '{address}', and nothing is fetched from there: export the model as one .glb"),
            ));
        }
        let Some(relative) = percent_decode(uri) else {
            return Err(fault(index, format!("has the address '{address}', which is not UTF-8: export it again")));
        };
        // Also on systems where it is no separator: a file means the same everywhere.
        let inside = |part| matches!(part, Component::Normal(_) | Component::CurDir);
        if relative.contains('\\') {
            let what = format!(
                "lies at '{address}', and folders in an address are parted by /, not by a backslash: export it again"
            );
            return Err(fault(index, what));
        }
        if !Path::new(&relative).components().all(inside) {
            return Err(fault(
                index,
                format!("lies at '{address}', outside the model's folder: put it beside the model, or export one .glb"),
            ));
        }
        let path = on_disk(&self.folder.join(relative));
        if let Some(bytes) = self.files.borrow().get(&path) {
            return Ok(bytes.clone());
        }
        let bytes: Rc<[u8]> = match container::read_file(&path) {
            Ok(bytes) => bytes.into(),
            Err(reason) => {
                return Err(fault(
                    index,
                    format!(
                        "lies in the file '{address}', which {reason}; put it beside the model, or export one .glb"
                    ),
                ));
            }
        };
        self.files.borrow_mut().insert(path, bytes.clone());
        Ok(bytes)
    }
}

fn strip_data_scheme(uri: &str) -> Option<&str> {
    let (scheme, data) = uri.split_at_checked(5)?;
    scheme.eq_ignore_ascii_case("data:").then_some(data)
}

/// The bytes of `type;base64,…`.
fn decode(index: usize, data: &str) -> Result<Vec<u8>, Fault> {
    let Some((kind, text)) = data.split_once(',') else {
        return Err(fault(index, "is a data address without data: export it again"));
    };
    if !kind.to_ascii_lowercase().ends_with(";base64") {
        return Err(fault(index, "is a data address that is not base64: export the model as one .glb"));
    }
    let bytes = BASE64.decode(text.trim_ascii());
    bytes.map_err(|error| fault(index, format!("is damaged base64 ({error}): export it again")))
}

/// Whether an address begins with a scheme, as in `https:`; one letter is a drive, which is refused alike.
pub(super) fn has_scheme(uri: &str) -> bool {
    let Some((scheme, _)) = uri.split_once(':') else {
        return false;
    };
    let letters = |byte: u8| byte.is_ascii_alphanumeric() || b"+-.".contains(&byte);
    scheme.starts_with(|first: char| first.is_ascii_alphabetic()) && scheme.bytes().all(letters)
}

/// `%20` → a blank, and so on; a `%` without two digits stands for itself.
pub(in crate::formats) fn percent_decode(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&first, behind)) = rest.split_first() {
        let digits = behind.get(..2).and_then(|digits| std::str::from_utf8(digits).ok());
        let is_hex = |digits: &&str| digits.bytes().all(|digit| digit.is_ascii_hexdigit());
        let code = digits.filter(is_hex).and_then(|digits| u8::from_str_radix(digits, 16).ok());
        match code {
            Some(byte) if first == b'%' => {
                bytes.push(byte);
                rest = behind.get(2..).unwrap_or_default();
            }
            _ => {
                bytes.push(first);
                rest = behind;
            }
        }
    }
    String::from_utf8(bytes).ok()
}

/// An address that fits into a message.
fn shorten(uri: &str) -> String {
    let mut text: String = uri.chars().take(100).collect();
    if text.len() < uri.len() {
        text.push('…');
    }
    text
}

fn fault(buffer: usize, problem: impl Into<String>) -> Fault {
    Fault::Buffer { buffer, problem: problem.into() }
}
