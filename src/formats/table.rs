//! The list of all formats, and the choice of a file's format.

use super::format::{Format, HEAD_BYTES};
use super::left_out::listed;
use super::limits::{MAX_COMPONENTS, MAX_TRIANGLES};
use super::model::{Model, ModelError, ModelFault, ReadOptions};
use super::{citygml, cityjson, companion, dae, dxf, footprints, gltf, ifc, obj, ply, refused, stl, terrain, tiles3d};
use crate::message::message;
use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};

/// All formats, in the order in which they are tried. Formats with a magic number come first, as it is certain. Formats
/// that are recognised by words near the beginning could be mistaken for others, so the loosest ones (JSON, XML, ASCII
/// grid, OBJ) come last.
pub const FORMATS: &[&dyn Format] = &[
    &gltf::Gltf,
    &ifc::Ifc,
    &footprints::FlatGeobuf,
    &footprints::Shapefile,
    &terrain::GeoTiff,
    &terrain::LasPoints,
    &ply::Ply,
    // by their own words
    &dxf::Dxf,
    &stl::Stl,
    // JSON, by its keys
    &cityjson::CityJson,
    &tiles3d::Tiles3d,
    &footprints::GeoJson,
    // XML, by its root element
    &citygml::CityGml,
    &terrain::LandXml,
    &dae::Dae,
    &terrain::AsciiGrid,
    // only by its ending
    &obj::Obj,
];

/// The format that an ending belongs to.
pub fn by_ending(path: &Path) -> Option<&'static dyn Format> {
    let ending = path.extension()?.to_string_lossy().to_lowercase();
    FORMATS.iter().copied().find(|format| format.endings().contains(&ending.as_str()))
}

fn by_content(head: &[u8]) -> Option<&'static dyn Format> {
    FORMATS.iter().copied().find(|format| format.begins(head))
}

/// The bytes that identify a file's format.
fn head_of(path: &Path) -> std::io::Result<Vec<u8>> {
    let mut head = Vec::new();
    File::open(path)?.take(HEAD_BYTES).read_to_end(&mut head)?;
    Ok(head)
}

/// Whether a path is a model and not a site file: it has the ending of a format, or its contents have the format. A
/// site file may have any name. A file named as JSON or XML that begins as neither is not a model.
pub(crate) fn is_model(path: &Path) -> bool {
    let ends = |endings: &[&str]| {
        path.extension().is_some_and(|own| endings.iter().any(|ending| own.eq_ignore_ascii_case(ending)))
    };
    // checked before opening: opening a pipe would wait for its writer
    let head = || path.is_file().then(|| head_of(path).ok()).flatten();
    let is_text = |head: &[u8]| {
        let text = head.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(head).trim_ascii_start();
        // UTF-16 begins with a byte-order mark
        text.first().is_none_or(|first| b"{<\xFF\xFE".contains(first))
    };
    match by_ending(path) {
        _ if ends(&["toml"]) => false,
        Some(_) => !ends(&["json", "xml"]) || head().is_none_or(|head| is_text(&head)),
        None => head().is_some_and(|head| by_content(&head).is_some()),
    }
}

/// The keys of a model that the format of a name uses, among those that not all use; `None` for an unknown format.
pub(crate) fn keys_of(name: &str) -> Option<&'static [&'static str]> {
    FORMATS.iter().find(|format| format.name() == name).map(|format| format.keys())
}

/// The format of a file: by its contents, then by its ending.
pub(super) fn format_of(path: &Path) -> Result<&'static dyn Format, ModelFault> {
    // checked before opening: opening a pipe would wait for its writer
    let is_file = std::fs::metadata(path).map_err(ModelFault::unreadable)?.is_file();
    if !is_file {
        return Err(message!["is not a file"; "name a model file"].into());
    }
    let head = head_of(path).map_err(ModelFault::unreadable)?;
    if let Some(format) = by_content(&head) {
        // a shapefile's index begins as its shapes do
        let is_index = format.name() == footprints::Shapefile.name() && by_ending(path).is_none();
        return companion::refusal(path).filter(|_| is_index).map_or(Ok(format), |refusal| Err(refusal.into()));
    }
    if let Some(refusal) = refused::by_content(&head, path) {
        return Err(refusal.into());
    }
    by_ending(path).ok_or_else(|| {
        let names: Vec<&str> = FORMATS.iter().map(|format| format.name()).collect();
        let unknown = || {
            message![
                "is of no format that Gnomon knows";
                format!("export it as one of these: {}", names.join(", "))
            ]
        };
        refused::by_ending(path).or_else(|| companion::refusal(path)).unwrap_or_else(unknown).into()
    })
}

/// Reads a file in a given format.
pub(super) fn read_as(format: &dyn Format, path: &Path, options: &ReadOptions) -> Result<Model, ModelFault> {
    checked(Model { format: format.name(), ..format.read(path, options)? })
}

/// Checks what every reader must guarantee.
fn checked(model: Model) -> Result<Model, ModelFault> {
    let triangles = model.triangles();
    if triangles == 0 {
        let lost = match listed(&model.left_out) {
            lost if lost.is_empty() => lost,
            lost => format!(" ({lost})"),
        };
        let what = format!("has no triangles, so nothing casts a shadow{lost}");
        return Err(message![what; "export it as a mesh or as solids"].into());
    }
    if triangles > MAX_TRIANGLES {
        let what = format!("has {triangles} triangles, but a model may have at most {MAX_TRIANGLES}");
        return Err(message![what; "export it in parts or with less detail"].into());
    }
    let corners: u64 = model.parts.iter().map(|part| part.positions.len() as u64).sum();
    if corners > 3 * MAX_TRIANGLES {
        let what = format!("has {corners} corners, more than {MAX_TRIANGLES} triangles can have");
        return Err(message![what; "export it without unused points"].into());
    }
    if model.parts.len() > MAX_COMPONENTS {
        let what = format!("has {} components, but a model may have at most {MAX_COMPONENTS}", model.parts.len());
        return Err(message![what; "join its objects by material, and export it again"].into());
    }
    Ok(model)
}

/// Reads a model file of any format, in this process. Every part has triangles, and there is at least one part.
/// [`super::ModelReader`] has limits and a cache.
///
/// # Errors
/// What is wrong with the file, with a hint.
pub fn read(path: &Path, options: &ReadOptions) -> Result<Model, ModelError> {
    let read = || read_as(format_of(path)?, path, options);
    read().map_err(|fault| ModelError { file: path.to_owned(), fault })
}

/// The other files that a model refers to; empty if it cannot be read, which its reader reports.
pub(crate) fn named_by(path: &Path) -> Vec<PathBuf> {
    format_of(path).map_or_else(|_| Vec::new(), |format| format.named_by(path))
}
