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
//! # Three doors
//!
//! For programs that use Gnomon as a library. All three run from the repository: `cargo run --example site-in-memory`.
//! [`chrono`] and [`glam`], whose types they speak in, are exported. Without the feature `desktop` there is no window to build.
//!
//! ## A site made in memory
//!
//! [`site::Site::in_memory`] takes a place, a mesh of named parts, the instants and the plan. A mesh takes the middle of its
//! parts as its origin; [`mesh::Mesh::build_around`] takes another one.
//!
//! ```no_run
#![doc = include_str!("../examples/site-in-memory.rs")]
//! ```
//!
//! ## A study and its sums
//!
//! [`study::run`] gives the [`profile::Profile`]: [`profile::Shaded::in_one_word`] is the slice, [`view::Grid::transform`]
//! where it lies. To share a study out, [`study::TiledStudy::sum`] does one tile at some instants, whose fields are plain
//! data ([`sun::Instant`]); [`study::TiledStudy::number`] is the study's fingerprint, the same wherever it is built and
//! runs.
//!
//! ```no_run
#![doc = include_str!("../examples/sums-of-a-study.rs")]
//! ```
//!
//! ## One sun, one mask
//!
//! A [`shadow::Technique`] is made for a [`shadow::Scene`] and a [`view::View`], and draws a [`view::Mask`] for any direction of
//! the sun above the horizon. [`shadow::ray_cast`] and [`shadow::projected`] need no graphics adapter, the others take an open
//! [`gpu::Gpu`].
//!
//! ```no_run
#![doc = include_str!("../examples/mask-of-one-sun.rs")]
//! ```
//!
//! # Frame and units
//!
//! World frame: x east, y north, z up, metres, right-handed. Geometry is `f32` around [`mesh::Mesh::origin`];
//! time, sun and map coordinates are `f64`.

pub use {chrono, glam};

pub mod message;

pub mod choice;
pub mod crs;
pub mod look;
pub mod mesh;
pub mod sun;
pub mod view;

pub mod formats;
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
