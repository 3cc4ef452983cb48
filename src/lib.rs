//! Gnomon answers an architect's question: where, when and for how long does a building take the sun away?
//!
//! ```text
//! site file + models ─► Site ─┬─► Mesh ─► Silhouette ─► Volume ─┐
//!                             └─► SunTrack ─────────────────────┴─► Technique ─► Mask ─► Profile ─► drawings, data
//! ```
//!
//! The whole flow is one function, [`study::run`]. What is documented here is for programs that use Gnomon as a library, and
//! holds from one version to the next of the same number; all else that is public serves the program's own parts and tests.
//!
//! # Three doors
//!
//! All three run from the repository: `cargo run --example site-in-memory`.
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

// The modules in the order in which they are best read; each knows only those above it, and a test says so. Those that are
// no part of a door are hidden in the documentation; `docs/architecture.md` has all of them.

pub mod message;

pub mod choice;
#[doc(hidden)]
pub mod contour;
#[doc(hidden)]
pub mod crs;
#[doc(hidden)]
pub mod look;
pub mod mesh;
pub mod sun;
pub mod view;

#[doc(hidden)]
pub mod rules;

pub mod formats;
pub mod site;

pub mod silhouette;
#[doc(hidden)]
pub mod volume;

pub mod gpu;
pub mod shadow;

#[doc(hidden)]
pub mod picture;

pub mod profile;
#[doc(hidden)]
pub mod sunlight;
#[doc(hidden)]
pub mod verification;

#[doc(hidden)]
pub mod judgement;

pub mod study;

#[doc(hidden)]
pub mod export;

#[doc(hidden)]
pub mod deliver;
#[doc(hidden)]
pub mod fault;

#[doc(hidden)]
pub mod cli;

#[cfg(feature = "desktop")]
#[doc(hidden)]
pub mod desktop;
