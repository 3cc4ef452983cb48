//! One answer in, one file out: drawings, rasters, solids, reports.
//!
//! Every encoder returns bytes and touches no disk; [`file::write`] puts them there, whole or not at all.

pub mod animation;
pub mod check;
pub mod checksum;
pub mod comparison;
pub mod figure;
pub mod file;
mod places;
pub mod probe;
pub mod raster;
pub mod recovery;
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
    /// Another study works in the folder.
    #[error(
        "{}: another study works there, {who}; wait until it is done, or choose another folder",
        folder.display()
    )]
    Busy {
        /// The folder.
        folder: PathBuf,
        /// Since when, which process on which host, and what it was asked.
        who: String,
    },
    /// The folder was removed, or replaced by another one.
    #[error(
        "{}: the folder, or its .gnomon.lock, was removed while the study worked there, and no result was written; ask again",
        folder.display()
    )]
    Lost {
        /// The folder.
        folder: PathBuf,
    },
    /// A frame would be taken for one of the animation's.
    #[error(
        "{} would stay behind the {count} frames of this animation, and is not known to be of one that was finished there; \
         remove it and the frames after it, or choose another folder",
        path.display()
    )]
    OtherFrame {
        /// The file.
        path: PathBuf,
        /// How many frames there are to be.
        count: usize,
    },
    /// What is to be written is what was read.
    #[error(
        "cannot write {}: it is {}, which the site is read from and which would be lost; choose another name or folder",
        path.display(), input.display()
    )]
    IsInput {
        /// The file that was to be written.
        path: PathBuf,
        /// The same file, as the site names it.
        input: PathBuf,
    },
    /// The path names no file: it ends in none, or a folder or a device stands there.
    #[error("cannot write {}: that is no file; give the name of a file", path.display())]
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
    /// Whether the command line was wrong (exit status 2).
    pub fn is_wrong_use(&self) -> bool {
        matches!(self, ExportError::IsInput { .. })
    }

    /// An encoder's refusal, in its own words.
    pub(crate) fn encode(what: &'static str, why: impl ToString) -> Self {
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
