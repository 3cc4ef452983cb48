//! `shadow.bits`: one bit a cell for every instant with a sun, so that questions that come later (the longest run of sun,
//! any threshold) need no new computation.
//!
//! The layout, numbers from the lowest byte up:
//!
//! - 8 bytes: `GNOMBITS`;
//! - 8 bytes: a number, where the rasters begin;
//! - JSON in UTF-8 up to there, filled up with blanks: `region`, `cell`, `width`, `height`, `receivers`, `bytes_a_row` and
//!   `instants` as `profile.json` has them, those at night left out;
//! - for each of these instants a raster: rows from north to south, each of `bytes_a_row` = ⌈`width` / 8⌉ bytes; the lowest
//!   bit of a row's first byte is its westmost cell; 1 is shadow, where at most half of the sun is seen. Bits beyond the
//!   row's end are 0.
//!
//! It is written instant by instant beside its place, and renamed when it is whole.

use super::report::{InstantReport, instant_report};
use super::{ExportError, file};
use crate::site::Receivers;
use crate::sun::SunTrack;
use crate::view::{Bits, Grid};
use serde::Serialize;
use std::fs::{self, File, OpenOptions};
use std::io::{BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

const MAGIC: &[u8; 8] = b"GNOMBITS";
/// Rasters begin at a multiple of this.
const ALIGNED: usize = 64;

#[derive(Serialize)]
struct Header {
    region: [f64; 4],
    cell: f64,
    width: u32,
    height: u32,
    receivers: &'static str,
    bytes_a_row: usize,
    instants: Vec<InstantReport>,
}

/// The file as it comes to be.
pub struct BitsFile {
    path: PathBuf,
    unfinished: PathBuf,
    header: Vec<u8>,
    grid: Grid,
    /// Instants with a sun.
    count: usize,
    file: Option<BufWriter<File>>,
}

impl BitsFile {
    /// What is to be written to a folder; nothing is yet.
    ///
    /// # Errors
    /// [`ExportError::Encode`] where the encoder refuses.
    pub fn new(folder: &Path, grid: Grid, receivers: Receivers, track: &SunTrack) -> Result<BitsFile, ExportError> {
        let instants: Vec<_> = track.instants.iter().filter(|instant| !instant.night).map(instant_report).collect();
        let count = instants.len();
        let bytes_a_row = grid.width.div_ceil(8) as usize;
        let (region, Grid { cell, width, height, .. }) = (grid.region(), grid);
        let header = Header { region, cell, width, height, receivers: receivers.word(), bytes_a_row, instants };
        let json = serde_json::to_vec(&header).map_err(|error| ExportError::encode("bits", error))?;
        let begin = (2 * MAGIC.len() + json.len()).next_multiple_of(ALIGNED);
        let mut header = [&MAGIC[..], &(begin as u64).to_le_bytes(), &json].concat();
        header.resize(begin, b' ');
        let path = folder.join("shadow.bits");
        Ok(BitsFile { unfinished: path.with_extension("bits.unfinished"), path, header, grid, count, file: None })
    }

    /// Its place.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// How large it will be, bytes.
    pub fn size(&self) -> u64 {
        self.size_after(self.count)
    }

    /// Errs where the disk has less room than it will take.
    ///
    /// # Errors
    /// [`ExportError::NoRoom`]; [`ExportError::Write`] where the file system does not say.
    pub fn check_room(&self) -> Result<(), ExportError> {
        let folder = self.path.parent().unwrap_or(Path::new("."));
        let room = fs4::available_space(folder).map_err(|error| file::failed(folder, "asking for its room", error))?;
        let there = fs::metadata(&self.unfinished).map_or(0, |found| found.len());
        let size = self.size();
        if size > room.saturating_add(there) {
            return Err(ExportError::NoRoom { path: self.path.clone(), size, room });
        }
        Ok(())
    }

    fn size_after(&self, instants: usize) -> u64 {
        let raster = u64::from(self.grid.width.div_ceil(8)) * u64::from(self.grid.height);
        self.header.len() as u64 + raster * instants as u64
    }

    /// Whether a stopped study left it with so many instants with a sun.
    pub fn has(&self, instants: usize) -> bool {
        fs::metadata(&self.unfinished).is_ok_and(|found| found.len() >= self.size_after(instants))
    }

    /// Begins, or goes on after so many instants with a sun.
    ///
    /// # Errors
    /// [`ExportError::Write`] where the file system refuses.
    pub fn begin(&mut self, done: usize) -> Result<(), ExportError> {
        let failed = |error| file::failed(&self.path, "opening a file beside it", error);
        let end = self.size_after(done);
        let mut file =
            OpenOptions::new().write(true).create(true).truncate(done == 0).open(&self.unfinished).map_err(failed)?;
        if done == 0 {
            file.write_all(&self.header).map_err(failed)?;
        } else {
            // what lies beyond belongs to instants that are drawn again
            file.set_len(end).and_then(|()| file.seek(SeekFrom::Start(end))).map_err(failed)?;
        }
        self.file = Some(BufWriter::with_capacity(1 << 20, file));
        Ok(())
    }

    /// Adds the next instant with a sun.
    ///
    /// # Errors
    /// [`ExportError::Write`] where the file system refuses.
    pub fn add(&mut self, bits: &Bits) -> Result<(), ExportError> {
        if self.file.is_none() {
            self.begin(0)?;
        }
        let Some(file) = &mut self.file else { return Ok(()) };
        let bytes_a_row = self.grid.width.div_ceil(8) as usize;
        let mut write = || {
            for words in bits.words.chunks(bits.in_row()) {
                for (at, word) in words.iter().enumerate() {
                    file.write_all(&word.to_le_bytes()[..8.min(bytes_a_row - at * 8)])?;
                }
            }
            Ok(())
        };
        write().map_err(|error| file::failed(&self.path, "writing the file beside it", error))
    }

    /// Sees that what was added is with the system.
    ///
    /// # Errors
    /// [`ExportError::Write`] where the file system refuses.
    pub fn flush(&mut self) -> Result<(), ExportError> {
        let Some(file) = &mut self.file else { return Ok(()) };
        file.flush().map_err(|error| file::failed(&self.path, "writing the file beside it", error))
    }

    /// Puts the whole file in place.
    ///
    /// # Errors
    /// [`ExportError::Write`] where the file system refuses.
    pub fn finish(mut self) -> Result<(), ExportError> {
        // nights alone have a header, too
        if self.file.is_none() {
            self.begin(0)?;
        }
        self.flush()?;
        drop(self.file.take());
        fs::rename(&self.unfinished, &self.path).map_err(|error| file::failed(&self.path, "putting it in place", error))
    }

    /// Removes what a stopped study left, where this one begins anew.
    ///
    /// # Errors
    /// [`ExportError::Write`] where the file system refuses.
    pub fn forget(&self) -> Result<(), ExportError> {
        file::remove(&self.unfinished)
    }
}
