//! Reads a PLY file's header: its tables, and the types of their numbers.

use crate::formats::left_out::label;
use crate::formats::source::{TextLines, text, words};
use crate::message::{Message, message};

/// How a file's numbers are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PlyEncoding {
    Ascii,
    LittleEnd,
    BigEnd,
}

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PlyNumber {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl PlyNumber {
    fn named(word: &[u8]) -> Option<Self> {
        Some(match word {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    /// Its size in bytes.
    pub(super) fn bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

/// A value in each row of a table.
pub(super) struct PlyProperty {
    pub name: Vec<u8>,
    /// For a list, the type of its length.
    pub length: Option<PlyNumber>,
    pub number: PlyNumber,
}

pub(super) struct PlyElement {
    pub name: Vec<u8>,
    pub rows: u64,
    pub properties: Vec<PlyProperty>,
}

/// The contents of a header.
pub(super) struct PlyHeader {
    pub encoding: PlyEncoding,
    pub elements: Vec<PlyElement>,
}

impl PlyHeader {
    /// Reads the header. Returns the bytes after it, too.
    pub(super) fn read(bytes: &[u8]) -> Result<(Self, &[u8]), Message> {
        let damaged = |what: String| message![what; "the file is damaged or was edited: export it again"];
        let (mut encoding, mut elements) = (None, Vec::<PlyElement>::new());
        let mut rest = bytes;
        loop {
            let Some(line) = TextLines::new(rest).next() else {
                return Err(damaged("has a header without an end".into()));
            };
            rest = behind(rest, line.len());
            let mut parts = words(line);
            match parts.next().unwrap_or_default() {
                b"end_header" => break,
                b"format" => {
                    encoding = match parts.next().unwrap_or_default() {
                        b"ascii" => Some(PlyEncoding::Ascii),
                        b"binary_little_endian" => Some(PlyEncoding::LittleEnd),
                        b"binary_big_endian" => Some(PlyEncoding::BigEnd),
                        other => return Err(damaged(format!("is in the format `{}`", label(&text(other))))),
                    }
                }
                b"element" => {
                    let name = parts.next().unwrap_or_default().to_vec();
                    let rows = parts.next().and_then(|word| std::str::from_utf8(word).ok()?.parse().ok());
                    let Some(rows) = rows else {
                        return Err(damaged("does not say how many elements of a kind it has".into()));
                    };
                    elements.push(PlyElement { name, rows, properties: Vec::new() });
                }
                b"property" => {
                    let property = property(&mut parts);
                    let Some((element, property)) = elements.last_mut().zip(property) else {
                        return Err(damaged(format!(
                            "has a property that PLY does not know: `{}`",
                            label(&text(line))
                        )));
                    };
                    element.properties.push(property);
                }
                // comments, and lines that programs write without marking them as comments
                _ => (),
            }
        }
        let Some(encoding) = encoding else {
            return Err(damaged("does not say how its numbers are written".into()));
        };
        Ok((Self { encoding, elements }, rest))
    }

    /// Whether coordinates are stored as single-precision floats.
    pub(super) fn has_floats(&self) -> bool {
        let vertex = self.elements.iter().find(|element| element.name == b"vertex");
        let is_float = |property: &PlyProperty| property.name == b"x" && property.number == PlyNumber::F32;
        self.encoding != PlyEncoding::Ascii && vertex.is_some_and(|vertex| vertex.properties.iter().any(is_float))
    }
}

fn property<'a>(parts: &mut impl Iterator<Item = &'a [u8]>) -> Option<PlyProperty> {
    let first = parts.next()?;
    let (length, number) = match first {
        b"list" => (Some(PlyNumber::named(parts.next()?)?), PlyNumber::named(parts.next()?)?),
        _ => (None, PlyNumber::named(first)?),
    };
    Some(PlyProperty { name: parts.next()?.to_vec(), length, number })
}

/// The bytes after a line of a length and its end.
fn behind(text: &[u8], line: usize) -> &[u8] {
    let end = text.get(line..).unwrap_or_default();
    end.strip_prefix(b"\r\n").or_else(|| end.get(1..)).unwrap_or_default()
}
