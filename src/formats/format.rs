//! The trait that every format implements.

use super::model::{Model, ModelFault, ReadOptions};
use std::path::{Path, PathBuf};

/// The number of bytes at a file's start that identify its format.
pub(super) const HEAD_BYTES: u64 = 16 * 1024;

/// A format of model files.
pub trait Format: Sync {
    /// Its usual name.
    fn name(&self) -> &'static str;

    /// The endings of its files' names: lower-case, without the dot, the commonest first.
    fn endings(&self) -> &'static [&'static str];

    /// Whether a file that begins with these bytes (at most 16 KiB) has this format. Returns `true` only for bytes that
    /// no other format begins with.
    fn begins(&self, head: &[u8]) -> bool;

    /// Reads a file. The model may have no parts.
    ///
    /// # Errors
    /// What is wrong with the file, with a hint.
    fn read(&self, path: &Path, options: &ReadOptions) -> Result<Model, ModelFault>;

    /// Whether the reader is from another library. Such readers run in a child process with limits, and their models
    /// are cached.
    fn is_foreign(&self, _path: &Path, _options: &ReadOptions) -> bool {
        false
    }

    /// The keys of a model that it uses, among those that not all formats use.
    fn keys(&self) -> &'static [&'static str] {
        &[]
    }

    /// The files that a file refers to. They lie beside it and belong to the user, whether they are read or not.
    fn named_by(&self, _path: &Path) -> Vec<PathBuf> {
        Vec::new()
    }
}
