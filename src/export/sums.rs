//! `profile.sums.unfinished`: the sums of a study in tiles, which are kept there while it goes on, and not in memory.
//!
//! The layout: the plan's cells from the north-west, row after row, each its shaded time in 1/255 s from the lowest byte up,
//! in 4 bytes, or in 8 where the study has more daylight than 32 bits hold. A tile is in it once all of its instants are
//! done; what a stopped study had of the next one is in `profile.unfinished`.

use super::{ExportError, file};
use crate::profile::accumulate::MOST_SECS;
use crate::profile::{Part, Shaded, ShadedCells};
use crate::view::{Grid, Tile};
use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// The file as it comes to be, and as it is read.
pub struct SumsFile {
    path: PathBuf,
    grid: Grid,
    cell_bytes: u64,
    file: Mutex<File>,
    /// What could not be read.
    fault: Mutex<Option<io::Error>>,
}

/// Its place in a study's folder.
pub fn path(folder: &Path) -> PathBuf {
    folder.join("profile.sums.unfinished")
}

/// Whether a stopped study left it, for so many cells and so much daylight.
pub fn has(folder: &Path, grid: &Grid, day_secs: u32) -> bool {
    fs::metadata(path(folder)).is_ok_and(|found| found.len() == size(grid, day_secs))
}

/// Removes it, whichever study left it: the one that was asked is done.
///
/// # Errors
/// [`ExportError::Write`] where the file system refuses.
pub fn remove(folder: &Path) -> Result<(), ExportError> {
    file::remove(&path(folder))
}

/// How large it is, bytes.
pub fn size(grid: &Grid, day_secs: u32) -> u64 {
    grid.cells() as u64 * cell_bytes(day_secs)
}

fn cell_bytes(day_secs: u32) -> u64 {
    if day_secs > MOST_SECS { 8 } else { 4 }
}

impl SumsFile {
    /// Begins, or goes on with what a stopped study left.
    ///
    /// # Errors
    /// [`ExportError::NoRoom`] where the disk has less room than it takes; [`ExportError::Write`] where the file system
    /// refuses.
    pub fn open(folder: &Path, grid: Grid, day_secs: u32, goes_on: bool) -> Result<SumsFile, ExportError> {
        let path = path(folder);
        let size = size(&grid, day_secs);
        if !goes_on {
            file::remove(&path)?;
            file::check_room(&path, &path, size)?;
        }
        let failed = |error| file::failed(&path, "opening it", error);
        let file =
            OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&path).map_err(failed)?;
        file.set_len(size).map_err(failed)?;
        Ok(SumsFile { path, grid, cell_bytes: cell_bytes(day_secs), file: Mutex::new(file), fault: Mutex::new(None) })
    }

    /// Puts a tile's sums in their place.
    ///
    /// # Errors
    /// [`ExportError::Write`] where the file system refuses.
    pub fn put(&self, tile: &Tile, shaded: &Shaded) -> Result<(), ExportError> {
        let [left, top] = tile.first.map(u64::from);
        let width = tile.size[0] as usize;
        let mut bytes = Vec::new();
        let mut write = || {
            let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
            for row in 0..tile.size[1] as usize {
                bytes.clear();
                for cell in row * width..(row + 1) * width {
                    bytes.extend_from_slice(&shaded.of(cell).to_le_bytes()[..self.cell_bytes as usize]);
                }
                let at = (top + row as u64) * u64::from(self.grid.width) + left;
                file.seek(SeekFrom::Start(at * self.cell_bytes))?;
                file.write_all(&bytes)?;
            }
            Ok(())
        };
        write().map_err(|error| file::failed(&self.path, "writing to it", error))
    }

    /// Sees that what was put is on the disk.
    ///
    /// # Errors
    /// [`ExportError::Write`] where the file system refuses.
    pub fn sync(&self) -> Result<(), ExportError> {
        let file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.sync_data().map_err(|error| file::failed(&self.path, "writing to it", error))
    }

    /// Errs where something could not be read since it was opened: it was taken for nothing.
    ///
    /// # Errors
    /// [`ExportError::Read`]
    pub fn check(&self) -> Result<(), ExportError> {
        let fault = self.fault.lock().unwrap_or_else(PoisonError::into_inner).take();
        fault.map_or(Ok(()), |source| Err(ExportError::Read { path: self.path.clone(), source }))
    }
}

impl ShadedCells for SumsFile {
    fn cells(&self) -> usize {
        self.grid.cells()
    }

    fn part(&self, cells: Range<usize>) -> Part<'_> {
        let mut bytes = vec![0; cells.len() * self.cell_bytes as usize];
        let mut read = || {
            let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
            file.seek(SeekFrom::Start(cells.start as u64 * self.cell_bytes))?;
            file.read_exact(&mut bytes)
        };
        if let Err(error) = read() {
            self.fault.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
        }
        match self.cell_bytes {
            4 => Part::One(bytes.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect()),
            _ => Part::Two(bytes.as_chunks().0.iter().map(|word| u64::from_le_bytes(*word)).collect()),
        }
    }
}
