//! Gnomon answers an architect's question: where, when and for how long does a building take the sun away?
//!
//! ```text
//! site file + models ─► Site ─┬─► Mesh ─► Silhouette ─► Volume ─┐
//!                             └─► SunTrack ─────────────────────┴─► Technique ─► Mask ─► Profile ─► drawings, data
//! ```
//!
//! The whole flow is one function, [`study::run`]. The documented items are for programs that use Gnomon as a library,
//! and are stable within a major version: a minor one may add variants to enums that are `#[non_exhaustive]`, and fields
//! to requests, which have a default (`..Overrides::default()`). All other public items serve the program's own parts
//! and tests.
//!
//! # Three doors
//!
//! The examples run from the repository: `cargo run --example site-in-memory`. [`chrono`] and [`glam`], whose types
//! they use, are re-exported. Without the feature `desktop` no window is built.
//!
//! ## A site made in memory
//!
//! [`site::Site::in_memory`] takes a place, a mesh of named parts, the instants and the plan. A mesh uses the middle of
//! its parts as its origin; [`mesh::Mesh::build_around`] takes a different one.
//!
//! ```no_run
#![doc = include_str!("../examples/site-in-memory.rs")]
//! ```
//!
//! ## A study and its sums
//!
//! [`study::run`] returns the [`profile::Profile`]: [`profile::Shaded::in_one_word`] is the slice of sums,
//! [`view::Grid::transform`] its transform. To distribute a study, [`study::TiledStudy::sum`] computes one tile at some
//! instants, whose fields are plain data ([`sun::Instant`]); [`study::TiledStudy::number`] is the study's fingerprint.
//! Equal inputs give the same number on all machines and with all compilers; the inputs include Gnomon's version, the
//! engine, the adapter's name, the tiles, the masks' folder, and every bit of the models and of the sun's directions.
//!
//! ```no_run
#![doc = include_str!("../examples/sums-of-a-study.rs")]
//! ```
//!
//! ## One sun, one mask
//!
//! A [`shadow::Technique`] is made for a [`shadow::Scene`] and a [`view::View`], and draws a [`view::Mask`] for any
//! direction of the sun above the horizon. [`shadow::ray_cast`] and [`shadow::projected`] need no graphics adapter; the
//! others use an open [`gpu::Gpu`].
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

// The modules in the best order for reading. Each uses only those above it, as a test checks. Modules without a public
// API are hidden in the documentation; `docs/architecture.md` describes all of them.

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
