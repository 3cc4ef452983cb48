//! `shadow.bits`: one bit per cell for every instant with a sun, so that later questions (the longest run of sun, any
//! threshold) need no new computation.
//!
//! The layout, with all numbers little-endian:
//!
//! - 8 bytes: `GNOMBITS`;
//! - 8 bytes: the offset at which the rasters begin;
//! - JSON in UTF-8 up to there, padded with blanks: `region`, `cell`, `width`, `height`, `receivers`, `bytes_a_row` and
//!   `instants` as in `profile.json`, without those at night;
//! - for each of these instants a raster: rows from north to south, each of `bytes_a_row` = ⌈`width` / 8⌉ bytes. The
//!   lowest bit of a row's first byte is its westernmost cell; 1 is shadow, where at most half of the sun is seen. Bits
//!   beyond the row's end are 0.
//!
//! The study writes the file instant by instant, for each tile of the plan, under a temporary name beside its final
//! one, and renames it when it is complete.

use super::unfinished::bits_path;
use crate::choice::Receivers;
use crate::export::checksum::Checksum;
use crate::export::report::{InstantReport, instant_report};
use crate::export::{ExportError, file};
use crate::sun::SunTrack;
use crate::view::{Bits, Grid, Tile};
use serde::Serialize;
use std::fs::{File, OpenOptions};
use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// The name of the file.
pub const NAME: &str = "shadow.bits";
const MAGIC: &[u8; 8] = b"GNOMBITS";
/// Rasters begin at a multiple of this many bytes.
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

/// Encodes the whole file, with the shadows at all instants with a sun.
///
/// # Errors
/// [`ExportError::Encode`] if the encoder fails.
pub fn encode<'a>(
    grid: Grid,
    receivers: Receivers,
    track: &SunTrack,
    shadows: impl Iterator<Item = &'a Bits>,
) -> Result<Vec<u8>, ExportError> {
    let mut bytes = header(grid, receivers, track)?;
    let row_bytes = grid.width.div_ceil(8) as usize;
    for row in shadows.flat_map(|shadow| shadow.words.chunks(shadow.in_row())) {
        let end = bytes.len() + row_bytes;
        row.iter().for_each(|word| bytes.extend(word.to_le_bytes()));
        bytes.truncate(end);
    }
    Ok(bytes)
}

/// Everything before the first raster.
fn header(grid: Grid, receivers: Receivers, track: &SunTrack) -> Result<Vec<u8>, ExportError> {
    let instants: Vec<_> = track.instants.iter().filter(|instant| !instant.night).map(instant_report).collect();
    let bytes_a_row = grid.width.div_ceil(8) as usize;
    let (region, Grid { cell, width, height, .. }) = (grid.region(), grid);
    let header = Header { region, cell, width, height, receivers: receivers.word(), bytes_a_row, instants };
    let json = serde_json::to_vec(&header).map_err(|error| ExportError::encode("bits", error))?;
    let begin = (2 * MAGIC.len() + json.len()).next_multiple_of(ALIGNED);
    let mut header = [&MAGIC[..], &(begin as u64).to_le_bytes(), &json].concat();
    header.resize(begin, b' ');
    Ok(header)
}

/// The file while it is being written.
pub struct BitsFile {
    path: PathBuf,
    unfinished: PathBuf,
    header: Vec<u8>,
    grid: Grid,
    /// The number of instants with a sun.
    count: usize,
    file: Option<BufWriter<File>>,
    /// The checksum of the header and of everything added, in the order of the work.
    checksum: Checksum,
    /// The offset of the next byte.
    at: u64,
}

impl BitsFile {
    /// The file of a study in a folder. Nothing is written yet.
    ///
    /// # Errors
    /// [`ExportError::Encode`] if the encoder fails.
    pub fn new(
        folder: &Path,
        study: u64,
        grid: Grid,
        receivers: Receivers,
        track: &SunTrack,
    ) -> Result<BitsFile, ExportError> {
        let count = track.instants.iter().filter(|instant| !instant.night).count();
        let header = header(grid, receivers, track)?;
        let (path, unfinished) = (folder.join(NAME), bits_path(folder, study));
        Ok(BitsFile { path, unfinished, header, grid, count, file: None, checksum: Checksum::default(), at: 0 })
    }

    /// Its path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Its path until it is complete.
    pub fn unfinished(&self) -> &Path {
        &self.unfinished
    }

    /// Its final size, bytes.
    pub fn size(&self) -> u64 {
        self.size_after(self.count)
    }

    /// Checks that the disk has enough room for the file.
    ///
    /// # Errors
    /// [`ExportError::NoRoom`]; [`ExportError::Write`] if the file system does not report its room.
    pub(crate) fn check_room(&self) -> Result<(), ExportError> {
        file::check_room(&self.path, &self.unfinished, self.size())
    }

    fn size_after(&self, instants: usize) -> u64 {
        let raster = u64::from(self.bytes_a_row()) * u64::from(self.grid.height);
        self.header.len() as u64 + raster * instants as u64
    }

    fn bytes_a_row(&self) -> u32 {
        self.grid.width.div_ceil(8)
    }

    /// Continues the file of a stopped study, which contains these tiles' cells at these of the instants with a sun, in
    /// the order of the work. Returns whether its checksum matches.
    pub(crate) fn go_on(&mut self, drawn: impl Iterator<Item = (usize, Tile)>, checksum: u64) -> bool {
        let mut drawn = drawn.peekable();
        // a study of nights alone has no file
        if drawn.peek().is_none() {
            self.checksum.add(&self.header);
            return true;
        }
        match self.read_back(drawn) {
            Ok(read) if read.number() == checksum => self.checksum = read,
            _ => return false,
        }
        true
    }

    fn read_back(&self, drawn: impl Iterator<Item = (usize, Tile)>) -> io::Result<Checksum> {
        let mut file = OpenOptions::new().read(true).open(&self.unfinished)?;
        let (mut checksum, mut bytes) = (Checksum::default(), vec![0; self.header.len()]);
        file.read_exact(&mut bytes)?;
        checksum.add(&bytes);
        let row_bytes = u64::from(self.bytes_a_row());
        for (instant, tile) in drawn {
            let tile_bytes = tile.size[0].div_ceil(8) as usize;
            // consecutive rows are read at once
            let rows = if tile_bytes as u64 == row_bytes { tile.size[1] } else { 1 };
            bytes.resize(tile_bytes * rows as usize, 0);
            for row in (0..tile.size[1]).step_by(rows as usize) {
                file.seek(SeekFrom::Start(self.first_byte(instant, &tile) + u64::from(row) * row_bytes))?;
                file.read_exact(&mut bytes)?;
                checksum.add(&bytes);
            }
        }
        Ok(checksum)
    }

    /// Begins the file, or continues that of a stopped study.
    ///
    /// # Errors
    /// [`ExportError::Write`] if the file system fails.
    pub fn begin(&mut self, goes_on: bool) -> Result<(), ExportError> {
        if !goes_on {
            self.checksum = Checksum::default();
            self.checksum.add(&self.header);
        }
        let failed = |error| file::failed(&self.path, "opening a file beside it", error);
        let opened = OpenOptions::new().write(true).create(true).truncate(!goes_on).open(&self.unfinished);
        let mut file = BufWriter::with_capacity(1 << 20, opened.map_err(failed)?);
        file.write_all(&self.header).map_err(failed)?;
        (self.file, self.at) = (Some(file), self.header.len() as u64);
        Ok(())
    }

    /// The checksum of everything added so far.
    pub fn checksum(&self) -> u64 {
        self.checksum.number()
    }

    /// The offset of a tile's first row at an instant.
    fn first_byte(&self, instant: usize, tile: &Tile) -> u64 {
        let row_bytes = u64::from(self.bytes_a_row());
        self.size_after(instant) + u64::from(tile.first[1]) * row_bytes + u64::from(tile.first[0] / 8)
    }

    /// Adds a tile's cells at an instant, given by its index among those with a sun.
    ///
    /// # Errors
    /// [`ExportError::Write`] if the file system fails.
    pub fn add(&mut self, instant: usize, tile: &Tile, bits: &Bits) -> Result<(), ExportError> {
        if self.file.is_none() {
            self.begin(false)?;
        }
        let row_bytes = u64::from(self.bytes_a_row());
        let first = self.first_byte(instant, tile);
        let Some(file) = &mut self.file else { return Ok(()) };
        let tile_bytes = bits.width.div_ceil(8) as usize;
        let mut bytes = Vec::with_capacity(8 * bits.in_row());
        let mut write = || {
            for (row, words) in bits.words.chunks(bits.in_row()).enumerate() {
                let at = first + row as u64 * row_bytes;
                // seeking flushes the buffer
                if self.at != at {
                    file.seek(SeekFrom::Start(at))?;
                }
                bytes.clear();
                words.iter().for_each(|word| bytes.extend(word.to_le_bytes()));
                bytes.truncate(tile_bytes);
                file.write_all(&bytes)?;
                self.checksum.add(&bytes);
                self.at = at + tile_bytes as u64;
            }
            Ok(())
        };
        write().map_err(|error| file::failed(&self.path, "writing the file beside it", error))
    }

    /// Flushes everything to the disk.
    ///
    /// # Errors
    /// [`ExportError::Write`] if the file system fails.
    pub fn sync(&mut self) -> Result<(), ExportError> {
        let Some(file) = &mut self.file else { return Ok(()) };
        let synced = file.flush().and_then(|()| file.get_ref().sync_data());
        synced.map_err(|error| file::failed(&self.path, "writing the file beside it", error))
    }

    /// Reads the complete file back, as the shadows at the instants with a sun in order of time, and closes it.
    ///
    /// # Errors
    /// [`ExportError::Write`] or [`ExportError::Read`] if the file system fails.
    pub(crate) fn shadows(mut self) -> Result<Vec<Bits>, ExportError> {
        if let Some(mut file) = self.file.take() {
            let flushed = file.flush();
            flushed.map_err(|error| file::failed(&self.path, "writing the file beside it", error))?;
        }
        // a study of nights alone has no file
        if self.count == 0 {
            return Ok(Vec::new());
        }
        let Grid { width, height, .. } = self.grid;
        let read = || -> io::Result<Vec<Bits>> {
            let mut file = File::open(&self.unfinished)?;
            file.seek(SeekFrom::Start(self.size_after(0)))?;
            let mut bytes = vec![0; self.bytes_a_row() as usize * height as usize];
            let mut shadow = || -> io::Result<Bits> {
                file.read_exact(&mut bytes)?;
                let rows = bytes.chunks(self.bytes_a_row() as usize);
                let words = rows.flat_map(|row| row.chunks(8).map(word)).collect();
                Ok(Bits { width, height, words })
            };
            (0..self.count).map(|_| shadow()).collect()
        };
        read().map_err(|source| ExportError::Read { path: self.unfinished.clone(), source })
    }

    /// Renames the complete file to its final path.
    ///
    /// # Errors
    /// [`ExportError::Write`] if the file system fails.
    pub fn finish(mut self) -> Result<(), ExportError> {
        // a study of nights alone has a header, too
        if self.file.is_none() {
            self.begin(false)?;
        }
        let size = self.size();
        if let Some(mut file) = self.file.take() {
            // truncates what a stopped study of a different size left
            let whole =
                file.flush().and_then(|()| file.get_ref().set_len(size)).and_then(|()| file.get_ref().sync_all());
            whole.map_err(|error| file::failed(&self.path, "writing the file beside it", error))?;
        }
        let placed = file::rename(&self.unfinished, &self.path);
        placed.map_err(|error| file::failed(&self.path, "putting it in place", error))
    }
}

/// Up to eight bytes of a row as a word of [`Bits`].
fn word(bytes: &[u8]) -> u64 {
    bytes.iter().rev().fold(0, |word, byte| word << 8 | u64::from(*byte))
}
