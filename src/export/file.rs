//! Files are written beside their place and renamed into it: a reader sees the old file or the new one, never half.

use super::ExportError;
use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// Writes `bytes` to `path`, replacing what was there; missing parent folders are created.
///
/// # Errors
/// [`ExportError::NoFileName`] where the path ends in no name; [`ExportError::Write`] where the file system refuses.
/// On an error the old file, if any, is untouched and nothing is left beside it.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), ExportError> {
    let mut beside = Beside::open(path)?;
    let written = beside.file.write_all(bytes);
    written.map_err(|error| failed(path, WRITING, error))?;
    beside.put_in_place()
}

/// What is done while bytes go out.
pub(super) const WRITING: &str = "writing a temporary file in its folder";

/// A file that is written beside its place. It is gone again unless it is put there.
pub struct Beside {
    pub(super) file: File,
    beside: Cleanup,
    target: PathBuf,
    asked: PathBuf,
}

impl Beside {
    /// Missing parent folders are created.
    pub(super) fn open(asked: &Path) -> Result<Beside, ExportError> {
        let failed = |doing, source| failed(asked, doing, source);
        // through a link to what it leads to; a device, a pipe or a folder is nothing to be replaced by a drawing
        let target = asked.canonicalize().unwrap_or_else(|_| asked.to_owned());
        if target.metadata().is_ok_and(|found| !found.is_file()) {
            return Err(ExportError::NoFileName { path: target });
        }
        let name = target.file_name().ok_or_else(|| ExportError::NoFileName { path: target.clone() })?;
        // Without a folder in the path the parent is "", which means here.
        let folder = match target.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        fs::create_dir_all(folder).map_err(|error| failed("creating its folder", error))?;

        let beside = folder.join(temporary_name(name));
        let opened = OpenOptions::new().write(true).create_new(true).open(&beside);
        let file = opened.map_err(|error| failed("opening a temporary file in its folder", error))?;
        Ok(Beside { file, beside: Cleanup(beside), target, asked: asked.to_owned() })
    }

    /// Where it is to be, as asked.
    pub fn path(&self) -> &Path {
        &self.asked
    }

    /// It is whole: it replaces what was there.
    ///
    /// # Errors
    /// [`ExportError::Write`] where the file system refuses.
    pub fn put_in_place(self) -> Result<(), ExportError> {
        // Windows renames no open file.
        drop(self.file);
        fs::rename(&self.beside.0, &self.target).map_err(|error| failed(&self.asked, "putting it in place", error))?;
        self.beside.keep();
        Ok(())
    }
}

/// Makes a folder, and sees that files can be written to it: before long work, not after it.
///
/// # Errors
/// [`ExportError::Write`] where the file system refuses.
pub fn check_folder(folder: &Path) -> Result<(), ExportError> {
    let failed = |doing, source| failed(folder, doing, source);
    let here = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    fs::create_dir_all(here).map_err(|error| failed("creating the folder", error))?;
    let beside = here.join(temporary_name("gnomon".as_ref()));
    let file = OpenOptions::new().write(true).create_new(true).open(&beside);
    drop(file.map_err(|error| failed("opening a temporary file in it", error))?);
    drop(Cleanup(beside));
    Ok(())
}

/// Errs where the disk has less room than a file takes; what lies at `there` already is a part of it.
pub(super) fn check_room(path: &Path, there: &Path, size: u64) -> Result<(), ExportError> {
    let folder = path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
    let room = fs4::available_space(folder).map_err(|error| failed(folder, "asking for its room", error))?;
    // a file that was begun may have gaps, which take no room yet
    let found = OpenOptions::new().read(true).open(there);
    let taken = found.and_then(|file| fs4::FileExt::allocated_size(&file)).unwrap_or(0);
    if size > room.saturating_add(taken) {
        return Err(ExportError::NoRoom { path: path.to_owned(), size, room });
    }
    Ok(())
}

/// Removes a file; that there is none is no error.
pub(super) fn remove(path: &Path) -> Result<(), ExportError> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(failed(path, "removing it", error)),
        _ => Ok(()),
    }
}

/// What the file system refused, with the way out.
pub(super) fn failed(path: &Path, doing: &'static str, source: io::Error) -> ExportError {
    ExportError::Write { path: path.to_owned(), doing, way_out: way_out(source.kind()), source }
}

/// Removes the temporary file unless it has been renamed away.
struct Cleanup(PathBuf);

impl Cleanup {
    fn keep(mut self) {
        self.0 = PathBuf::new();
    }
}

impl Drop for Cleanup {
    fn drop(&mut self) {
        if self.0 != Path::new("") {
            // The first error is the one to tell.
            let _ = fs::remove_file(&self.0);
        }
    }
}

/// Unique among this machine's processes and this process's threads, hidden, and seen to be ours.
fn temporary_name(name: &std::ffi::OsStr) -> OsString {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    let mut beside = OsString::from(".");
    beside.push(name);
    beside.push(format!(".{}-{count}.tmp", std::process::id()));
    beside
}

fn way_out(kind: io::ErrorKind) -> &'static str {
    match kind {
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "choose a folder you may write to with --out"
        }
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            "free some space, or choose another disk with --out"
        }
        io::ErrorKind::IsADirectory
        | io::ErrorKind::NotADirectory
        | io::ErrorKind::AlreadyExists
        | io::ErrorKind::DirectoryNotEmpty => {
            "a folder stands where a file should be, or the other way round; choose another name with --out"
        }
        io::ErrorKind::InvalidFilename => "choose a shorter or simpler name with --out",
        _ => "choose another place with --out",
    }
}
