//! Model files → what stands in them: one door for all formats.
//!
//! A format is a file or a folder of this room that implements [`Format`], and an entry in [`FORMATS`]. Whatever it reads,
//! it gives a [`Model`] in the file's own units, axes and coordinates, all in `f64`; what it cannot take it counts and
//! names. `site` turns that into the mesh, so that every model is placed by the same code.
//!
//! A file is never trusted: every index and byte range is checked before it is used, and what is made of it is counted
//! before memory is taken.

mod cache;
pub mod child;
mod city;
mod citygml;
mod cityjson;
mod crs;
mod dae;
mod dxf;
mod encoded;
mod exact;
mod footprints;
pub mod gltf;
mod ifc;
mod json_head;
mod left_out;
mod model;
mod model_reader;
mod names;
mod obj;
mod ply;
mod polygon;
mod refused;
mod rings;
mod source;
mod stl;
pub mod terrain;
mod tiles3d;
mod vertices;
mod whole;

pub use cache::{CacheEntry, ModelCache};
pub use model::{
    Anchor, AnchorPoint, Coordinates, LeftOut, Model, ModelError, ModelFault, PartKind, ReadOptions, SceneName,
    SeeThrough, Up,
};
pub use model_reader::{ModelReader, ReadLimits};
pub(crate) use names::{composed, on_disk};
pub(crate) use refused::refusal;
pub(crate) use terrain::POINT_CLASSES;

use crate::message::message;
use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};

/// The most triangles a model may have, instances counted. Their vertices take at most 7.2 GB, their indices 1.2 GB.
pub const MAX_TRIANGLES: u64 = 100_000_000;

/// The most components a model may have: each costs names and adjacency of its own, whatever its size.
pub const MAX_COMPONENTS: usize = 1_000_000;

/// Bytes at a file's start that tell its format.
const HEAD_BYTES: u64 = 16 * 1024;

/// A format of model files.
pub trait Format: Sync {
    /// What people call it.
    fn name(&self) -> &'static str;

    /// How its files' names end: lower-case, without the dot, the commonest first.
    fn endings(&self) -> &'static [&'static str];

    /// Whether a file that begins with these bytes (as many as there are, at most 16 KiB) is of this format. Only what other
    /// formats cannot begin with is a yes.
    fn begins(&self, head: &[u8]) -> bool;

    /// Reads a file; there may be no part in it.
    ///
    /// # Errors
    /// What is wrong with the file, with the way out.
    fn read(&self, path: &Path, options: &ReadOptions) -> Result<Model, ModelFault>;

    /// Whether the reader is others' code, which runs in a process of its own with limits.
    fn is_foreign(&self) -> bool {
        false
    }

    /// Whether what was read is kept, as reading the file takes longer than reading that back.
    fn is_kept(&self) -> bool {
        self.is_foreign()
    }

    /// Which keys of a model it uses, of those that not all formats do.
    fn keys(&self) -> &'static [&'static str] {
        &[]
    }

    /// The files that a file names: they lie beside it, and are its user's, whether they are read or not.
    fn named_by(&self, _path: &Path) -> Vec<PathBuf> {
        Vec::new()
    }
}

/// All formats, those that begin with a mark of their own first.
pub const FORMATS: &[&dyn Format] = &[
    &gltf::Gltf,
    &ifc::Ifc,
    &cityjson::CityJson,
    &citygml::CityGml,
    &tiles3d::Tiles3d,
    &footprints::FlatGeobuf,
    &footprints::Shapefile,
    &footprints::GeoJson,
    &terrain::GeoTiff,
    &terrain::LasPoints,
    &terrain::LandXml,
    &terrain::AsciiGrid,
    &dae::Dae,
    &dxf::Dxf,
    &ply::Ply,
    &stl::Stl,
    &obj::Obj,
];

/// The format whose files end as this one's name does.
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

/// Whether a path names a model and no site file: its name ends as those of a format, or it is a file whose content is of
/// one.
pub(crate) fn is_model(path: &Path) -> bool {
    let is_site = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml"));
    let begins = || path.is_file() && head_of(path).is_ok_and(|head| by_content(&head).is_some());
    !is_site && (by_ending(path).is_some() || begins())
}

/// Which keys of a model the format of that name uses, of those that not all do; none where there is no such format.
pub(crate) fn keys_of(name: &str) -> Option<&'static [&'static str]> {
    FORMATS.iter().find(|format| format.name() == name).map(|format| format.keys())
}

/// The format of a file: its content decides, then how its name ends.
fn format_of(path: &Path) -> Result<&'static dyn Format, ModelFault> {
    // Asked before opening: opening a pipe would wait for its writer.
    let is_file = std::fs::metadata(path).map_err(ModelFault::unreadable)?.is_file();
    if !is_file {
        return Err(message!["is not a file"; "name a model file"].into());
    }
    let head = head_of(path).map_err(ModelFault::unreadable)?;
    if let Some(format) = by_content(&head) {
        return Ok(format);
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
        refused::by_ending(path).unwrap_or_else(unknown).into()
    })
}

/// Reads a file as one of a format.
fn read_as(format: &dyn Format, path: &Path, options: &ReadOptions) -> Result<Model, ModelFault> {
    Model { format: format.name(), ..format.read(path, options)? }.checked()
}

/// Reads a model file of any format, in this process; every part has triangles, and there is at least one. [`ModelReader`] has
/// limits and a cache.
///
/// # Errors
/// What is wrong with the file, with the way out.
pub fn read(path: &Path, options: &ReadOptions) -> Result<Model, ModelError> {
    let read = || read_as(format_of(path)?, path, options);
    read().map_err(|fault| ModelError { file: path.to_owned(), fault })
}

/// The files that a model names beside itself. One that cannot be read names none: whoever reads it says why.
pub(crate) fn named_by(path: &Path) -> Vec<PathBuf> {
    format_of(path).map_or_else(|_| Vec::new(), |format| format.named_by(path))
}
