//! The list of all formats; a file is read as the one that it is.

use super::format::{Format, HEAD_BYTES};
use super::left_out::listed;
use super::limits::{MAX_COMPONENTS, MAX_TRIANGLES};
use super::model::{Model, ModelError, ModelFault, ReadOptions};
use super::{citygml, cityjson, companion, dae, dxf, footprints, gltf, ifc, obj, ply, refused, stl, terrain, tiles3d};
use crate::message::message;
use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};

/// All formats, in the order in which they are tried. Formats with a mark at their beginning come first: a file with
/// that mark is theirs, whatever follows. A format that is recognised by words near its beginning could find them in
/// another format's file as well, so the loose ones (JSON, XML, ASCII grid, OBJ) come last.
pub const FORMATS: &[&dyn Format] = &[
    &gltf::Gltf,
    &ifc::Ifc,
    &footprints::FlatGeobuf,
    &footprints::Shapefile,
    &terrain::GeoTiff,
    &terrain::LasPoints,
    &ply::Ply,
    // by words of their own
    &dxf::Dxf,
    &stl::Stl,
    // JSON, by its keys
    &cityjson::CityJson,
    &tiles3d::Tiles3d,
    &footprints::GeoJson,
    // XML, by its root
    &citygml::CityGml,
    &terrain::LandXml,
    &dae::Dae,
    &terrain::AsciiGrid,
    // by its name's ending alone
    &obj::Obj,
];

/// The format to which the ending of a file's name belongs.
pub fn by_ending(path: &Path) -> Option<&'static dyn Format> {
    let ending = path.extension()?.to_string_lossy().to_lowercase();
    FORMATS.iter().copied().find(|format| format.endings().contains(&ending.as_str()))
}

fn by_content(head: &[u8]) -> Option<&'static dyn Format> {
    FORMATS.iter().copied().find(|format| format.begins(head))
}

/// The bytes by which a file's format is known.
fn head_of(path: &Path) -> std::io::Result<Vec<u8>> {
    let mut head = Vec::new();
    File::open(path)?.take(HEAD_BYTES).read_to_end(&mut head)?;
    Ok(head)
}

/// Whether a path names a model and no site file: its name ends as those of a format, or it is a file whose content is
/// of one. A site file may be called anything: what is called JSON or XML and begins as neither is none of these.
pub(crate) fn is_model(path: &Path) -> bool {
    let ends = |endings: &[&str]| {
        path.extension().is_some_and(|own| endings.iter().any(|ending| own.eq_ignore_ascii_case(ending)))
    };
    // asked before opening: opening a pipe would wait for its writer
    let head = || path.is_file().then(|| head_of(path).ok()).flatten();
    let is_text = |head: &[u8]| {
        let text = head.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(head).trim_ascii_start();
        // UTF-16 begins with its mark
        text.first().is_none_or(|first| b"{<\xFF\xFE".contains(first))
    };
    match by_ending(path) {
        _ if ends(&["toml"]) => false,
        Some(_) => !ends(&["json", "xml"]) || head().is_none_or(|head| is_text(&head)),
        None => head().is_some_and(|head| by_content(&head).is_some()),
    }
}

/// Which keys of a model the format of that name uses, of those that not all do; none where there is no such format.
pub(crate) fn keys_of(name: &str) -> Option<&'static [&'static str]> {
    FORMATS.iter().find(|format| format.name() == name).map(|format| format.keys())
}

/// The format of a file: its content decides, then how its name ends.
pub(super) fn format_of(path: &Path) -> Result<&'static dyn Format, ModelFault> {
    // Asked before opening: opening a pipe would wait for its writer.
    let is_file = std::fs::metadata(path).map_err(ModelFault::unreadable)?.is_file();
    if !is_file {
        return Err(message!["is not a file"; "name a model file"].into());
    }
    let head = head_of(path).map_err(ModelFault::unreadable)?;
    if let Some(format) = by_content(&head) {
        // the index of a shapefile begins as the shapes do
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

/// Reads a file as one of a format.
pub(super) fn read_as(format: &dyn Format, path: &Path, options: &ReadOptions) -> Result<Model, ModelFault> {
    checked(Model { format: format.name(), ..format.read(path, options)? })
}

/// The model, where it holds to what every reader promises.
fn checked(model: Model) -> Result<Model, ModelFault> {
    let triangles = model.triangles();
    if triangles == 0 {
        let lost = match listed(&model.left_out) {
            lost if lost.is_empty() => lost,
            lost => format!(" ({lost})"),
        };
        let what = format!("has no triangles, so nothing casts a shadow{lost}");
        return Err(message![what; "export what stands there as a mesh or as solids"].into());
    }
    if triangles > MAX_TRIANGLES {
        let what = format!("has {triangles} triangles, and a model may have {MAX_TRIANGLES}");
        return Err(message![what; "export it in parts or with less detail"].into());
    }
    let corners: u64 = model.parts.iter().map(|part| part.positions.len() as u64).sum();
    if corners > 3 * MAX_TRIANGLES {
        let what = format!("has {corners} corners, more than {MAX_TRIANGLES} triangles can have");
        return Err(message![what; "export it without points that no face has"].into());
    }
    if model.parts.len() > MAX_COMPONENTS {
        let what = format!("has {} components, and a model may have {MAX_COMPONENTS}", model.parts.len());
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

/// The files that a model names beside itself. One that cannot be read names none: whoever reads it says why.
pub(crate) fn named_by(path: &Path) -> Vec<PathBuf> {
    format_of(path).map_or_else(|_| Vec::new(), |format| format.named_by(path))
}
