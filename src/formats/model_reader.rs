//! How model files are read: in which process, within which limits, and with which cache.

use super::table::{format_of, read_as};
use super::{Model, ModelCache, ModelError, ModelFault, ReadLimits, ReadOptions, ReadingListener, child};
use crate::message::message;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// How model files are read.
///
/// The default reads in this process, without limits and without a cache. That is for a program that uses Gnomon as a
/// library: its executable does not answer `gnomon read-model`. A program that ships the command with it can set
/// `program`.
#[derive(Clone, Debug, Default)]
pub struct ModelReader {
    /// The executable that is started for readers from other libraries ([`super::Format::is_foreign`]).
    pub program: Option<PathBuf>,
    /// Limits on such a process.
    pub limits: ReadLimits,
    /// The cache for models that take long to read.
    pub cache: Option<ModelCache>,
    /// Set this to cancel the reading. The process is then ended at once, and what this process itself reads is
    /// dropped when it has been read; reading fails with [`ModelFault::GivenUp`].
    pub given_up: Arc<AtomicBool>,
    /// Who hears what is being read.
    #[doc(hidden)]
    pub listener: ReadingListener,
}

impl ModelReader {
    /// Reads as the command does: readers from other libraries run in child processes of this executable, and the
    /// user's cache is used.
    pub fn of_this_program() -> ModelReader {
        ModelReader { program: std::env::current_exe().ok(), cache: ModelCache::of_user(), ..ModelReader::default() }
    }

    /// The same with a different flag for cancelling.
    pub fn until(&self, given_up: &Arc<AtomicBool>) -> ModelReader {
        ModelReader { given_up: Arc::clone(given_up), ..self.clone() }
    }

    /// The same, with somebody who hears what is being read.
    #[doc(hidden)]
    pub fn heard_by(self, listener: ReadingListener) -> ModelReader {
        ModelReader { listener, ..self }
    }

    /// Reads a model file of any format. Every part has triangles, and there is at least one part.
    ///
    /// # Errors
    /// What is wrong with the file, with a hint.
    pub fn read(&self, path: &Path, options: &ReadOptions) -> Result<Model, ModelError> {
        let _heard = self.listener.begin(path);
        self.read_within(path, options).map_err(|fault| ModelError { file: path.to_owned(), fault })
    }

    fn read_within(&self, path: &Path, options: &ReadOptions) -> Result<Model, ModelFault> {
        self.check_given_up()?;
        let format = format_of(path)?;
        let is_foreign = format.is_foreign(path, options);
        let cache = self.cache.as_ref().filter(|_| is_foreign);
        let entry =
            cache.map(|cache| cache.entry(format, path, options)).transpose().map_err(ModelFault::unreadable)?;
        if let Some(model) = entry.as_ref().and_then(|entry| entry.read()) {
            return Ok(model);
        }
        let mut model = match self.program.as_deref().filter(|_| is_foreign) {
            Some(program) => child::read(program, self.limits, &self.given_up, path, options)?,
            None => read_as(format, path, options)?,
        };
        // our own readers do not look for it
        self.check_given_up()?;
        if let Some(Err(error)) = entry.map(|entry| entry.keep(&model)) {
            let note = format!("is read again each time, as the cache cannot be written: {error}");
            model.notes.push(message![note]);
        }
        Ok(model)
    }

    fn check_given_up(&self) -> Result<(), ModelFault> {
        if self.given_up.load(Ordering::Relaxed) { Err(ModelFault::GivenUp) } else { Ok(()) }
    }

    /// As [`ModelReader::read`], but without the cache and always in a child process.
    ///
    /// # Errors
    /// As [`ModelReader::read`]; also if no executable is set.
    #[cfg(feature = "test-hooks")]
    pub fn read_apart(&self, path: &Path, options: &ReadOptions) -> Result<Model, ModelError> {
        let read = || match &self.program {
            Some(program) => child::read(program, self.limits, &self.given_up, path, options),
            None => Err(message!["cannot be read apart"; "name a program that reads it"].into()),
        };
        read().map_err(|fault| ModelError { file: path.to_owned(), fault })
    }
}
