//! A study as an animation: the pictures `frame-0000.png` and so on, and `day.gif` made of them.
//!
//! Frames are written as they are drawn. The GIF follows when all of them exist, since its palette depends on all of
//! them; then only one frame at a time is in memory. It is written under a temporary name and renamed when it is
//! complete.

mod frame_files;
mod palette;
mod previous_frames;

use super::figure::Screen;
use super::{ExportError, file};
use frame_files::{GIF, frame_path, read};
use gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};
use palette::{Counts, Palette};
use previous_frames::OldFrames;
use std::borrow::Cow;
use std::fs;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

/// The greatest number of frames.
pub(crate) const MOST_FRAMES: usize = 2000;

/// The GIF's palette comes from about this many frames, evenly spread.
const SAMPLED: usize = 64;

/// The frames of an animation in a folder, and the colours seen so far.
pub struct Frames {
    folder: PathBuf,
    count: usize,
    older: OldFrames,
    done: usize,
    counts: Counts,
}

impl Frames {
    /// An animation of `count` frames, none of which is written yet. Frames that an older, longer animation left are
    /// removed when this one is complete.
    ///
    /// # Errors
    /// [`ExportError::OtherFrame`] if a file has the name of such a frame but is not known to be one.
    pub fn new(folder: &Path, count: usize) -> Result<Frames, ExportError> {
        let older = OldFrames::find(folder, count)?;
        Ok(Frames { folder: folder.to_owned(), count, older, done: 0, counts: Counts::default() })
    }

    /// A note for the user on frames of an older animation that will be removed.
    pub fn note(&self) -> Option<String> {
        self.older.note()
    }

    /// The path of a frame.
    pub fn path(folder: &Path, index: usize) -> PathBuf {
        frame_path(folder, index)
    }

    /// All files that an animation of `count` frames writes into a folder.
    pub(crate) fn outputs(folder: &Path, count: usize) -> Vec<PathBuf> {
        (0..count).map(|index| Frames::path(folder, index)).chain([folder.join(GIF)]).collect()
    }

    /// What an animation would replace in a folder: the GIF, or the first file with a frame's name.
    pub fn there(folder: &Path) -> Option<PathBuf> {
        let gif = Some(folder.join(GIF)).filter(|gif| gif.is_file());
        gif.or_else(|| previous_frames::beyond(folder, 0).into_values().next())
    }

    /// Writes the next frame.
    ///
    /// # Errors
    /// [`ExportError::Encode`] from the encoder; as [`file::write`].
    pub fn add(&mut self, frame: &Screen) -> Result<(), ExportError> {
        file::write(&Frames::path(&self.folder, self.done), &frame.png()?)?;
        if self.done.is_multiple_of(self.count.div_ceil(SAMPLED).max(1)) {
            self.counts.add(frame);
        }
        self.done += 1;
        Ok(())
    }

    /// Begins the GIF when all frames are written. `delay` is how long each is shown, in hundredths of a second.
    ///
    /// # Errors
    /// [`ExportError::Read`] and [`ExportError::Encode`] if the first frame is not as it was written; as
    /// [`file::write`].
    pub fn gif(self, delay: u16) -> Result<Gif, ExportError> {
        let path = self.folder.join(GIF);
        let palette = self.counts.palette();
        let beside = file::TemporaryFile::open(&path)?;
        let file = beside.file.try_clone().map_err(|error| file::failed(&path, file::WRITING, error))?;
        let first = read(&self.folder, 0)?;
        let size = (side(first.width)?, side(first.height)?);
        let start = || -> Result<_, EncodingError> {
            let mut encoder = Encoder::new(BufWriter::new(file), size.0, size.1, &palette.bytes())?;
            encoder.set_repeat(Repeat::Infinite)?;
            Ok(encoder)
        };
        let encoder = start().map_err(|error| failed(&path, error))?;
        Ok(Gif { folder: self.folder, older: self.older, path, delay, size, palette, encoder, beside })
    }
}

/// A GIF that is being made of the written frames. Unless it is finished, no GIF remains.
pub struct Gif {
    folder: PathBuf,
    older: OldFrames,
    path: PathBuf,
    delay: u16,
    size: (u16, u16),
    palette: Palette,
    // closed before the file is removed
    encoder: Encoder<BufWriter<fs::File>>,
    beside: file::TemporaryFile,
}

impl Gif {
    /// Adds a frame.
    ///
    /// # Errors
    /// [`ExportError::Read`] and [`ExportError::Encode`] if the frame is not as it was written; [`ExportError::Write`]
    /// if the file system fails.
    pub fn add(&mut self, index: usize) -> Result<(), ExportError> {
        let frame = read(&self.folder, index)?;
        let (width, height) = self.size;
        if (frame.width, frame.height) != (width.into(), height.into()) {
            return Err(ExportError::encode("animation", "its frames differ in size"));
        }
        let buffer = Cow::Owned(self.palette.of(&frame));
        let dispose = DisposalMethod::Keep;
        let frame = Frame { width, height, delay: self.delay, dispose, buffer, ..Frame::default() };
        self.encoder.write_frame(&frame).map_err(|error| failed(&self.path, error))
    }

    /// Finishes the GIF when it has all frames: it replaces an older one, and what remains of an older animation is
    /// removed. Returns its path.
    ///
    /// # Errors
    /// [`ExportError::Write`] if the file system fails.
    pub fn finish(self) -> Result<PathBuf, ExportError> {
        let Gif { path, older, encoder, beside, .. } = self;
        let mut file = encoder.into_inner().map_err(|error| failed(&path, error))?;
        file.flush().map_err(|error| file::failed(&path, file::WRITING, error))?;
        drop(file);
        beside.put_in_place()?;
        older.remove()?;
        Ok(path)
    }
}

fn side(pixels: u32) -> Result<u16, ExportError> {
    u16::try_from(pixels).map_err(|_| ExportError::encode("animation", "a GIF is at most 65535 pixels wide and high"))
}

fn failed(path: &Path, error: EncodingError) -> ExportError {
    match error {
        EncodingError::Io(error) => file::failed(path, file::WRITING, error),
        error => ExportError::encode("animation", error),
    }
}
