//! Names of an animation's files, and reading a frame back.

use crate::export::ExportError;
use crate::export::figure::Screen;
use image::ImageFormat;
use std::fs;
use std::path::{Path, PathBuf};

pub(super) const GIF: &str = "day.gif";

/// The path of a frame.
pub(super) fn frame_path(folder: &Path, index: usize) -> PathBuf {
    folder.join(format!("frame-{index:04}.png"))
}

/// Reads a written frame back.
pub(super) fn read(folder: &Path, index: usize) -> Result<Screen, ExportError> {
    let path = frame_path(folder, index);
    let again = |why: String| ExportError::encode("animation", format!("{}: {why}", path.display()));
    let bytes = fs::read(&path).map_err(|error| again(error.to_string()))?;
    let decoded = image::load_from_memory_with_format(&bytes, ImageFormat::Png);
    let picture = decoded.map_err(|error| again(error.to_string()))?.into_rgb8();
    let pixels = picture.pixels().map(|pixel| pixel.0).collect();
    Ok(Screen { width: picture.width(), height: picture.height(), pixels })
}
