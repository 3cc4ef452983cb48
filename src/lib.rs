//! Gnomon answers an architect's question: where, when and for how long does a building take the sun away?
//!
//! ```text
//! site file + models ─► Site ─┬─► Mesh ─► Silhouette ─► Volume ─┐
//!                             └─► SunTrack ─────────────────────┴─► Technique ─► Mask ─► Profile ─► drawings, data
//! ```
//!
//! The modules, in the order in which they are best read; each knows only those above it, and a test says so.
//! The whole flow is one function, [`study::run`].
//!
//! World frame: x east, y north, z up, metres, right-handed. Geometry is `f32` around [`mesh::Mesh::origin`];
//! time, sun and map coordinates are `f64`.

pub mod message;

pub mod choice;
pub mod look;
pub mod mesh;
pub mod sun;
pub mod view;

pub mod site;

pub mod silhouette;
pub mod volume;

pub mod gpu;
pub mod shadow;

pub mod picture;

pub mod profile;
pub mod study;

pub mod export;

pub mod deliver;
pub mod fault;

pub mod cli;

#[cfg(feature = "desktop")]
pub mod desktop;
