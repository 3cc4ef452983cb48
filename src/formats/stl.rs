//! Reads STL, ASCII or binary: one part per solid.

use super::face_cutter::FaceCutter;
use super::left_out::{LeftOutTally, counted, label};
use super::source::{TextLines, as_ascii, keyword, number, stem, text, words, wrong_line};
use super::vertices::note_floats;
use super::whole::whole_file;
use super::{Format, MAX_COMPONENTS, Model, ModelFault, ReadOptions, Up};
use crate::mesh::Part;
use crate::message::{Message, message};
use glam::DVec3;
use std::path::Path;

/// The bytes before a binary file's triangles: a header with any contents, and their number.
const HEADER: usize = 84;
/// The bytes of a triangle: a normal, three corners, and two arbitrary bytes.
const TRIANGLE: usize = 50;

/// STL, `.stl`.
pub(super) struct Stl;

impl Format for Stl {
    fn name(&self) -> &'static str {
        "STL"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["stl"]
    }

    /// Binary STL files have no magic number.
    fn begins(&self, head: &[u8]) -> bool {
        let begin = words(head).take(64).collect::<Vec<_>>();
        let has = |word: &[u8]| begin.iter().any(|one| one.eq_ignore_ascii_case(word));
        begin.first().is_some_and(|word| word.eq_ignore_ascii_case(b"solid"))
            && (has(b"facet") && has(b"vertex") || has(b"endsolid"))
    }

    fn read(&self, path: &Path, options: &ReadOptions) -> Result<Model, ModelFault> {
        let bytes = whole_file(path)?;
        let mut model = match triangles_of(&bytes)? {
            Some(StlNumbers { triangles, bytes_behind }) => {
                let mut model = of_numbers(triangles, path, options);
                model.notes.extend(surplus(triangles.len(), bytes_behind));
                model
            }
            None => of_text(&as_ascii(bytes), path)?,
        };
        model.up = Up::Z;
        Ok(model)
    }
}

/// A note if a file has more triangles than it states: its exporter miscounted, or two files were joined.
fn surplus(promised: usize, behind: usize) -> Option<Message> {
    (behind >= TRIANGLE).then(|| {
        let what = format!(
            "states {}, which are read, but has {behind} more bytes, enough for {} more",
            counted(promised as u64, "triangle"),
            behind / TRIANGLE
        );
        message![what; "export it again if something is missing"]
    })
}

/// The contents of a binary file.
struct StlNumbers<'a> {
    /// As many triangles as the file states.
    triangles: &'a [[u8; TRIANGLE]],
    bytes_behind: usize,
}

/// The numbers of a binary file; `None` for text. Binary files may begin with "solid", too, so the size decides.
fn triangles_of(bytes: &[u8]) -> Result<Option<StlNumbers<'_>>, Message> {
    let is_text = words(bytes.get(..200.min(bytes.len())).unwrap_or_default())
        .next()
        .is_some_and(|word| as_ascii(word.to_vec()).eq_ignore_ascii_case(b"solid"))
        || bytes.starts_with(&[0xFF, 0xFE])
        || bytes.starts_with(&[0xFE, 0xFF]);
    let count = bytes.get(HEADER - 4..).and_then(<[u8]>::first_chunk).map(|four| u32::from_le_bytes(*four) as usize);
    let (Some(count), Some(body)) = (count, bytes.get(HEADER..)) else {
        return if is_text { Ok(None) } else { Err(message!["is no STL file"; "export it again"]) };
    };
    let (triangles, rest) = body.as_chunks();
    if triangles.len() == count && rest.is_empty() {
        return Ok(Some(StlNumbers { triangles, bytes_behind: 0 }));
    }
    if is_text {
        return Ok(None);
    }
    let bytes_behind = body.len().saturating_sub(TRIANGLE * count);
    triangles.get(..count).map(|triangles| Some(StlNumbers { triangles, bytes_behind })).ok_or_else(|| {
        let what = format!("states {count} triangles, but has {}", triangles.len());
        message![what; "the file is cut off or damaged: copy or export it again"]
    })
}

fn of_numbers(triangles: &[[u8; TRIANGLE]], path: &Path, options: &ReadOptions) -> Model {
    let (mut part, mut tally) = (named(stem(path)), LeftOutTally::default());
    for triangle in triangles {
        let numbers = triangle.get(12..48).unwrap_or_default().as_chunks().0;
        let mut numbers = numbers.iter().map(|four| f64::from(f32::from_le_bytes(*four)));
        let mut corner = || DVec3::from_array([(); 3].map(|()| numbers.next().unwrap_or_default()));
        let corners = [corner(), corner(), corner()];
        if corners.iter().all(|corner| corner.is_finite()) {
            push(&mut part, &corners, &[[0, 1, 2]]);
        } else {
            tally.add("triangles", "a coordinate is not a number");
        }
    }
    note_floats(&mut part, options.told_step(1.0));
    Model { parts: vec![part], left_out: tally.into_left_out(), ..Model::default() }
}

fn named(name: String) -> Part {
    Part { aliases: vec![name.clone()], name, ..Part::default() }
}

fn push(part: &mut Part, corners: &[DVec3], triangles: &[[u32; 3]]) {
    // fits: a file has at most 4 GiB, and a corner more than ten bytes
    let first = part.positions.len() as u32;
    part.positions.extend_from_slice(corners);
    part.triangles.extend(triangles.iter().map(|triangle| triangle.map(|corner| first + corner)));
}

/// The contents of a text so far.
struct StlText {
    parts: Vec<Part>,
    /// The corners of the current facet.
    corners: Vec<DVec3>,
    is_in_facet: bool,
    is_in_solid: bool,
    cutter: FaceCutter,
    left_out: LeftOutTally,
}

fn of_text(source: &[u8], path: &Path) -> Result<Model, Message> {
    let mut text = StlText {
        parts: Vec::new(),
        corners: Vec::new(),
        is_in_facet: false,
        is_in_solid: false,
        cutter: FaceCutter::new(),
        left_out: LeftOutTally::default(),
    };
    let mut lines = TextLines::new(source);
    while let Some(line) = lines.next() {
        text.line(line, lines.number, path)?;
    }
    if text.is_in_facet {
        let what = format!("is cut off in line {}", lines.number);
        return Err(message![what; "copy or export it again"]);
    }
    let mut model = Model::default();
    for part in text.parts {
        if part.triangles.is_empty() {
            text.left_out.add("solid", "empty");
        } else {
            model.parts.push(part);
        }
    }
    if text.is_in_solid {
        model.notes.push(message!["ends without `endsolid`, so it may be cut off"; "copy or export it again if it is"]);
    }
    model.notes.extend(text.cutter.crossing_note());
    model.left_out = text.left_out.into_left_out();
    Ok(model)
}

impl StlText {
    fn line(&mut self, line: &[u8], number: usize, path: &Path) -> Result<(), Message> {
        let Some((word, rest)) = keyword(line) else { return Ok(()) };
        match word.to_ascii_lowercase().as_slice() {
            b"solid" => {
                let name = label(&text(rest));
                let name = if name.is_empty() { unnamed(path, self.parts.len()) } else { name };
                self.open(name)?;
            }
            b"facet" => {
                self.corners.clear();
                self.is_in_facet = true;
            }
            b"vertex" if self.is_in_facet => self.corners.push(corner(words(rest), number)?),
            b"endfacet" if self.is_in_facet => self.close_facet(path)?,
            b"endsolid" => self.is_in_solid = false,
            b"outer" | b"endloop" | b"color" => (),
            _ => return Err(wrong_line(number, "is not a line of STL")),
        }
        Ok(())
    }

    fn open(&mut self, name: String) -> Result<(), Message> {
        self.is_in_solid = true;
        self.parts.push(named(name));
        if self.parts.len() > MAX_COMPONENTS {
            let what = format!("has more than {MAX_COMPONENTS} solids");
            return Err(message![what; "join them, and export it again"]);
        }
        Ok(())
    }

    fn close_facet(&mut self, path: &Path) -> Result<(), Message> {
        self.is_in_facet = false;
        if !self.is_in_solid {
            self.open(unnamed(path, self.parts.len()))?;
        }
        let triangles = self.cutter.polygon(&self.corners, &mut self.left_out);
        if let Some(part) = self.parts.last_mut().filter(|_| !triangles.is_empty()) {
            push(part, &self.corners, triangles);
        }
        Ok(())
    }
}

/// The name of a solid without a name.
fn unnamed(path: &Path, before: usize) -> String {
    if before == 0 { stem(path) } else { format!("solid {}", before + 1) }
}

fn corner<'a>(mut words: impl Iterator<Item = &'a [u8]>, line: usize) -> Result<DVec3, Message> {
    let mut next =
        || words.next().and_then(number).ok_or_else(|| wrong_line(line, "does not have three numbers for a vertex"));
    Ok(DVec3::new(next()?, next()?, next()?))
}
