//! One answer in, one file out: drawings, rasters, solids, reports.
//!
//! Every encoder returns bytes and touches no disk; [`file::write`] puts them there, whole or not at all.

pub mod animation;
pub mod bits;
pub mod check;
pub mod comparison;
pub mod figure;
pub mod file;
mod places;
pub mod probe;
pub mod raster;
pub mod report;
pub mod sums;
pub mod surfaces;
pub mod unfinished;
pub mod verify;
pub mod volumes;

use std::path::PathBuf;

/// Why an answer did not become a file.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The file system refused.
    #[error("cannot write {}: {doing}: {source}; {way_out}", path.display())]
    Write {
        /// The file that was to be written.
        path: PathBuf,
        /// The step that failed.
        doing: &'static str,
        /// What the system said.
        source: std::io::Error,
        /// What the user can do.
        way_out: &'static str,
    },
    /// What a stopped study left cannot be read.
    #[error("cannot read {}, which a stopped study left: {source}; remove it, and the study begins anew", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The disk is too full.
    #[error(
        "{} takes {}, and its disk has room for {}; take larger cells (--cell), fewer (--size), a longer --step, or \
         another disk with --out",
        path.display(), bytes(*size), bytes(*room)
    )]
    NoRoom {
        /// The file that was to be written.
        path: PathBuf,
        /// What it takes, bytes.
        size: u64,
        /// What there is, bytes.
        room: u64,
    },
    /// The path names no file: it ends in none, or a folder or a device stands there.
    #[error("cannot write {}: that is no file; give the name of a file with --out", path.display())]
    NoFileName {
        /// The path as given.
        path: PathBuf,
    },
    /// The answer does not fit the format.
    #[error("cannot write the {what}: {why}")]
    Encode {
        /// What was being made.
        what: &'static str,
        /// What the encoder said.
        why: String,
    },
    /// Two rasters that belong together differ in size: a bug upstream, told rather than drawn askew.
    #[error("the {what} has {have} cells where the view has {width} × {height}; please report this as a bug")]
    Size {
        /// Which raster.
        what: &'static str,
        /// How many cells it has.
        have: usize,
        /// Columns expected.
        width: u32,
        /// Rows expected.
        height: u32,
    },
}

impl ExportError {
    /// An encoder's refusal, in its own words.
    fn encode(what: &'static str, why: impl ToString) -> Self {
        ExportError::Encode { what, why: why.to_string() }
    }
}

/// `577 MB`: bytes for people.
pub fn bytes(count: u64) -> String {
    let mut size = count as f64;
    let mut unit = "bytes";
    for larger in ["kB", "MB", "GB", "TB"] {
        if size < 999.5 {
            break;
        }
        size /= 1000.0;
        unit = larger;
    }
    let decimals = if unit == "bytes" || size >= 99.5 { 0 } else { 1 };
    format!("{size:.decimals$} {unit}")
}

/// Errs unless `have` cells fill `width` × `height`.
fn check_size(what: &'static str, have: usize, width: u32, height: u32) -> Result<(), ExportError> {
    if have == width as usize * height as usize && have > 0 {
        return Ok(());
    }
    Err(ExportError::Size { what, have, width, height })
}
