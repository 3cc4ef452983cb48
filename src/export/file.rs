//! Writes files under a temporary name and renames them: a reader sees the old file or the new one, never an incomplete
//! one.

use super::ExportError;
use same_file::Handle;
use std::collections::{BTreeMap, BTreeSet};
use std::ffi::{OsStr, OsString};
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// Writes `bytes` to `path`, replacing an old file; missing parent folders are created.
///
/// # Errors
/// [`ExportError::NoFileName`] if the path has no file name; [`ExportError::Write`] if the file system fails. Then an
/// old file is unchanged, and nothing is left beside it.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), ExportError> {
    TemporaryFile::of(path, bytes)?.put_in_place()
}

/// The step that errors name while bytes are written.
pub(super) const WRITING: &str = "writing a temporary file in its folder";

/// A file that is being written under a temporary name. It is removed unless it is put in place.
pub struct TemporaryFile {
    pub(super) file: File,
    beside: Cleanup,
    target: PathBuf,
    asked: PathBuf,
}

impl TemporaryFile {
    /// Opens the file; missing parent folders are created.
    pub(super) fn open(asked: &Path) -> Result<TemporaryFile, ExportError> {
        let failed = |doing, source| failed(asked, doing, source);
        // a link is followed; a device, a pipe or a folder must not be replaced by a drawing
        let target = asked.canonicalize().unwrap_or_else(|_| asked.to_owned());
        if target.metadata().is_ok_and(|found| !found.is_file()) {
            return Err(ExportError::NoFileName { path: target });
        }
        let name = target.file_name().ok_or_else(|| ExportError::NoFileName { path: target.clone() })?;
        // Without a folder in the path the parent is "", which means the current folder.
        let folder = match target.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        fs::create_dir_all(folder).map_err(|error| failed("creating its folder", error))?;

        let opened = open_new(folder, name);
        let (file, beside) = opened.map_err(|error| failed("opening a temporary file in its folder", error))?;
        Ok(TemporaryFile { file, beside: Cleanup(beside), target, asked: asked.to_owned() })
    }

    /// Writes these bytes to a temporary file and makes sure that they are on the disk.
    ///
    /// # Errors
    /// As [`write()`].
    pub fn of(asked: &Path, bytes: &[u8]) -> Result<TemporaryFile, ExportError> {
        let mut beside = TemporaryFile::open(asked)?;
        let written = beside.file.write_all(bytes);
        written.map_err(|error| failed(asked, WRITING, error))?;
        beside.sync()?;
        Ok(beside)
    }

    /// Makes sure that everything written so far is on the disk.
    ///
    /// # Errors
    /// [`ExportError::Write`] if the file system fails.
    pub fn sync(&self) -> Result<(), ExportError> {
        self.file.sync_all().map_err(|error| failed(&self.asked, WRITING, error))
    }

    /// The final path of the file, as requested.
    pub fn path(&self) -> &Path {
        &self.asked
    }

    /// Puts the complete file in place: it replaces an older one once it is on the disk. After a power failure either
    /// the old file or the new one exists.
    ///
    /// # Errors
    /// [`ExportError::Write`] if the file system fails.
    pub(crate) fn put_in_place(self) -> Result<(), ExportError> {
        self.sync()?;
        // Windows does not rename open files.
        drop(self.file);
        rename(&self.beside.0, &self.target).map_err(|error| failed(&self.asked, "putting it in place", error))?;
        self.beside.keep();
        Ok(())
    }
}

/// Creates a folder, and checks that files can be written to it, before long work begins.
///
/// # Errors
/// [`ExportError::Write`] if the file system fails.
pub(crate) fn check_folder(folder: &Path) -> Result<(), ExportError> {
    let failed = |doing, source| failed(folder, doing, source);
    let here = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    fs::create_dir_all(here).map_err(|error| failed("creating the folder", error))?;
    let opened = open_new(here, "gnomon".as_ref());
    let (file, beside) = opened.map_err(|error| failed("opening a temporary file in it", error))?;
    drop(file);
    drop(Cleanup(beside));
    Ok(())
}

/// Removes temporary files that dead processes left beside some outputs. The caller has locked the folders, so that
/// nobody else is writing these files.
pub(crate) fn remove_leftovers(outputs: &[PathBuf]) {
    let mut folders: BTreeMap<&Path, BTreeSet<&OsStr>> = BTreeMap::new();
    for path in outputs {
        if let (Some(folder), Some(name)) = (path.parent(), path.file_name()) {
            folders.entry(folder).or_default().insert(name);
        }
    }
    for (folder, names) in folders {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        // a leftover that stays does no harm
        let Ok(entries) = fs::read_dir(folder) else { continue };
        let left = entries.flatten().map(|entry| entry.file_name());
        for name in left.filter(|name| written_beside(name).is_some_and(|name| names.contains(OsStr::new(name)))) {
            let _ = fs::remove_file(folder.join(name));
        }
    }
}

/// Renames a file that is on the disk, and if the system allows it, makes sure that the new name is on the disk, too.
pub(crate) fn rename(from: &Path, to: &Path) -> io::Result<()> {
    fs::rename(from, to)?;
    let folder = to.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
    // Windows cannot open folders, and some disks cannot sync them: then a power failure may bring back the old file,
    // complete
    let _ = OpenOptions::new().read(true).open(folder).and_then(|folder| folder.sync_all());
    Ok(())
}

/// Whether two file paths, which need not exist, lead to the same place.
pub(crate) fn is_same_place(a: &Path, b: &Path) -> bool {
    let place = |path: &Path| {
        let folder = path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
        (folder.canonicalize().unwrap_or_else(|_| folder.to_owned()), path.file_name().map(ToOwned::to_owned))
    };
    place(a) == place(b)
}

/// Returns an error if an output is one of the input files. Files are compared, not names, so that links and
/// case-insensitive disks are recognised.
///
/// # Errors
/// [`ExportError::IsInput`]; [`ExportError::NoFileName`] if an output is a folder.
pub(crate) fn check_inputs(inputs: &[PathBuf], outputs: &[PathBuf]) -> Result<(), ExportError> {
    if let Some(path) = outputs.iter().find(|path| path.is_dir()) {
        return Err(ExportError::NoFileName { path: path.clone() });
    }
    // a missing output cannot be an input; a pipe is not opened, since that would wait for its writer
    let handle = |path: &PathBuf| path.is_file().then(|| Handle::from_path(path).ok()).flatten();
    // a handle is an open file, and a process may have only a few hundred of them
    for inputs in inputs.chunks(100) {
        let known: Vec<(&PathBuf, Handle)> = inputs.iter().filter_map(|path| Some((path, handle(path)?))).collect();
        for path in outputs {
            let Some(found) = handle(path) else { continue };
            if let Some((input, _)) = known.iter().find(|(_, handle)| *handle == found) {
                return Err(ExportError::IsInput { path: path.clone(), input: input.to_path_buf() });
            }
        }
    }
    Ok(())
}

/// Returns an error if a file does not fit on its disk. What lies at `there` already counts as a part of it.
pub(crate) fn check_room(path: &Path, there: &Path, size: u64) -> Result<(), ExportError> {
    let folder = path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
    let room = fs4::available_space(folder).map_err(|error| failed(folder, "asking for its room", error))?;
    // a file that was begun may have gaps, which do not occupy disk space yet
    let found = OpenOptions::new().read(true).open(there);
    let taken = found.and_then(|file| fs4::FileExt::allocated_size(&file)).unwrap_or(0);
    if size > room.saturating_add(taken) {
        return Err(ExportError::NoRoom { path: path.to_owned(), size, room });
    }
    Ok(())
}

/// Removes a file. A missing file is not an error.
pub(crate) fn remove(path: &Path) -> Result<(), ExportError> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(failed(path, "removing it", error)),
        _ => Ok(()),
    }
}

/// An error of the file system, with a hint.
pub(crate) fn failed(path: &Path, doing: &'static str, source: io::Error) -> ExportError {
    ExportError::Write { path: path.to_owned(), doing, source }
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
            // The first error is the one to report.
            let _ = fs::remove_file(&self.0);
        }
    }
}

/// Creates a file with a temporary name in a folder.
fn open_new(folder: &Path, name: &OsStr) -> io::Result<(File, PathBuf)> {
    loop {
        let beside = folder.join(temporary_name(name));
        match OpenOptions::new().write(true).create_new(true).open(&beside) {
            // left by a process that had our number before us, or that has it on another machine
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            opened => return Ok((opened?, beside)),
        }
    }
}

/// A temporary name: hidden, recognisable as ours, and unique among the processes of this machine and the threads of
/// this process.
fn temporary_name(name: &OsStr) -> OsString {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    let mut beside = OsString::from(".");
    beside.push(name);
    beside.push(format!(".{}-{count}.tmp", std::process::id()));
    beside
}

/// The final name that belongs to a temporary name.
fn written_beside(name: &OsStr) -> Option<&str> {
    let (name, of_process) = name.to_str()?.strip_prefix('.')?.strip_suffix(".tmp")?.rsplit_once('.')?;
    let (process, count) = of_process.split_once('-')?;
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    (is_number(process) && is_number(count)).then_some(name)
}
