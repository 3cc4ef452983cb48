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
//! It is written instant by instant, for each tile of the plan, beside its place, and renamed when it is whole.

use super::report::{InstantReport, instant_report};
use super::{ExportError, file};
use crate::site::Receivers;
use crate::sun::SunTrack;
use crate::view::{Bits, Grid, Tile};
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

/// Removes what a stopped study left: another one begins in its place.
///
/// # Errors
/// [`ExportError::Write`] where the file system refuses.
pub fn remove(folder: &Path) -> Result<(), ExportError> {
    file::remove(&unfinished(&folder.join("shadow.bits")))
}

fn unfinished(path: &Path) -> PathBuf {
    path.with_extension("bits.unfinished")
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
    /// Where the next byte goes.
    at: u64,
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
        Ok(BitsFile { unfinished: unfinished(&path), path, header, grid, count, file: None, at: 0 })
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
        file::check_room(&self.path, &self.unfinished, self.size())
    }

    fn size_after(&self, instants: usize) -> u64 {
        let raster = u64::from(self.bytes_a_row()) * u64::from(self.grid.height);
        self.header.len() as u64 + raster * instants as u64
    }

    fn bytes_a_row(&self) -> u32 {
        self.grid.width.div_ceil(8)
    }

    /// Whether a stopped study left it with so many instants with a sun, of the whole plan, or of some tile at least.
    pub fn has(&self, instants: usize, tiles: usize) -> bool {
        let least = if tiles > 1 { self.size_after(instants.saturating_sub(1)) } else { self.size_after(instants) };
        fs::metadata(&self.unfinished).is_ok_and(|found| found.len() >= least)
    }

    /// Begins, or goes on with what a stopped study left.
    ///
    /// # Errors
    /// [`ExportError::Write`] where the file system refuses.
    pub fn begin(&mut self, goes_on: bool) -> Result<(), ExportError> {
        let failed = |error| file::failed(&self.path, "opening a file beside it", error);
        let opened = OpenOptions::new().write(true).create(true).truncate(!goes_on).open(&self.unfinished);
        let mut file = BufWriter::with_capacity(1 << 20, opened.map_err(failed)?);
        file.write_all(&self.header).map_err(failed)?;
        (self.file, self.at) = (Some(file), self.header.len() as u64);
        Ok(())
    }

    /// Adds a tile's cells at an instant: at which of those with a sun.
    ///
    /// # Errors
    /// [`ExportError::Write`] where the file system refuses.
    pub fn add(&mut self, instant: usize, tile: &Tile, bits: &Bits) -> Result<(), ExportError> {
        if self.file.is_none() {
            self.begin(false)?;
        }
        let row_bytes = u64::from(self.bytes_a_row());
        let first = self.size_after(instant) + u64::from(tile.first[1]) * row_bytes + u64::from(tile.first[0] / 8);
        let Some(file) = &mut self.file else { return Ok(()) };
        let tile_bytes = bits.width.div_ceil(8) as usize;
        let mut write = || {
            for (row, words) in bits.words.chunks(bits.in_row()).enumerate() {
                let at = first + row as u64 * row_bytes;
                // to seek is to write out what is gathered
                if self.at != at {
                    file.seek(SeekFrom::Start(at))?;
                }
                for (at, word) in words.iter().enumerate() {
                    file.write_all(&word.to_le_bytes()[..8.min(tile_bytes - at * 8)])?;
                }
                self.at = at + tile_bytes as u64;
            }
            Ok(())
        };
        write().map_err(|error| file::failed(&self.path, "writing the file beside it", error))
    }

    /// Sees that what was added is on the disk.
    ///
    /// # Errors
    /// [`ExportError::Write`] where the file system refuses.
    pub fn sync(&mut self) -> Result<(), ExportError> {
        let Some(file) = &mut self.file else { return Ok(()) };
        let synced = file.flush().and_then(|()| file.get_ref().sync_data());
        synced.map_err(|error| file::failed(&self.path, "writing the file beside it", error))
    }

    /// Puts the whole file in place.
    ///
    /// # Errors
    /// [`ExportError::Write`] where the file system refuses.
    pub fn finish(mut self) -> Result<(), ExportError> {
        // nights alone have a header, too
        if self.file.is_none() {
            self.begin(false)?;
        }
        self.sync()?;
        // what lies beyond is of a study that was stopped, and fits no more
        let size = self.size();
        let cut = self.file.take().map_or(Ok(()), |file| file.get_ref().set_len(size));
        cut.map_err(|error| file::failed(&self.path, "writing the file beside it", error))?;
        fs::rename(&self.unfinished, &self.path).map_err(|error| file::failed(&self.path, "putting it in place", error))
    }
}
