//! Removes the frames that an older, longer animation left in the folder of a new one, since they would be mistaken for
//! frames of the new one. Only frames that are known to belong to the older animation are removed: those that match the
//! GIF beside them pixel by pixel. A picture that somebody put there, or drew on, is kept.

use super::frame_files::{GIF, frame_path, read};
use super::palette::nearest;
use crate::export::checksum;
use crate::export::figure::{Screen, scale::Rgb};
use crate::export::{ExportError, file};
use gif::{ColorOutput, DecodeOptions};
use rustc_hash::FxHashSet;
use std::collections::BTreeMap;
use std::fs::{self, OpenOptions};
use std::io::BufReader;
use std::path::{Path, PathBuf};

/// Frames of the older animation, each with a checksum of its content.
pub(super) struct OldFrames(Vec<(PathBuf, u64)>);

impl OldFrames {
    /// Finds the frames in a folder from an index on; all must belong to the GIF there.
    ///
    /// # Errors
    /// [`ExportError::OtherFrame`] if one does not.
    pub(super) fn find(folder: &Path, count: usize) -> Result<OldFrames, ExportError> {
        let frames = beyond(folder, count);
        let known = if frames.is_empty() { Vec::new() } else { of_gif(folder, &frames).unwrap_or_default() };
        let mut found = Vec::with_capacity(frames.len());
        for (index, path) in frames {
            match checksum::of_file(&path).filter(|_| known.contains(&index)) {
                Some(checksum) => found.push((path, checksum)),
                None => return Err(ExportError::OtherFrame { path, count }),
            }
        }
        Ok(OldFrames(found))
    }

    /// The note to the user about what will be removed.
    pub(super) fn note(&self) -> Option<String> {
        let (first, last) = (&self.0.first()?.0, &self.0.last()?.0);
        let which = match self.0.len() {
            1 => format!("{} belongs to the older, longer animation there and is removed", first.display()),
            _ => format!(
                "{} to {} belong to the older, longer animation there and are removed",
                first.display(),
                last.file_name().unwrap_or_default().to_string_lossy()
            ),
        };
        Some(format!("{which} when this one is done"))
    }

    /// Removes the frames, except those that have changed since.
    ///
    /// # Errors
    /// [`ExportError::Write`] if the file system fails.
    pub(super) fn remove(self) -> Result<(), ExportError> {
        let same = self.0.into_iter().filter(|(path, checksum)| checksum::of_file(path) == Some(*checksum));
        same.map(|(path, _)| path).try_for_each(|path| file::remove(&path))
    }
}

/// The files in a folder that are named as frames from an index on.
pub(super) fn beyond(folder: &Path, count: usize) -> BTreeMap<usize, PathBuf> {
    let here = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let entries = fs::read_dir(here).into_iter().flatten().flatten();
    let index = |name: &str| name.strip_prefix("frame-")?.strip_suffix(".png")?.parse::<usize>().ok();
    let frames = entries.filter_map(|entry| {
        let index = index(entry.file_name().to_str()?)?;
        let path = frame_path(folder, index);
        (path.file_name() == Some(&entry.file_name())).then_some((index, path))
    });
    frames.filter(|(index, _)| *index >= count).collect()
}

/// Those of some frames that match the GIF in their folder; none if there is no GIF of ours.
fn of_gif(folder: &Path, frames: &BTreeMap<usize, PathBuf>) -> Option<Vec<usize>> {
    let file = OpenOptions::new().read(true).open(folder.join(GIF)).ok()?;
    let mut options = DecodeOptions::new();
    options.set_color_output(ColorOutput::Indexed);
    let mut gif = options.read_info(BufReader::new(file)).ok()?;
    // the file is padded with black, and black may also be the last colour
    let mut colours: Vec<Rgb> = gif.global_palette()?.as_chunks().0.to_vec();
    while colours.pop_if(|colour| *colour == [0; 3]).is_some() {}
    let palettes = [colours.clone(), [colours, vec![[0; 3]]].concat()];
    let last = *frames.last_key_value()?.0;
    let mut known = Vec::new();
    for index in 0..=last {
        let Some(shown) = gif.read_next_frame().ok().flatten() else { break };
        if !frames.contains_key(&index) {
            continue;
        }
        let size = (u32::from(shown.width), u32::from(shown.height));
        let is_it = |frame: &Screen| (frame.width, frame.height) == size && shows(&shown.buffer, frame, &palettes);
        if read(folder, index).is_ok_and(|frame| is_it(&frame)) {
            known.push(index);
        }
    }
    Some(known)
}

/// Whether a frame, converted with one of the palettes, gives these indices.
fn shows(numbers: &[u8], frame: &Screen, palettes: &[Vec<Rgb>]) -> bool {
    let pairs: FxHashSet<(Rgb, u8)> = frame.pixels.iter().copied().zip(numbers.iter().copied()).collect();
    let is_in = |palette: &Vec<Rgb>| pairs.iter().all(|(colour, number)| nearest(palette, *colour) == *number);
    numbers.len() == frame.pixels.len() && palettes.iter().any(is_in)
}
