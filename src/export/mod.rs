//! One answer in, one file out: drawings, rasters, solids, reports.
//!
//! Every encoder returns bytes and touches no disk; [`file::write`] puts them there, whole or not at all.

pub mod check;
pub mod figure;
pub mod file;
mod places;
pub mod probe;
pub mod raster;
pub mod report;
pub mod surfaces;
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

/// Errs unless `have` cells fill `width` × `height`.
fn check_size(what: &'static str, have: usize, width: u32, height: u32) -> Result<(), ExportError> {
    if have == width as usize * height as usize && have > 0 {
        return Ok(());
    }
    Err(ExportError::Size { what, have, width, height })
}
