//! Reads PLY, ASCII or binary of either byte order, as one part.
//!
//! `header` finds the tables of the file, `body` reads the numbers.

mod body;
mod header;

use super::face_cutter::FaceCutter;
use super::left_out::LeftOutTally;
use super::source::stem;
use super::vertices::{VertexPicker, note_floats};
use super::whole::whole_file;
use super::{Format, MAX_TRIANGLES, Model, ModelFault, ReadOptions, Up};
use crate::mesh::Part;
use crate::message::{Message, message};
use body::PlyTables;
use glam::DVec3;
use header::PlyHeader;
use std::path::Path;

/// PLY, `.ply`.
pub(super) struct Ply;

impl Format for Ply {
    fn name(&self) -> &'static str {
        "PLY"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["ply"]
    }

    fn begins(&self, head: &[u8]) -> bool {
        head.starts_with(b"ply\n") || head.starts_with(b"ply\r")
    }

    fn read(&self, path: &Path, options: &ReadOptions) -> Result<Model, ModelFault> {
        let bytes = whole_file(path)?;
        let (header, body) = PlyHeader::read(&bytes)?;
        let tables = PlyTables::read(&header, body)?;
        Ok(model_of(tables, path, header.has_floats(), options)?)
    }
}

fn model_of(tables: PlyTables, path: &Path, has_floats: bool, options: &ReadOptions) -> Result<Model, Message> {
    let PlyTables { positions, polygons, strips } = tables;
    if polygons.is_empty() && strips.is_empty() && !positions.is_empty() {
        let what = format!("is a cloud of {} points without faces, but points cast no shadow", positions.len());
        return Err(message![what; "make a mesh from it, or for terrain a raster or a TIN"]);
    }
    let (mut cutter, mut tally) = (FaceCutter::new(), LeftOutTally::default());
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    let mut corners: Vec<DVec3> = Vec::new();
    for polygon in polygons.iter() {
        corners.clear();
        corners.extend(polygon.iter().filter_map(|&vertex| positions.get(vertex as usize)));
        let cut = cutter.polygon(&corners, &mut tally);
        let vertex = |corner: u32| polygon.get(corner as usize).copied().unwrap_or(0);
        triangles.extend(cut.iter().map(|triangle| triangle.map(vertex)));
        if triangles.len() as u64 > MAX_TRIANGLES {
            let what = format!("has more than {MAX_TRIANGLES} triangles");
            return Err(message![what; "export it in parts or with less detail"]);
        }
    }
    for strip in strips.iter() {
        triangles.extend(of_strip(strip));
    }
    let positions = VertexPicker::default().pick(&positions, &mut triangles);
    let name = stem(path);
    let mut part = Part { aliases: vec![name.clone()], name, positions, triangles, ..Part::default() };
    if has_floats {
        note_floats(&mut part, options.told_step(1.0));
    }
    let mut model = Model { parts: vec![part], up: Up::Z, ..Model::default() };
    model.notes.extend(cutter.crossing_note());
    model.left_out = tally.into_left_out();
    Ok(model)
}

/// The triangles of a strip. Every second one has the opposite winding; degenerate ones are left out.
pub(super) fn of_strip(strip: &[u32]) -> impl Iterator<Item = [u32; 3]> {
    strip.windows(3).enumerate().filter_map(|(at, three)| match *three {
        [a, b, c] if a != b && b != c && c != a => Some(if at % 2 == 0 { [a, b, c] } else { [b, a, c] }),
        _ => None,
    })
}
