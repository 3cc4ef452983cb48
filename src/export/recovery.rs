//! Keeps a window's unsaved settings among the app's own data until they are saved, so that a crash does not lose them.
//! Each window has a slot: a file, and beside it a lock file that stays locked as long as the window exists, however it
//! ends. So a window can see whether the settings that it finds belong to a window that is still open.

use super::{ExportError, file};
use crate::site::WrittenSite;
use crate::site::file::SiteFile;
use serde::{Deserialize, Serialize};
use std::fs::{self, File, OpenOptions};
use std::path::{Path, PathBuf};

/// A site that has unsaved settings.
#[derive(Clone, Debug, PartialEq)]
pub struct UnsavedSite {
    /// The site file; a bare model does not have one yet.
    pub path: Option<PathBuf>,
    /// The site with its settings. The text is that of the site file when it was read.
    pub written: WrittenSite,
}

/// An [`UnsavedSite`] as it is stored in a file.
#[derive(Serialize, Deserialize)]
struct Record {
    gnomon: String,
    path: Option<PathBuf>,
    file: String,
    folder: PathBuf,
    text: String,
    site: String,
}

/// Where one window keeps its unsaved settings. It belongs to that window as long as the window exists.
#[derive(Debug)]
pub struct Slot {
    file: PathBuf,
    lock: PathBuf,
    /// Holds the lock.
    _held: File,
}

impl Slot {
    /// A new slot in a folder, which is created if it is missing.
    ///
    /// # Errors
    /// The system's error.
    pub fn new(folder: &Path) -> std::io::Result<Slot> {
        fs::create_dir_all(folder)?;
        let mut number = 0;
        loop {
            let file = folder.join(format!("{}-{number}.json", std::process::id()));
            let lock = file.with_extension("lock");
            match OpenOptions::new().write(true).create_new(true).open(&lock) {
                // of this process, or left by an older process with the same number
                Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => number += 1,
                Err(error) => return Err(error),
                // another window that is clearing the folder may have locked it first
                Ok(held) if held.try_lock().is_err() => number += 1,
                Ok(held) => return Ok(Slot { file, lock, _held: held }),
            }
        }
    }

    /// The slot of a file that a window left behind; `None` while that window is open.
    fn left(file: PathBuf) -> Option<Slot> {
        let lock = file.with_extension("lock");
        let held = OpenOptions::new().write(true).create(true).truncate(false).open(&lock).ok()?;
        held.try_lock().ok()?;
        let slot = Slot { file, lock, _held: held };
        // it may have been saved in the meantime
        if slot.file.exists() {
            return Some(slot);
        }
        slot.empty();
        None
    }

    /// Stores unsaved settings in place of older ones. A reader sees either of them, never an incomplete file.
    ///
    /// # Errors
    /// As [`file::write`]; also if TOML or JSON cannot express the settings.
    pub fn keep(&self, unsaved: &UnsavedSite) -> Result<(), ExportError> {
        let what = "file of what is not saved";
        let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let WrittenSite { file, folder, site, text } = &unsaved.written;
        let record = Record {
            gnomon: env!("CARGO_PKG_VERSION").to_owned(),
            path: unsaved.path.as_deref().map(absolute),
            file: absolute(Path::new(file)).display().to_string(),
            folder: absolute(folder),
            text: text.clone(),
            site: site.to_toml().map_err(|error| ExportError::encode(what, error))?,
        };
        let bytes = serde_json::to_vec_pretty(&record).map_err(|error| ExportError::encode(what, error))?;
        file::write(&self.file, &bytes)
    }

    /// The stored settings; `None` if they cannot be read, for example because an older Gnomon wrote them.
    fn kept(&self) -> Option<UnsavedSite> {
        let record: Record = serde_json::from_slice(&fs::read(&self.file).ok()?).ok()?;
        let Record { path, file, folder, text, site, .. } = record;
        let site = SiteFile::parse(&file, &site).ok()?;
        Some(UnsavedSite { path, written: WrittenSite { file, folder, site, text } })
    }

    /// Removes the stored settings once everything is saved or discarded.
    pub fn empty(self) {
        // if removing fails, the settings are offered once more, which does no harm
        let _ = fs::remove_file(&self.file);
        let _ = fs::remove_file(&self.lock);
    }
}

/// Removes the locks of windows that ended before they stored anything, or after everything was saved.
fn clear(folder: &Path) {
    let Ok(entries) = folder.read_dir() else { return };
    for lock in entries.flatten().map(|entry| entry.path()) {
        let is_alone = lock.extension().is_some_and(|is| is == "lock") && !lock.with_extension("json").exists();
        let held = is_alone.then(|| OpenOptions::new().write(true).open(&lock)).and_then(Result::ok);
        // an open window holds its lock
        if held.is_some_and(|held| held.try_lock().is_ok() && !lock.with_extension("json").exists()) {
            // if removing fails, it is tried again next time
            let _ = fs::remove_file(&lock);
        }
    }
}

/// The unsaved settings of windows that have ended, the newest first. Their slots belong to this window until they are
/// dropped.
pub fn left_behind(folder: &Path) -> Vec<(Slot, UnsavedSite)> {
    clear(folder);
    let Ok(entries) = folder.read_dir() else { return Vec::new() };
    let is_kept = |path: &PathBuf| path.extension().is_some_and(|is| is == "json");
    let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).filter(is_kept).collect();
    files.sort_by_key(|path| std::cmp::Reverse(path.metadata().and_then(|found| found.modified()).ok()));
    let slots = files.into_iter().filter_map(Slot::left);
    slots.filter_map(|slot| slot.kept().map(|unsaved| (slot, unsaved))).collect()
}
