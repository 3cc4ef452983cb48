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
#[doc(hidden)]
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
#[doc(hidden)]
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
#[doc(hidden)]
pub mod terrain;
mod tiles3d;
mod vertices;
mod whole;

#[doc(hidden)]
pub use cache::CacheEntry;
pub use cache::ModelCache;
#[cfg(feature = "desktop")]
pub(crate) use companion::goes_with_one_of;
pub(crate) use footprints::{NamedOutline, OutlineFile, read_outlines};
#[doc(hidden)]
pub use format::Format;
pub use limits::ReadLimits;
#[doc(hidden)]
pub use limits::{MAX_COMPONENTS, MAX_TRIANGLES};
#[doc(hidden)]
pub use model::{Anchor, AnchorPoint, Coordinates, LeftOut, Model, PartKind, ReadOptions, SceneName, SeeThrough};
pub use model::{ModelError, ModelFault, Up};
pub use model_reader::ModelReader;
pub(crate) use names::{composed, on_disk};
pub(crate) use refused::refusal;
#[doc(hidden)]
pub use table::{FORMATS, by_ending, read};
pub(crate) use table::{is_model, keys_of, named_by};
pub(crate) use terrain::POINT_CLASSES;
