//! What a stopped study leaves in its folder, so that it can go on another time.
//!
//! The layout, all numbers from the lowest byte up: the line `gnomon unfinished 2`; in 64 bits each the study's number,
//! how many tiles it has, how many instants are done, how many cells there are, and the bytes of a cell, 4 or 8; a byte that says what counting
//! took follows: 0 nothing, 1 without and 2 with cells that a map left to the volumes; then in 64 bits each the four
//! numbers of that; the cells.

use super::{ExportError, file};
use crate::profile::{Shaded, Statistics, Unfinished};
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

const FIRST_LINE: &[u8] = b"gnomon unfinished 2\n";

/// Its file in a study's folder.
pub fn path(folder: &Path) -> PathBuf {
    folder.join("profile.unfinished")
}

/// Keeps it; an older one is replaced when the new one is whole.
///
/// # Errors
/// As [`file::write`].
pub fn keep(folder: &Path, unfinished: &Unfinished) -> Result<(), ExportError> {
    file::write(&path(folder), &encode(unfinished))
}

/// What was kept, if anything, and it is whole.
///
/// # Errors
/// [`ExportError::Read`] where there is a file that cannot be read.
pub fn kept(folder: &Path) -> Result<Option<Unfinished>, ExportError> {
    let path = path(folder);
    match fs::read(&path) {
        Ok(bytes) => Ok(decode(&bytes)),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        Err(source) => Err(ExportError::Read { path, source }),
    }
}

/// Removes it: the study is done.
///
/// # Errors
/// [`ExportError::Write`] where the file system refuses.
pub fn remove(folder: &Path) -> Result<(), ExportError> {
    file::remove(&path(folder))
}

fn encode(unfinished: &Unfinished) -> Vec<u8> {
    let Unfinished { study, tiles, done, shaded, statistics } = unfinished;
    let mut bytes = FIRST_LINE.to_vec();
    let word_bytes = if shaded.in_one_word().is_some() { 4_u64 } else { 8 };
    for number in [*study, *tiles as u64, *done as u64, shaded.len() as u64, word_bytes] {
        bytes.extend(number.to_le_bytes());
    }
    let (kind, counted) = match statistics {
        None => (0, Statistics::default()),
        Some(counted) => (1 + u8::from(counted.silhouette_cells.is_some()), *counted),
    };
    bytes.push(kind);
    let Statistics { cells, silhouette_cells, fragments, fragments_without_mask } = counted;
    for number in [cells, silhouette_cells.unwrap_or(0), fragments, fragments_without_mask] {
        bytes.extend(number.to_le_bytes());
    }
    match shaded.in_one_word() {
        Some(cells) => cells.iter().for_each(|cell| bytes.extend(cell.to_le_bytes())),
        None => shaded.iter().for_each(|cell| bytes.extend(cell.to_le_bytes())),
    }
    bytes
}

fn decode(bytes: &[u8]) -> Option<Unfinished> {
    let mut rest = bytes.strip_prefix(FIRST_LINE)?;
    let [study, tiles, done, cells, word_bytes] = numbers(&mut rest)?;
    let (&kind, mut rest) = rest.split_first()?;
    let [all, silhouette, fragments, fragments_without_mask] = numbers(&mut rest)?;
    let silhouette_cells = (kind == 2).then_some(silhouette);
    let counted = Statistics { cells: all, silhouette_cells, fragments, fragments_without_mask };
    let statistics = match kind {
        0 => None,
        1 | 2 => Some(counted),
        _ => return None,
    };
    if cells.checked_mul(word_bytes) != Some(rest.len() as u64) {
        return None;
    }
    let shaded: Shaded = match word_bytes {
        4 => rest.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect::<Vec<u32>>().into(),
        8 => rest.as_chunks().0.iter().map(|word| u64::from_le_bytes(*word)).collect::<Vec<u64>>().into(),
        _ => return None,
    };
    let [tiles, done] = [usize::try_from(tiles).ok()?, usize::try_from(done).ok()?];
    Some(Unfinished { study, tiles, done, shaded, statistics })
}

/// The first numbers, which are taken away.
fn numbers<const N: usize>(rest: &mut &[u8]) -> Option<[u64; N]> {
    let mut numbers = [0; N];
    for number in &mut numbers {
        let (bytes, behind) = rest.split_first_chunk()?;
        *number = u64::from_le_bytes(*bytes);
        *rest = behind;
    }
    Some(numbers)
}
