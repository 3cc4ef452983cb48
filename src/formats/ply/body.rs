//! Reads a PLY file's tables: vertices, polygons and strips.

use super::header::{PlyElement, PlyEncoding, PlyHeader, PlyNumber, PlyProperty};
use crate::formats::source::{number, words};
use crate::message::{Message, message};
use glam::DVec3;

/// The tables of a file. The vertices of polygons and strips are checked to be within the positions.
pub(super) struct PlyTables {
    pub positions: Vec<DVec3>,
    pub polygons: PlyLists,
    pub strips: PlyLists,
}

/// Lists of vertices, one after another.
#[derive(Default)]
pub(super) struct PlyLists {
    vertices: Vec<u32>,
    ends: Vec<usize>,
}

impl PlyLists {
    pub(super) fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &[u32]> {
        let begins = [0].into_iter().chain(self.ends.iter().copied());
        begins.zip(&self.ends).map(|(begin, &end)| self.vertices.get(begin..end).unwrap_or_default())
    }

    fn end(&mut self) {
        self.ends.push(self.vertices.len());
    }
}

impl PlyTables {
    pub(super) fn read(header: &PlyHeader, body: &[u8]) -> Result<Self, Message> {
        let mut tables = Self { positions: Vec::new(), polygons: PlyLists::default(), strips: PlyLists::default() };
        let mut numbers: Box<dyn PlyNumbers> = match header.encoding {
            PlyEncoding::Ascii => Box::new(WrittenNumbers(words(body))),
            PlyEncoding::LittleEnd => Box::new(StoredNumbers { rest: body, big: false }),
            PlyEncoding::BigEnd => Box::new(StoredNumbers { rest: body, big: true }),
        };
        for element in &header.elements {
            tables.element(element, &mut *numbers).ok_or_else(|| damaged(element))??;
        }
        let count = tables.positions.len();
        let all = tables.polygons.vertices.iter().chain(&tables.strips.vertices);
        if let Some(vertex) = all.into_iter().find(|&&vertex| vertex as usize >= count) {
            let what = format!("has a face with vertex {vertex}, but there are only {count}");
            return Err(message![what; "the file is damaged: export it again"]);
        }
        Ok(tables)
    }

    /// Reads a table; `None` if the file ends within it, or has something else than a number.
    fn element(&mut self, element: &PlyElement, numbers: &mut dyn PlyNumbers) -> Option<Result<(), Message>> {
        match element.name.as_slice() {
            b"vertex" => {
                let at = |name: &[u8]| {
                    let property = |property: &PlyProperty| property.name == name && property.length.is_none();
                    element.properties.iter().position(property)
                };
                let (Some(x), Some(y), Some(z)) = (at(b"x"), at(b"y"), at(b"z")) else {
                    return Some(Err(message!["has vertices without x, y and z"; "export it again"]));
                };
                let mut row = vec![0.0; element.properties.len()];
                for _ in 0..element.rows {
                    for (property, into) in element.properties.iter().zip(&mut row) {
                        *into = cell(property, numbers)?;
                    }
                    let value = |at: usize| row.get(at).copied().unwrap_or_default();
                    self.positions.push(DVec3::new(value(x), value(y), value(z)));
                }
                Some(positions_are_finite(&self.positions))
            }
            // rows without properties take no bytes, so they are not iterated
            _ if element.properties.is_empty() => Some(Ok(())),
            name => {
                let is_list = |property: &PlyProperty| {
                    property.length.is_some() && matches!(property.name.as_slice(), b"vertex_indices" | b"vertex_index")
                };
                let list = element.properties.iter().position(is_list);
                for _ in 0..element.rows {
                    for (at, property) in element.properties.iter().enumerate() {
                        match property.length {
                            Some(length) if list == Some(at) && name == b"face" => {
                                polygon(length, property.number, numbers, &mut self.polygons)?;
                            }
                            Some(length) if list == Some(at) && name == b"tristrips" => {
                                strip(length, property.number, numbers, &mut self.strips)?;
                            }
                            _ => {
                                cell(property, numbers)?;
                            }
                        }
                    }
                }
                Some(Ok(()))
            }
        }
    }
}

fn positions_are_finite(positions: &[DVec3]) -> Result<(), Message> {
    match positions.iter().position(|position| !position.is_finite()) {
        Some(vertex) => Err(message![format!("has no number for a coordinate of vertex {vertex}"); "export it again"]),
        None => Ok(()),
    }
}

fn damaged(element: &PlyElement) -> Message {
    let name = crate::formats::left_out::label(&crate::formats::source::text(&element.name));
    let what = format!("is cut off or damaged within its {} elements of the kind `{name}`", element.rows);
    message![what; "copy or export it again"]
}

/// Reads the number of a property, or skips a list and returns an arbitrary number.
fn cell(property: &PlyProperty, numbers: &mut dyn PlyNumbers) -> Option<f64> {
    let Some(length) = property.length else { return numbers.next(property.number) };
    let count = length_of(numbers.next(length)?)?;
    numbers.pass(property.number, count)?;
    Some(0.0)
}

fn length_of(number: f64) -> Option<u64> {
    (number >= 0.0 && number.fract() == 0.0).then_some(number as u64)
}

fn vertex(number: f64) -> Option<u32> {
    (number >= 0.0 && number.fract() == 0.0 && number < f64::from(u32::MAX)).then_some(number as u32)
}

fn polygon(length: PlyNumber, number: PlyNumber, numbers: &mut dyn PlyNumbers, into: &mut PlyLists) -> Option<()> {
    for _ in 0..length_of(numbers.next(length)?)? {
        into.vertices.push(vertex(numbers.next(number)?)?);
    }
    into.end();
    Some(())
}

/// Reads a list of strips; each except the last ends with −1.
fn strip(length: PlyNumber, number: PlyNumber, numbers: &mut dyn PlyNumbers, into: &mut PlyLists) -> Option<()> {
    for _ in 0..length_of(numbers.next(length)?)? {
        match numbers.next(number)? {
            -1.0 => into.end(),
            index => into.vertices.push(vertex(index)?),
        }
    }
    into.end();
    Some(())
}

/// The numbers of a file in order.
trait PlyNumbers {
    /// The next number; `None` if the file ends, or has something else there.
    fn next(&mut self, number: PlyNumber) -> Option<f64>;

    /// Skips some numbers.
    fn pass(&mut self, number: PlyNumber, count: u64) -> Option<()> {
        (0..count).try_for_each(|_| self.next(number).map(|_| ()))
    }
}

struct WrittenNumbers<T>(T);

impl<'a, T: Iterator<Item = &'a [u8]>> PlyNumbers for WrittenNumbers<T> {
    fn next(&mut self, _number: PlyNumber) -> Option<f64> {
        number(self.0.next()?)
    }
}

struct StoredNumbers<'a> {
    rest: &'a [u8],
    /// Whether the byte order is big-endian.
    big: bool,
}

impl StoredNumbers<'_> {
    fn bytes<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (bytes, rest) = self.rest.split_first_chunk::<N>()?;
        self.rest = rest;
        let mut bytes = *bytes;
        if self.big {
            bytes.reverse();
        }
        Some(bytes)
    }
}

impl PlyNumbers for StoredNumbers<'_> {
    fn next(&mut self, number: PlyNumber) -> Option<f64> {
        Some(match number {
            PlyNumber::I8 => i8::from_le_bytes(self.bytes()?).into(),
            PlyNumber::U8 => u8::from_le_bytes(self.bytes()?).into(),
            PlyNumber::I16 => i16::from_le_bytes(self.bytes()?).into(),
            PlyNumber::U16 => u16::from_le_bytes(self.bytes()?).into(),
            PlyNumber::I32 => i32::from_le_bytes(self.bytes()?).into(),
            PlyNumber::U32 => u32::from_le_bytes(self.bytes()?).into(),
            PlyNumber::F32 => f32::from_le_bytes(self.bytes()?).into(),
            PlyNumber::F64 => f64::from_le_bytes(self.bytes()?),
        })
    }

    fn pass(&mut self, number: PlyNumber, count: u64) -> Option<()> {
        let bytes = usize::try_from(count).ok()?.checked_mul(number.bytes())?;
        self.rest = self.rest.get(bytes..)?;
        Some(())
    }
}
