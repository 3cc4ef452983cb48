//! Model files → models: the one entry point for all formats.
//!
//! A format is a file or a folder of this module that implements [`Format`], and an entry in [`FORMATS`]. It returns a
//! [`Model`] in the file's own units, axes and coordinates, all in `f64`; what it cannot read it counts and names.
//! `site` turns the model into the mesh, so that every model is placed by the same code.
//!
//! A file is never trusted: every index and byte range is checked before it is used, and the size of what is built from
//! it is computed before memory is taken.

mod archive;
mod cache;
pub mod child;
mod city;
mod citygml;
mod cityjson;
mod companion;
mod crs;
mod dae;
mod dxf;
mod encoded;
mod exact;
mod face_cutter;
mod footprints;
mod format;
pub mod gltf;
mod ifc;
mod json_head;
mod left_out;
mod limits;
mod model;
mod model_reader;
mod monotone;
mod names;
mod obj;
mod ply;
mod refused;
mod source;
mod stl;
mod table;
pub mod terrain;
mod tiles3d;
mod vertices;
mod whole;

pub use cache::{CacheEntry, ModelCache};
#[cfg(feature = "desktop")]
pub(crate) use companion::goes_with_one_of;
pub use format::Format;
pub use limits::{MAX_COMPONENTS, MAX_TRIANGLES, ReadLimits};
pub use model::{
    Anchor, AnchorPoint, Coordinates, LeftOut, Model, ModelError, ModelFault, PartKind, ReadOptions, SceneName,
    SeeThrough, Up,
};
pub use model_reader::ModelReader;
pub(crate) use names::{composed, on_disk};
pub(crate) use refused::refusal;
pub use table::{FORMATS, by_ending, read};
pub(crate) use table::{is_model, keys_of, named_by};
pub(crate) use terrain::POINT_CLASSES;
