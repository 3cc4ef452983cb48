//! Reads the lines of an OBJ file as vertices, and as triangles by object, group and material.

use crate::formats::face_cutter::FaceCutter;
use crate::formats::left_out::{LeftOutTally, label};
use crate::formats::source::{TextLines, keyword, number, text, words, wrong_line};
use crate::formats::{MAX_COMPONENTS, MAX_TRIANGLES};
use crate::message::{Message, message};
use glam::DVec3;
use rustc_hash::FxHashMap;
use std::borrow::Cow;

/// The triangles of one object, group and material, as the file's vertices. Names are indices; 0 means none.
pub(super) struct ObjTriangles {
    pub object: u32,
    pub group: u32,
    pub material: u32,
    pub triangles: Vec<[u32; 3]>,
}

/// The contents of an OBJ file.
pub(super) struct ObjGeometry {
    pub positions: Vec<DVec3>,
    pub parts: Vec<ObjTriangles>,
    /// The names of objects, groups and materials.
    pub names: Vec<String>,
    /// The files named by `mtllib`, one line each.
    pub libraries: Vec<String>,
    pub cutter: FaceCutter,
    pub left_out: LeftOutTally,
    /// The first word that begins with a number but is not one, and its line.
    pub odd_number: Option<(usize, String)>,
    numbers_of: FxHashMap<String, u32>,
    part_of: FxHashMap<[u32; 3], usize>,
    /// The current object, group and material, and the index of their triangles once there are some.
    at: [u32; 3],
    part: Option<usize>,
    corners: Vec<u32>,
    points: Vec<DVec3>,
    triangles: u64,
}

impl ObjGeometry {
    pub(super) fn read(source: &[u8]) -> Result<Self, Message> {
        let mut geometry = Self {
            positions: Vec::new(),
            parts: Vec::new(),
            names: vec![String::new()],
            libraries: Vec::new(),
            cutter: FaceCutter::new(),
            left_out: LeftOutTally::default(),
            odd_number: None,
            numbers_of: FxHashMap::default(),
            part_of: FxHashMap::default(),
            at: [0; 3],
            part: None,
            corners: Vec::new(),
            points: Vec::new(),
            triangles: 0,
        };
        let mut lines = TextLines::new(source);
        while let Some(line) = whole_line(&mut lines) {
            if let Some((word, rest)) = keyword(&line) {
                geometry.line(word, rest, lines.number)?;
            }
        }
        Ok(geometry)
    }

    fn line(&mut self, word: &[u8], rest: &[u8], line: usize) -> Result<(), Message> {
        match word {
            b"v" => self.vertex(rest, line),
            b"f" | b"fo" => self.face(rest, line),
            b"o" => self.enter(0, rest),
            b"g" => self.enter(1, rest),
            b"usemtl" => self.enter(2, rest),
            b"mtllib" => {
                self.libraries.push(text(rest.trim_ascii()));
                Ok(())
            }
            b"l" | b"p" => {
                self.left_out.add(if word == b"l" { "lines" } else { "points" }, "they have no surface");
                Ok(())
            }
            b"curv" | b"curv2" | b"surf" => {
                self.left_out.add("free-form curves and surfaces", "only meshes are read: export it as a mesh");
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn vertex(&mut self, rest: &[u8], line: usize) -> Result<(), Message> {
        let mut numbers = words(rest);
        let mut next = || -> Result<f64, Message> {
            let Some(word) = numbers.next() else {
                return Err(wrong_line(line, "has a vertex of fewer than three numbers"));
            };
            if let Some(number) = number(word) {
                return Ok(number);
            }
            let odd = odd_number(word).ok_or_else(|| not_a_number(word, line))?;
            self.odd_number.get_or_insert_with(|| (line, label(&text(word))));
            Ok(odd)
        };
        let position = DVec3::new(next()?, next()?, next()?);
        if self.positions.len() >= u32::MAX as usize {
            return Err(message!["has more than 4 billion vertices"; "export it in parts"]);
        }
        self.positions.push(position);
        Ok(())
    }

    fn face(&mut self, rest: &[u8], line: usize) -> Result<(), Message> {
        self.corners.clear();
        self.points.clear();
        for word in words(rest) {
            let (vertex, point) = self.corner(word, line)?;
            self.corners.push(vertex);
            self.points.push(point);
        }
        let triangles = self.cutter.polygon(&self.points, &mut self.left_out);
        if triangles.is_empty() {
            return Ok(());
        }
        self.triangles += triangles.len() as u64;
        if self.triangles > MAX_TRIANGLES {
            let what = format!("has more than {MAX_TRIANGLES} triangles");
            return Err(message![what; "export it in parts or with less detail"]);
        }
        let corners = &self.corners;
        let vertex = |corner: u32| corners.get(corner as usize).copied().unwrap_or(0);
        let cut = triangles.iter().map(|triangle| triangle.map(vertex));
        let part = match self.part {
            Some(part) => part,
            None => {
                let [object, group, material] = self.at;
                let parts = &mut self.parts;
                let part = *self.part_of.entry(self.at).or_insert_with(|| {
                    parts.push(ObjTriangles { object, group, material, triangles: Vec::new() });
                    parts.len() - 1
                });
                *self.part.insert(part)
            }
        };
        if let Some(part) = self.parts.get_mut(part) {
            part.triangles.extend(cut);
        }
        if self.parts.len() > MAX_COMPONENTS {
            let what = format!("has more than {MAX_COMPONENTS} components");
            return Err(message![what; "join its objects by material, and export it again"]);
        }
        Ok(())
    }

    /// The vertex of a face's corner, `12/5/7` or `-1`: counted from 1, or backwards from the last one.
    fn corner(&self, word: &[u8], line: usize) -> Result<(u32, DVec3), Message> {
        let count = self.positions.len();
        let name = word.split(|&byte| byte == b'/').next().unwrap_or_default();
        let index = match name.strip_prefix(b"-") {
            Some(back) => whole(back).filter(|&back| back > 0).and_then(|back| count.checked_sub(back)),
            None => whole(name.strip_prefix(b"+").unwrap_or(name)).and_then(|number| number.checked_sub(1)),
        };
        match index.and_then(|index| Some((index as u32, *self.positions.get(index)?))) {
            Some(corner) => Ok(corner),
            None => {
                let name = label(&text(word));
                Err(wrong_line(line, &format!("has a face with vertex {name}, when there are {count} vertices,")))
            }
        }
    }

    /// Switches to another object, group or material.
    fn enter(&mut self, which: usize, rest: &[u8]) -> Result<(), Message> {
        let name = match which {
            1 => words(rest).map(|word| label(&text(word))).collect::<Vec<_>>().join(" "),
            _ => text(rest),
        };
        let name = label(&name);
        let number = match self.numbers_of.get(&name) {
            Some(&number) => number,
            None if name.is_empty() => 0,
            None => {
                let number = self.names.len() as u32;
                self.names.push(name.clone());
                self.numbers_of.insert(name, number);
                number
            }
        };
        if let Some(at) = self.at.get_mut(which) {
            *at = number;
        }
        self.part = None;
        Ok(())
    }
}

/// A line with its continuations: a backslash at its end continues it.
fn whole_line<'a>(lines: &mut TextLines<'a>) -> Option<Cow<'a, [u8]>> {
    let first = lines.next()?;
    let Some(begun) = first.trim_ascii_end().strip_suffix(b"\\") else {
        return Some(Cow::Borrowed(first));
    };
    let mut whole = begun.to_vec();
    for line in lines.by_ref() {
        let continued = line.trim_ascii_end().strip_suffix(b"\\");
        whole.push(b' ');
        whole.extend_from_slice(continued.unwrap_or(line));
        if continued.is_none() {
            break;
        }
    }
    Some(Cow::Owned(whole))
}

/// A number from 0, of digits only.
fn whole(digits: &[u8]) -> Option<usize> {
    let add = |number: usize, digit: &u8| {
        let digit = digit.is_ascii_digit().then(|| usize::from(digit - b'0'))?;
        number.checked_mul(10)?.checked_add(digit)
    };
    digits.iter().try_fold(0, add).filter(|_| !digits.is_empty())
}

/// The number at the beginning of a word that is not wholly a number, as C's functions read it. A comma is refused: it
/// may be meant as a decimal point.
fn odd_number(word: &[u8]) -> Option<f64> {
    if word.contains(&b',') || word.len() > 100 {
        return None;
    }
    (1..word.len()).rev().find_map(|end| number(word.get(..end)?))
}

fn not_a_number(word: &[u8], line: usize) -> Message {
    let word = label(&text(word));
    let what = format!("has `{word}` instead of a number in line {line}");
    if word.contains(',') {
        return message![what; "export it with decimal points: numbers have no commas in OBJ"];
    }
    message![what; "the file is damaged or was edited: export it again"]
}
