//! `profile.sums.NUMBER.unfinished`: the sums of a study in tiles, which are in this file instead of memory while the
//! study runs.
//!
//! The layout: the plan's cells from the north-west, row by row, each its shaded time in 1/255 s, little-endian, in 4
//! bytes, or in 8 if the study has more daylight than fits in 32 bits. The file contains a tile once all of the tile's
//! instants are done; the state of the unfinished tile is in `profile.NUMBER.unfinished`.

use super::unfinished::sums_path;
use crate::export::checksum::Checksum;
use crate::export::{ExportError, file};
use crate::profile::accumulate::MOST_SECS;
use crate::profile::{Shaded, ShadedCells, ShadedPart};
use crate::view::{Grid, Tile};
use std::fs::{File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// The file while it is being written, and as it is read.
pub struct SumsFile {
    path: PathBuf,
    grid: Grid,
    cell_bytes: u64,
    file: Mutex<File>,
    /// The checksum of everything written, in the order of the work.
    checksum: Checksum,
    /// The first error of reading.
    fault: Mutex<Option<io::Error>>,
}

/// Its size, bytes.
pub fn size(grid: &Grid, day_secs: u32) -> u64 {
    grid.cells() as u64 * cell_bytes(day_secs)
}

fn cell_bytes(day_secs: u32) -> u64 {
    if day_secs > MOST_SECS { 8 } else { 4 }
}

impl SumsFile {
    /// Begins the file of a study.
    ///
    /// # Errors
    /// [`ExportError::NoRoom`] if the disk has too little room; [`ExportError::Write`] if the file system fails.
    pub fn begin(folder: &Path, study: u64, grid: Grid, day_secs: u32) -> Result<SumsFile, ExportError> {
        let path = sums_path(folder, study);
        let size = size(&grid, day_secs);
        file::remove(&path)?;
        file::check_room(&path, &path, size)?;
        let failed = |error| file::failed(&path, "opening it", error);
        let file = OpenOptions::new().read(true).write(true).create_new(true).open(&path).map_err(failed)?;
        file.set_len(size).map_err(failed)?;
        Ok(SumsFile::new(path, file, grid, day_secs))
    }

    /// Continues the file of a stopped study with these finished tiles, if its checksum matches.
    pub(crate) fn go_on(
        folder: &Path,
        study: u64,
        grid: Grid,
        day_secs: u32,
        tiles: &[Tile],
        checksum: u64,
    ) -> Option<SumsFile> {
        let path = sums_path(folder, study);
        let file = OpenOptions::new().read(true).write(true).open(&path).ok()?;
        let has_size = file.metadata().is_ok_and(|found| found.len() == size(&grid, day_secs));
        let mut sums = SumsFile::new(path, file, grid, day_secs);
        let read = sums.read_back(tiles).ok()?;
        sums.checksum = read;
        (has_size && sums.checksum() == checksum).then_some(sums)
    }

    fn new(path: PathBuf, file: File, grid: Grid, day_secs: u32) -> SumsFile {
        let cell_bytes = cell_bytes(day_secs);
        let checksum = Checksum::default();
        SumsFile { path, grid, cell_bytes, file: Mutex::new(file), checksum, fault: Mutex::new(None) }
    }

    fn read_back(&self, tiles: &[Tile]) -> io::Result<Checksum> {
        let (mut checksum, mut bytes) = (Checksum::default(), Vec::new());
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        for tile in tiles {
            bytes.resize((u64::from(tile.size[0]) * self.cell_bytes) as usize, 0);
            for row in 0..tile.size[1] {
                file.seek(SeekFrom::Start(self.first_byte(tile, row)))?;
                file.read_exact(&mut bytes)?;
                checksum.add(&bytes);
            }
        }
        Ok(checksum)
    }

    /// The checksum of everything written so far.
    pub fn checksum(&self) -> u64 {
        self.checksum.number()
    }

    /// The offset of a tile's row.
    fn first_byte(&self, tile: &Tile, row: u32) -> u64 {
        let [left, top] = tile.first.map(u64::from);
        ((top + u64::from(row)) * u64::from(self.grid.width) + left) * self.cell_bytes
    }

    /// Writes a tile's sums at their place in the file.
    ///
    /// # Errors
    /// [`ExportError::Write`] if the file system fails.
    pub fn put(&mut self, tile: &Tile, shaded: &Shaded) -> Result<(), ExportError> {
        let width = tile.size[0] as usize;
        let mut bytes = Vec::new();
        for row in 0..tile.size[1] {
            bytes.clear();
            let first = row as usize * width;
            for cell in first..first + width {
                bytes.extend_from_slice(&shaded.of(cell).to_le_bytes()[..self.cell_bytes as usize]);
            }
            let at = self.first_byte(tile, row);
            let file = self.file.get_mut().unwrap_or_else(PoisonError::into_inner);
            let written = file.seek(SeekFrom::Start(at)).and_then(|_| file.write_all(&bytes));
            written.map_err(|error| file::failed(&self.path, "writing to it", error))?;
            self.checksum.add(&bytes);
        }
        Ok(())
    }

    /// Flushes everything to the disk.
    ///
    /// # Errors
    /// [`ExportError::Write`] if the file system fails.
    pub fn sync(&self) -> Result<(), ExportError> {
        let file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.sync_data().map_err(|error| file::failed(&self.path, "writing to it", error))
    }

    /// Returns an error if something could not be read since the file was opened; such cells were read as 0.
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

    fn part(&self, cells: Range<usize>) -> ShadedPart<'_> {
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
            4 => ShadedPart::One(bytes.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect()),
            _ => ShadedPart::Two(bytes.as_chunks().0.iter().map(|word| u64::from_le_bytes(*word)).collect()),
        }
    }
}
