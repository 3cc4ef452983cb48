//! Reads the bytes of buffers: the binary chunk of a `.glb`, base64 in the JSON, or a file beside the model.
//!
//! A buffer is read when the first accessor needs it, so one that only holds textures may be missing. A path may not
//! leave the model's folder, nor may a link in it, and nothing is fetched from the web: a model must not make the
//! program read files that its user does not mean to share.

use super::document::Document;
use super::draco::UnpackedElements;
use super::meshopt::CompressedView;
use super::{Fault, container, draco};
use crate::formats::on_disk;
use crate::formats::whole::leads_out;
use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::DecodePaddingMode;
use base64::engine::general_purpose::{GeneralPurpose, GeneralPurposeConfig};
use std::cell::{OnceCell, RefCell};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Component, Path, PathBuf};
use std::rc::Rc;

/// Exporters differ in whether they pad.
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
    /// The unpacked bytes of compressed buffer views.
    views: Vec<OnceCell<Vec<u8>>>,
    /// The unpacked elements of the accessors of compressed primitives.
    elements: BTreeMap<usize, UnpackedElements>,
    /// Several buffers may refer to one file, which is kept in memory once.
    files: RefCell<BTreeMap<PathBuf, Rc<[u8]>>>,
}

enum Bytes<'a> {
    Borrowed(&'a [u8]),
    Owned(Rc<[u8]>),
}

impl<'a> Buffers<'a> {
    /// `binary` is the `.glb`'s chunk, `folder` the model file's folder.
    pub(super) fn new(document: &'a Document, binary: Option<&'a [u8]>, folder: &'a Path) -> Self {
        Self {
            document,
            binary,
            folder,
            loaded: document.buffers.iter().map(|_| OnceCell::new()).collect(),
            views: document.buffer_views.iter().map(|_| OnceCell::new()).collect(),
            elements: BTreeMap::new(),
            files: RefCell::default(),
        }
    }

    /// Unpacks the compressed primitives of a mesh. Before that, their accessors have no bytes.
    pub(super) fn unpack(&mut self, mesh: usize) -> Result<(), Fault> {
        let document = self.document;
        let primitives = document.meshes.get(mesh).map_or(&[][..], |mesh| &mesh.primitives);
        for (number, primitive) in primitives.iter().enumerate() {
            let Some(said) = draco::compression(document, primitive) else { continue };
            let source = self.view_bytes(draco::view(said), || format!("primitive {number} of mesh {mesh}"))?;
            let mut unpacked = BTreeMap::new();
            draco::unpack(document, (mesh, number), primitive, (said, source), &mut unpacked)?;
            self.elements.append(&mut unpacked);
        }
        Ok(())
    }

    /// All bytes of an uncompressed view.
    pub(super) fn view_bytes(&self, view: Option<usize>, user: impl Fn() -> String) -> Result<&[u8], Fault> {
        let count = self.document.buffer_views.len();
        let found = view.and_then(|index| Some((index, self.document.buffer_views.get(index)?)));
        let Some((index, view)) = found else {
            return Err(Fault::NoSuch { user: user(), what: "buffer view", index: view.unwrap_or(usize::MAX), count });
        };
        let start = view.byte_offset.map_or(0, |offset| offset.0);
        let holder = format!("buffer view {index}");
        self.range(view.buffer.value(), start..start.saturating_add(view.byte_length.0), &holder)
    }

    fn range(&self, buffer: usize, range: Range<u64>, user: &str) -> Result<&[u8], Fault> {
        let bytes = self.get(buffer, user)?;
        let within = || bytes.get(usize::try_from(range.start).ok()?..usize::try_from(range.end).ok()?);
        within().ok_or_else(|| Fault::Range {
            what: user.to_owned(),
            start: range.start,
            end: range.end,
            holder: format!("buffer {buffer}"),
            holds: bytes.len() as u64,
        })
    }

    /// The unpacked elements of an accessor, if its primitive is compressed.
    pub(super) fn unpacked_elements(&self, accessor: usize) -> Option<&UnpackedElements> {
        self.elements.get(&accessor)
    }

    /// The unpacked bytes of a view, if it is compressed and not also stored uncompressed.
    pub(super) fn unpacked_view(&self, index: usize) -> Result<Option<&[u8]>, Fault> {
        let Some(compressed) = CompressedView::of(self.document, index) else { return Ok(None) };
        let plain = self.document.buffer_views.get(index).map(|view| view.buffer.value());
        let Some(cell) = self.views.get(index).filter(|_| plain.is_some_and(|plain| self.is_placeholder(plain))) else {
            return Ok(None);
        };
        if cell.get().is_none() {
            let (buffer, range) = compressed.source()?;
            let unpacked = compressed.decode(self.range(buffer, range, &format!("buffer view {index}"))?)?;
            return Ok(Some(cell.get_or_init(|| unpacked)));
        }
        Ok(cell.get().map(Vec::as_slice))
    }

    /// All available bytes, which may be more or fewer than the file says.
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

    /// Whether the buffer is only a placeholder for unpacked views.
    fn is_placeholder(&self, index: usize) -> bool {
        let buffer = self.document.buffers.get(index);
        let extensions = buffer.and_then(|buffer| buffer.extensions.as_ref());
        let is_said = extensions.is_some_and(|found| {
            let mut others = found.others.iter();
            others.any(|(name, value)| name.ends_with("_meshopt_compression") && value["fallback"] == true)
        });
        // the first buffer may be the container's chunk
        buffer.is_some_and(|buffer| buffer.uri.is_none()) && (is_said || index > 0 || self.binary.is_none())
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
        // also on systems where it is not a separator, so that a file means the same everywhere
        let inside = |part| matches!(part, Component::Normal(_) | Component::CurDir);
        if relative.contains('\\') {
            let what = format!(
                "lies at '{address}', but folders in an address are separated by /, not by a backslash: export it again"
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
        if leads_out(self.folder, &path) {
            let what = format!(
                "lies at '{address}', a link that leads out of the model's folder: copy the file itself there, or export one .glb"
            );
            return Err(fault(index, what));
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

/// Decodes `type;base64,…`.
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

/// Whether an address begins with a scheme such as `https:`. A single letter is a drive, which is refused, too.
pub(super) fn has_scheme(uri: &str) -> bool {
    let Some((scheme, _)) = uri.split_once(':') else {
        return false;
    };
    let letters = |byte: u8| byte.is_ascii_alphanumeric() || b"+-.".contains(&byte);
    scheme.starts_with(|first: char| first.is_ascii_alphabetic()) && scheme.bytes().all(letters)
}

/// Decodes `%20` and the like; a `%` without two digits stays as it is.
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

/// Shortens an address for a message.
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
