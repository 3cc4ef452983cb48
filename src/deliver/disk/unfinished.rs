//! The state of a stopped study in its folder, from which it can continue later.
//!
//! The file names contain the study's number, so several stopped studies can exist side by side, and each continues
//! when the same request is made again: `profile.NUMBER.unfinished`, and if needed `shadow.bits.NUMBER.unfinished` and
//! `profile.sums.NUMBER.unfinished`.
//!
//! The layout of the first, with all numbers little-endian: the line `gnomon unfinished 3`; in 64 bits each the study's
//! number, the number of its tiles, the number of finished instants, the number of cells, and the bytes of a cell, 4 or
//! 8; a byte for the statistics of counting that follow: 0 none, 1 without and 2 with cells that a map left to the
//! volumes; then in 64 bits each those four numbers, the checksums of bits and sums, the number of masks, and the
//! checksum of each; the cells; last the checksum of everything before it.

use crate::export::checksum::checksum;
use crate::export::{ExportError, bytes, file};
use crate::profile::{Shaded, Statistics, Unfinished};
use std::cmp::Reverse;
use std::collections::BTreeSet;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

const FIRST_LINE: &[u8] = b"gnomon unfinished 3\n";

/// The beginnings of the names of its files. The first file exists as soon as there is a state from which the study can
/// continue.
const FIRST_WORDS: [&str; 3] = ["profile", "shadow.bits", "profile.sums"];

/// The checksums of a study's other files so far.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Checks {
    /// The checksum of its bits.
    pub bits: u64,
    /// The checksum of the sums of finished tiles.
    pub sums: u64,
    /// The checksum of each mask.
    pub masks: Vec<u64>,
}

/// A stopped study's state, if there is one.
pub enum StoredStudy {
    /// Nothing.
    Nothing,
    /// A file that is not as it was written.
    Damaged,
    /// The complete state.
    Whole(Box<(Unfinished, Checks)>),
}

/// The path of a study's file in its folder.
pub fn path(folder: &Path, study: u64) -> PathBuf {
    file_of(folder, FIRST_WORDS[0], study)
}

pub(super) fn bits_path(folder: &Path, study: u64) -> PathBuf {
    file_of(folder, FIRST_WORDS[1], study)
}

/// The path of the file with the sums of finished tiles.
pub(crate) fn sums_path(folder: &Path, study: u64) -> PathBuf {
    file_of(folder, FIRST_WORDS[2], study)
}

fn file_of(folder: &Path, first_words: &str, study: u64) -> PathBuf {
    folder.join(format!("{first_words}.{study:016x}.unfinished"))
}

/// Writes the state. An older file is replaced when the new one is complete.
///
/// # Errors
/// As [`file::write`].
pub fn keep(folder: &Path, unfinished: &Unfinished, checks: &Checks) -> Result<(), ExportError> {
    file::write(&path(folder, unfinished.study), &encode(unfinished, checks))
}

/// Reads the state of a study.
///
/// # Errors
/// [`ExportError::Read`] if there is a file that cannot be read.
pub fn kept(folder: &Path, study: u64) -> Result<StoredStudy, ExportError> {
    let path = path(folder, study);
    match fs::read(&path) {
        Ok(bytes) => Ok(match decode(&bytes).filter(|(unfinished, _)| unfinished.study == study) {
            Some(whole) => StoredStudy::Whole(Box::new(whole)),
            None => StoredStudy::Damaged,
        }),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(StoredStudy::Nothing),
        Err(source) => Err(ExportError::Read { path, source }),
    }
}

/// Removes all files of a study, when it is done or has to start over.
///
/// # Errors
/// [`ExportError::Write`] if the file system fails.
pub fn remove(folder: &Path, study: u64) -> Result<(), ExportError> {
    // the first file goes first: without it the others are ignored
    FIRST_WORDS.iter().try_for_each(|words| file::remove(&file_of(folder, words, study)))
}

/// Notes which other stopped studies have files in the folder. Removes bits and sums without a state, left by a study
/// that was killed. The caller must have locked the folder.
pub(crate) fn tidy(folder: &Path, studies: &[u64]) -> Option<String> {
    file::remove_leftovers(&studies.iter().map(|study| path(folder, *study)).collect::<Vec<_>>());
    let others = studies_in(folder).into_iter().filter(|other| !studies.contains(other));
    let (stopped, dead): (Vec<u64>, Vec<u64>) = others.partition(|other| path(folder, *other).is_file());
    for other in dead {
        // nothing is lost if they remain
        let _ = remove(folder, other);
    }
    let first = path(folder, *stopped.first()?);
    let files = stopped.iter().flat_map(|other| FIRST_WORDS.map(|words| file_of(folder, words, *other)));
    let size = bytes(files.filter_map(|file| Some(file.metadata().ok()?.len())).sum());
    let (others, keep, it, file) = match stopped.len() {
        1 => (String::new(), "keeps another study that was stopped", "It", "file"),
        2 => (" and another one".to_owned(), "keep other studies that were stopped", "Each", "files"),
        many => (format!(" and {} more", many - 1), "keep other studies that were stopped", "Each", "files"),
    };
    Some(format!(
        "{}{others} {keep}, or this one with a different request ({size}). {it} continues when the same request is made again; \
         if that is not needed, the {file} can be removed",
        first.display()
    ))
}

/// Removes the files of all stopped studies in a folder except the newest ones. The caller must have locked the folder.
pub(crate) fn keep_newest(folder: &Path, most: usize) {
    let mut studies: Vec<u64> = studies_in(folder).into_iter().collect();
    // files without a state have no time, and count as the oldest
    let changed = |study: &u64| path(folder, *study).metadata().and_then(|found| found.modified()).ok();
    studies.sort_by_cached_key(|study| Reverse(changed(study)));
    for study in studies.into_iter().skip(most) {
        // nothing is lost if they remain
        let _ = remove(folder, study);
    }
}

/// The studies that have files in a folder; empty if the folder cannot be listed.
fn studies_in(folder: &Path) -> BTreeSet<u64> {
    let here = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let Ok(entries) = fs::read_dir(here) else { return BTreeSet::new() };
    let names = entries.flatten().filter_map(|entry| entry.file_name().into_string().ok());
    names.filter_map(|name| study_of(&name)).collect()
}

/// The study to which a file belongs, by its name.
fn study_of(name: &str) -> Option<u64> {
    let (words, number) = name.strip_suffix(".unfinished")?.rsplit_once('.')?;
    let is_ours = FIRST_WORDS.contains(&words) && number.len() == 16 && !number.starts_with('+');
    u64::from_str_radix(number, 16).ok().filter(|_| is_ours)
}

fn encode(unfinished: &Unfinished, checks: &Checks) -> Vec<u8> {
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
    for number in [checks.bits, checks.sums, checks.masks.len() as u64].iter().chain(&checks.masks) {
        bytes.extend(number.to_le_bytes());
    }
    match shaded.in_one_word() {
        Some(cells) => cells.iter().for_each(|cell| bytes.extend(cell.to_le_bytes())),
        None => shaded.iter().for_each(|cell| bytes.extend(cell.to_le_bytes())),
    }
    bytes.extend(checksum(&bytes).to_le_bytes());
    bytes
}

fn decode(bytes: &[u8]) -> Option<(Unfinished, Checks)> {
    let (bytes, last) = bytes.split_last_chunk()?;
    if checksum(bytes) != u64::from_le_bytes(*last) {
        return None;
    }
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
    let [bits, sums, masks] = numbers(&mut rest)?;
    let (of_masks, rest) = rest.split_at_checked(usize::try_from(masks.checked_mul(8)?).ok()?)?;
    let masks = of_masks.as_chunks().0.iter().map(|word| u64::from_le_bytes(*word)).collect();
    if cells.checked_mul(word_bytes) != Some(rest.len() as u64) {
        return None;
    }
    let shaded: Shaded = match word_bytes {
        4 => rest.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect::<Vec<u32>>().into(),
        8 => rest.as_chunks().0.iter().map(|word| u64::from_le_bytes(*word)).collect::<Vec<u64>>().into(),
        _ => return None,
    };
    let [tiles, done] = [usize::try_from(tiles).ok()?, usize::try_from(done).ok()?];
    Some((Unfinished { study, tiles, done, shaded, statistics }, Checks { bits, sums, masks }))
}

/// Takes the first numbers from the bytes.
fn numbers<const N: usize>(rest: &mut &[u8]) -> Option<[u64; N]> {
    let mut numbers = [0; N];
    for number in &mut numbers {
        let (bytes, behind) = rest.split_first_chunk()?;
        *number = u64::from_le_bytes(*bytes);
        *rest = behind;
    }
    Some(numbers)
}
