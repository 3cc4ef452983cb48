//! Reads Wavefront OBJ with its MTL: one part per object or group, and material.
//!
//! The reader is our own: `tobj` reads only UTF-8, stops at unknown numbers, and does not triangulate polygons. `faces`
//! reads the geometry, `material` the libraries.

mod faces;
mod material;

use super::source::{TextLines, as_ascii, text};
use super::vertices::VertexPicker;
use super::whole::whole_file;
use super::{Format, Model, ModelFault, ReadOptions, SeeThrough};
use crate::mesh::Part;
use crate::message::{few, message};
use faces::{ObjGeometry, ObjTriangles};
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Wavefront OBJ, `.obj`.
pub(super) struct Obj;

impl Format for Obj {
    fn name(&self) -> &'static str {
        "OBJ"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["obj"]
    }

    /// OBJ files have no magic number.
    fn begins(&self, _head: &[u8]) -> bool {
        false
    }

    fn read(&self, path: &Path, _options: &ReadOptions) -> Result<Model, ModelFault> {
        let source = as_ascii(whole_file(path)?);
        Ok(model_of(ObjGeometry::read(&source)?, path))
    }

    fn named_by(&self, path: &Path) -> Vec<PathBuf> {
        let Ok(source) = whole_file(path) else { return Vec::new() };
        let source = as_ascii(source);
        let lines = TextLines::new(&source).filter_map(|line| line.trim_ascii_start().strip_prefix(b"mtllib"));
        let libraries: Vec<PathBuf> = lines.flat_map(|names| material::beside_each(path, &text(names))).collect();
        let textures: Vec<PathBuf> = libraries.iter().flat_map(|library| material::textures(library)).collect();
        libraries.into_iter().chain(textures).collect()
    }
}

fn model_of(geometry: ObjGeometry, path: &Path) -> Model {
    let ObjGeometry { positions, parts, names, libraries, cutter, left_out: tally, odd_number, .. } = geometry;
    let mut model = Model::default();
    let (faded, missing) = material::see_through(path, &libraries);
    let (built, see_through) = build(&positions, parts, &names, &faded);
    model.parts = built;
    model.see_through = see_through;
    model.notes.extend(cutter.crossing_note());
    model.left_out = tally.into_left_out();
    if !missing.is_empty() && model.parts.iter().any(|part| part.aliases.len() > 1) {
        model.notes.push(message![
            format!("has its materials in {}, which cannot be read, so it is not known which of them are see-through", few(missing));
            "if there is glass, put the file beside the model"
        ]);
    }
    if let Some((line, word)) = odd_number {
        let what = format!(
            "has malformed numbers, the first in line {line}: `{word}` is read up to where it stops being a number"
        );
        model.notes.push(message![what; "if that is a coordinate, export it again"]);
    }
    model
}

/// Makes the parts with their names, and finds those with a see-through material.
fn build(
    positions: &[glam::DVec3],
    found: Vec<ObjTriangles>,
    names: &[String],
    faded: &std::collections::BTreeSet<String>,
) -> (Vec<Part>, Vec<SeeThrough>) {
    let mut materials_of: FxHashMap<[u32; 2], u32> = FxHashMap::default();
    let found: Vec<ObjTriangles> = found.into_iter().filter(|part| !part.triangles.is_empty()).collect();
    for part in &found {
        *materials_of.entry([part.object, part.group]).or_default() += 1;
    }
    let name = |number: u32| names.get(number as usize).map(String::as_str).filter(|name| !name.is_empty());
    let (mut parts, mut see_through) = (Vec::new(), BTreeMap::<String, Vec<usize>>::new());
    let mut picker = VertexPicker::default();
    for ObjTriangles { object, group, material, mut triangles } in found {
        let node = match (name(object), name(group)) {
            (Some(object), Some(group)) if object != group => format!("{object}/{group}"),
            (Some(name), _) | (None, Some(name)) => name.to_owned(),
            (None, None) => "default".to_owned(),
        };
        let material = name(material);
        let is_one = materials_of.get(&[object, group]).is_none_or(|&count| count == 1);
        let mut part = Part { positions: picker.pick(positions, &mut triangles), triangles, ..Part::default() };
        part.name = match material {
            Some(material) if !is_one => format!("{node}/{material}"),
            _ => node.clone(),
        };
        let groups = name(group).into_iter().flat_map(|names| {
            let several = names.contains(' ').then(|| names.split(' ')).into_iter().flatten();
            [names].into_iter().chain(several)
        });
        for alias in [node.as_str()].into_iter().chain(name(object)).chain(groups).chain(material) {
            if !part.aliases.iter().any(|known| known == alias) {
                part.aliases.push(alias.to_owned());
            }
        }
        if let Some(material) = material.filter(|material| faded.contains(*material)) {
            see_through.entry(material.to_owned()).or_default().push(parts.len());
        }
        parts.push(part);
    }
    let see_through = see_through.into_iter().map(|(material, parts)| SeeThrough { material, parts }).collect();
    (parts, see_through)
}
