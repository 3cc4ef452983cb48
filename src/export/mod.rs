//! One result in, one file out: drawings, rasters, solids, reports.
//!
//! Every encoder returns bytes and does not touch the disk. [`file::write`] writes them, completely or not at all.

pub mod animation;
pub mod check;
pub mod checksum;
pub mod comparison;
mod contents;
pub mod envelope;
mod error;
pub mod figure;
pub mod file;
mod glb;
pub mod judgement;
pub mod model;
mod model_lines;
mod names;
pub mod patches;
mod places;
pub mod probe;
pub mod raster;
pub mod recovery;
pub mod report;
pub mod totals;
pub mod verify;
pub mod volumes;

pub use error::{ExportError, bytes};

use error::check_size;
