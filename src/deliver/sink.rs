//! The destination of a deliverable's files: a folder, a path for each file, or memory.

use super::disk::workplace::Workplace;
use crate::export::ExportError;
use crate::export::file::{self, TemporaryFile};
use std::path::{Path, PathBuf};

/// A file's name and its contents.
pub type NamedFile = (PathBuf, Vec<u8>);

/// The destination of files.
#[derive(Clone, Copy, Debug)]
pub enum Sink<'a> {
    /// A folder, which is locked while the work runs.
    Folder(Folder<'a>),
    /// A path for each file, without a lock.
    Paths {
        /// The files that the site was read from; none of them is overwritten.
        inputs: &'a [PathBuf],
    },
    /// Memory: the files are returned with the answer.
    Memory,
}

/// A folder in which a deliverable is made.
#[derive(Clone, Copy, Debug)]
pub struct Folder<'a> {
    /// Its path; it is created if it is missing.
    pub path: &'a Path,
    /// Who works there: a command or a window. Others who want to work there can read this.
    pub who: &'a str,
    /// The files that the site was read from; none of them is overwritten.
    pub inputs: &'a [PathBuf],
}

/// The files that were written, in the order in which they are reported.
#[derive(Clone, Debug, Default)]
pub struct WrittenFiles {
    /// The path of each file; for files in memory, its name.
    pub paths: Vec<PathBuf>,
    /// The files themselves, if they are in memory.
    pub files: Vec<NamedFile>,
}

/// A second folder, and the names of the files that are written to it while the work runs.
pub(super) struct SecondFolder<'a> {
    pub(super) folder: &'a Path,
    pub(super) files: Vec<PathBuf>,
}

impl<'a> Sink<'a> {
    /// The folder, if the sink is one.
    pub(super) fn folder(self) -> Option<&'a Path> {
        match self {
            Sink::Folder(Folder { path, .. }) => Some(path),
            Sink::Paths { .. } | Sink::Memory => None,
        }
    }

    /// Checks that files of these names can be written and that none of them is an input, and locks the folders. Called
    /// before long work begins.
    ///
    /// # Errors
    /// [`ExportError`] if the file system fails, the folder is in use, or a file is an input.
    pub(super) fn open(self, names: &[PathBuf], also: Option<SecondFolder<'_>>) -> Result<OpenSink<'a>, ExportError> {
        let workplace = match self {
            Sink::Memory => None,
            Sink::Paths { inputs } => {
                file::check_inputs(inputs, names)?;
                for path in names {
                    file::check_folder(path.parent().unwrap_or(Path::new("")))?;
                }
                None
            }
            Sink::Folder(Folder { path, who, inputs }) => {
                let second = also.as_ref().map(|also| also.folder);
                let outputs = names.iter().map(|name| path.join(name));
                let outputs: Vec<PathBuf> = outputs.chain(also.iter().flat_map(|also| also.files.clone())).collect();
                file::check_inputs(inputs, &outputs)?;
                Some(Workplace::take([path].into_iter().chain(second), &outputs, who)?)
            }
        };
        Ok(OpenSink { sink: self, workplace })
    }
}

/// A sink that is ready for files.
pub(super) struct OpenSink<'a> {
    sink: Sink<'a>,
    workplace: Option<Workplace>,
}

/// A file that is complete, but not yet in place.
pub(super) enum WholeFile {
    Disk(TemporaryFile),
    Memory(NamedFile),
}

impl OpenSink<'_> {
    /// A note for the user on the folder.
    pub(super) fn note(&self) -> Option<String> {
        self.workplace.as_ref().and_then(Workplace::note)
    }

    /// The path of a file on the disk.
    pub(super) fn path(&self, name: &Path) -> Option<PathBuf> {
        match self.sink {
            Sink::Folder(Folder { path, .. }) => Some(path.join(name)),
            Sink::Paths { .. } => Some(name.to_owned()),
            Sink::Memory => None,
        }
    }

    /// Writes a file to a temporary name.
    pub(super) fn ready(&self, (name, bytes): NamedFile) -> Result<WholeFile, ExportError> {
        match self.path(&name) {
            Some(path) => Ok(WholeFile::Disk(TemporaryFile::of(&path, &bytes)?)),
            None => Ok(WholeFile::Memory((name, bytes))),
        }
    }

    /// Puts files in place once all of them are complete, so that files of two studies are never mixed.
    pub(super) fn put(&self, files: Vec<WholeFile>) -> Result<WrittenFiles, ExportError> {
        self.check()?;
        let mut written = WrittenFiles::default();
        for file in files {
            match file {
                WholeFile::Disk(beside) => {
                    written.paths.push(beside.path().to_owned());
                    beside.put_in_place()?;
                }
                WholeFile::Memory((name, bytes)) => {
                    written.paths.push(name.clone());
                    written.files.push((name, bytes));
                }
            }
        }
        Ok(written)
    }

    /// As [`OpenSink::put`], for files in memory.
    pub(super) fn write(&self, files: Vec<NamedFile>) -> Result<WrittenFiles, ExportError> {
        let ready = files.into_iter().map(|file| self.ready(file)).collect::<Result<Vec<_>, _>>()?;
        self.put(ready)
    }

    /// Checks that the folder is still the one that was locked.
    pub(super) fn check(&self) -> Result<(), ExportError> {
        self.workplace.as_ref().map_or(Ok(()), Workplace::check)
    }
}
