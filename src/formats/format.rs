//! The trait that every format implements.

use super::model::{Model, ModelFault, ReadOptions};
use std::path::{Path, PathBuf};

/// Bytes at a file's start that tell its format.
pub(super) const HEAD_BYTES: u64 = 16 * 1024;

/// A format of model files.
pub trait Format: Sync {
    /// What people call it.
    fn name(&self) -> &'static str;

    /// How its files' names end: lower-case, without the dot, the commonest first.
    fn endings(&self) -> &'static [&'static str];

    /// Whether a file that begins with these bytes (as many as there are, at most 16 KiB) is of this format. Only what
    /// other formats cannot begin with is a yes.
    fn begins(&self, head: &[u8]) -> bool;

    /// Reads a file; there may be no part in it.
    ///
    /// # Errors
    /// What is wrong with the file, with a hint.
    fn read(&self, path: &Path, options: &ReadOptions) -> Result<Model, ModelFault>;

    /// Whether reading a file takes others' code, which runs in a process of its own with limits, and whose models are
    /// kept.
    fn is_foreign(&self, _path: &Path, _options: &ReadOptions) -> bool {
        false
    }

    /// Which keys of a model it uses, of those that not all formats do.
    fn keys(&self) -> &'static [&'static str] {
        &[]
    }

    /// The files that a file names: they lie beside it, and are its user's, whether they are read or not.
    fn named_by(&self, _path: &Path) -> Vec<PathBuf> {
        Vec::new()
    }
}
