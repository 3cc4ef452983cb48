//! The folders in which a study works. They are locked, so that no two studies write their files there at once.
//!
//! The lock is the operating system's, on the open file `.gnomon.lock`. The system drops it when the process ends,
//! however that happens, so a file that a crash left behind locks nobody out. If a disk does not support locks, the
//! study continues, and a note says so.
//!
//! A finished process removes the file while it still holds the lock. Another process may have opened the file just
//! before; it then gets the lock of a file that no longer has a name, while a third process creates a new file. So a
//! lock counts only if its path still leads to the locked file; otherwise the process tries again. Two processes never
//! hold the same folder.

use crate::export::{ExportError, file};
use chrono::{DateTime, Local};
use same_file::Handle;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind, Read, Write};
use std::path::{Path, PathBuf};

const NAME: &str = ".gnomon.lock";
/// The number of times that a folder may become free and be taken again while a process tries to lock it.
const ATTEMPTS: usize = 100;
/// The greatest length of the text that says who works in a folder, bytes.
const MOST_BYTES: u64 = 500;

/// Folders that are locked until this is dropped.
pub struct Workplace {
    held: Vec<FolderLock>,
    /// The folders on disks without locks, with the system's message for each.
    unlocked: Vec<(PathBuf, io::Error)>,
}

/// A lock. It ends when the file is closed.
struct FolderLock {
    folder: PathBuf,
    file: File,
}

impl Workplace {
    /// Creates the folders, checks that files can be written there, and locks them. Removes half-written outputs of
    /// dead processes. Other processes can read that `who` works there: a command, or a window.
    ///
    /// # Errors
    /// [`ExportError::Busy`] if another study works in one of them; [`ExportError::Write`] if the file system fails.
    pub fn take<'a>(
        folders: impl IntoIterator<Item = &'a Path>,
        outputs: &[PathBuf],
        who: &str,
    ) -> Result<Workplace, ExportError> {
        let mut place = Workplace { held: Vec::new(), unlocked: Vec::new() };
        for asked in folders {
            file::check_folder(asked)?;
            let failed = |error| file::failed(asked, "looking for the folder", error);
            let here = if asked.as_os_str().is_empty() { Path::new(".") } else { asked };
            let folder = here.canonicalize().map_err(failed)?;
            if place.held.iter().any(|held| held.folder == folder) {
                continue;
            }
            match lock(&folder, asked, who)? {
                Ok(file) => place.held.push(FolderLock { folder, file }),
                Err(error) => place.unlocked.push((asked.to_owned(), error)),
            }
        }
        if place.unlocked.is_empty() {
            file::remove_leftovers(outputs);
        }
        Ok(place)
    }

    /// A note for the user if a folder could not be locked.
    pub fn note(&self) -> Option<String> {
        let (folder, error) = self.unlocked.first()?;
        Some(format!(
            "{}: its disk does not support locks ({error}); make sure that no other study writes there meanwhile",
            folder.display()
        ))
    }

    /// Checks that the folders are still those that were locked.
    ///
    /// # Errors
    /// [`ExportError::Lost`]
    pub fn check(&self) -> Result<(), ExportError> {
        match self.held.iter().find(|held| !is_at(&held.file, &held.folder.join(NAME))) {
            Some(held) => Err(ExportError::Lost { folder: held.folder.clone() }),
            None => Ok(()),
        }
    }
}

impl Drop for FolderLock {
    fn drop(&mut self) {
        let path = self.folder.join(NAME);
        // if the folder was replaced, the file there belongs to another process
        if is_at(&self.file, &path) {
            // a file that remains locks nobody out
            let _ = fs::remove_file(path);
        }
    }
}

/// The locked file; or the system's message if the disk has no locks.
fn lock(folder: &Path, asked: &Path, who: &str) -> Result<io::Result<File>, ExportError> {
    let path = folder.join(NAME);
    let failed = |error| file::failed(asked, "locking the folder", error);
    for _ in 0..ATTEMPTS {
        let (mut file, is_ours) = open(&path).map_err(failed)?;
        match file.try_lock() {
            Ok(()) if !is_at(&file, &path) => continue,
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(busy(asked, &path)),
            Err(TryLockError::Error(error)) => {
                drop(file);
                // it would say for ever that somebody works there
                let _ = fs::remove_file(&path);
                return Ok(Err(error));
            }
        }
        // another user's file, left by a crash, is replaced by one of our own
        if !is_ours && fs::remove_file(&path).is_ok() {
            continue;
        }
        if is_ours {
            let host = gethostname::gethostname();
            let text = format!("process {} on {}: {who}\n", std::process::id(), host.to_string_lossy());
            let written = file.set_len(0).and_then(|()| file.write_all(text.as_bytes())).and_then(|()| file.flush());
            written.map_err(failed)?;
        }
        return Ok(Ok(file));
    }
    Err(busy(asked, &path))
}

/// Opens the file. Returns whether it can be written to, too.
fn open(path: &Path) -> io::Result<(File, bool)> {
    // the target of a link is not ours to write to
    if path.symlink_metadata().is_ok_and(|found| !found.is_file()) {
        return Err(io::Error::new(ErrorKind::AlreadyExists, format!("{} is not a file", path.display())));
    }
    match OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path) {
        Err(error) if error.kind() == ErrorKind::PermissionDenied => {
            Ok((OpenOptions::new().read(true).open(path)?, false))
        }
        opened => Ok((opened?, true)),
    }
}

/// Whether a path leads to an open file.
fn is_at(file: &File, path: &Path) -> bool {
    let handle = file.try_clone().and_then(Handle::from_file);
    handle.is_ok_and(|handle| Handle::from_path(path).is_ok_and(|found| found == handle))
}

/// The error that says who works there, if that can be read: on Windows a locked file cannot.
fn busy(folder: &Path, path: &Path) -> ExportError {
    let mut text = Vec::new();
    let file = OpenOptions::new().read(true).open(path);
    let read = file.and_then(|file| file.take(MOST_BYTES).read_to_end(&mut text));
    let said: String = String::from_utf8_lossy(&text).chars().filter(|letter| !letter.is_control()).collect();
    let who = if read.is_ok() && !said.is_empty() { said } else { "another study".to_owned() };
    let since = path.metadata().and_then(|found| found.modified());
    let since = since.map_or_else(
        |_| String::new(),
        |time| format!("since {}, ", DateTime::<Local>::from(time).format("%Y-%m-%d %H:%M")),
    );
    ExportError::Busy { folder: folder.to_owned(), who: format!("{since}{who}") }
}
