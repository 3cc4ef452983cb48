//! Zip archives of models: which file in one is the model, and its bytes.
//!
//! Nothing is unpacked to a disk, no name in an archive is used as a path, and what an entry becomes is bounded: the archive
//! says its size, and is not believed.

use super::ModelFault;
use crate::message::message;
use std::io::Read as _;

/// How many times its size an archive's entry may become. A model's text becomes 5 to 20 times smaller; a bomb a thousand times.
const MAX_RATIO: u64 = 100;

/// What may be in a tiny archive beyond that.
const FREE_BYTES: u64 = 1 << 20;

/// Bytes of the record at an archive's end, of one in its directory, and of the one before an entry's data; each without
/// what is of variable length.
const END_BYTES: usize = 22;
const LISTED_BYTES: usize = 46;
const LOCAL_BYTES: usize = 30;

/// An archive's last record lies at most a comment of this length before the end.
const MAX_COMMENT: usize = u16::MAX as usize;

/// What every archive with something in it begins with.
const LOCAL_MARK: &[u8] = b"PK\x03\x04";

/// Whether a file begins as an archive whose first entry's name ends so, in small letters: others' archives begin alike.
pub(super) fn begins_with(head: &[u8], ending: &str) -> bool {
    let Some(entry) = head.strip_prefix(LOCAL_MARK) else { return false };
    let length = entry.get(22..24).and_then(|bytes| bytes.try_into().ok()).map(u16::from_le_bytes);
    let name = length.and_then(|length| entry.get(26..26 + usize::from(length)));
    name.is_some_and(|name| name.to_ascii_lowercase().ends_with(ending.as_bytes()))
}

/// Whether bytes are an archive's.
pub(super) fn is_archive(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PK")
}

/// An archive of models whose names end alike.
pub(super) struct ModelArchive<'a> {
    bytes: &'a [u8],
    entries: Vec<ZipEntry>,
    /// Of the models' names, in small letters and with the dot.
    ending: &'static str,
}

impl<'a> ModelArchive<'a> {
    pub(super) fn open(bytes: &'a [u8], ending: &'static str) -> Result<Self, ModelFault> {
        match entries(bytes) {
            Some(entries) => Ok(Self { bytes, entries, ending }),
            None => Err(broken(ending, "its directory cannot be read")),
        }
    }

    /// The names of all models in it, in its order.
    pub(super) fn models(&self) -> impl Iterator<Item = &str> {
        let names = self.entries.iter().map(|entry| entry.name.as_str());
        names.filter(|name| name.to_lowercase().ends_with(self.ending))
    }

    /// The bytes of the entry of that name, of which there may be so many; none where there is no such entry.
    pub(super) fn unpacked(&self, name: &str, most_bytes: u64) -> Result<Option<Vec<u8>>, ModelFault> {
        let entry = self.entries.iter().find(|entry| entry.name == name);
        entry.map(|entry| unpacked(self.bytes, entry, most_bytes, self.ending)).transpose()
    }
}

fn broken(ending: &str, what: &str) -> ModelFault {
    let hint = format!("export it again, or unpack it and open the {ending} within");
    message![format!("is a zip archive that is broken: {what}"); hint].into()
}

fn number16(bytes: &[u8], at: usize) -> Option<usize> {
    bytes.get(at..at + 2)?.try_into().ok().map(|number| usize::from(u16::from_le_bytes(number)))
}

fn number32(bytes: &[u8], at: usize) -> Option<u32> {
    bytes.get(at..at + 4)?.try_into().ok().map(u32::from_le_bytes)
}

/// What an archive's directory says of an entry.
struct ZipEntry {
    name: String,
    is_encrypted: bool,
    method: usize,
    checksum: u32,
    packed: u64,
    size: u64,
    at: usize,
}

/// The entries of an archive, by its directory.
fn entries(bytes: &[u8]) -> Option<Vec<ZipEntry>> {
    let last = bytes.len().checked_sub(END_BYTES)?;
    let end = (last.saturating_sub(MAX_COMMENT)..=last).rev().find(|&at| bytes[at..].starts_with(b"PK\x05\x06"))?;
    let count = number16(bytes, end + 10)?;
    let mut at = usize::try_from(number32(bytes, end + 16)?).ok()?;
    let mut found = Vec::new();
    for _ in 0..count {
        let entry = bytes.get(at..)?;
        if !entry.starts_with(b"PK\x01\x02") {
            return None;
        }
        let name_bytes = number16(entry, 28)?;
        let name = entry.get(LISTED_BYTES..LISTED_BYTES + name_bytes)?;
        found.push(ZipEntry {
            name: String::from_utf8_lossy(name).into_owned(),
            is_encrypted: number16(entry, 8)? & 1 == 1,
            method: number16(entry, 10)?,
            checksum: number32(entry, 16)?,
            packed: number32(entry, 20)?.into(),
            size: number32(entry, 24)?.into(),
            at: usize::try_from(number32(entry, 42)?).ok()?,
        });
        at += LISTED_BYTES + name_bytes + number16(entry, 30)? + number16(entry, 32)?;
    }
    Some(found)
}

/// What an entry holds, within bounds that do not trust what it says of itself.
fn unpacked(bytes: &[u8], entry: &ZipEntry, most_bytes: u64, ending: &str) -> Result<Vec<u8>, ModelFault> {
    let broken = |what: &str| broken(ending, what);
    if entry.is_encrypted {
        return Err(
            message!["is encrypted"; format!("unpack it with its password, and open the {ending} within")].into()
        );
    }
    let most = entry.packed.saturating_mul(MAX_RATIO).saturating_add(FREE_BYTES).min(most_bytes);
    if entry.size > most {
        let (from, to) = (entry.packed, entry.size);
        let what =
            format!("is a zip archive whose {from} bytes claim to become {to}, more than {MAX_RATIO} times as many");
        return Err(message![what; format!("unpack it and open the {ending} within, if you trust it")].into());
    }
    let local = bytes.get(entry.at..).filter(|local| local.starts_with(LOCAL_MARK));
    let data = local.and_then(|local| {
        let start = LOCAL_BYTES + number16(local, 26)? + number16(local, 28)?;
        local.get(start..start.checked_add(usize::try_from(entry.packed).ok()?)?)
    });
    let data = data.ok_or_else(|| broken("an entry lies beyond its end"))?;
    let mut text = Vec::new();
    match entry.method {
        0 => text.extend_from_slice(data),
        8 => {
            // One byte more than is said shows that the entry lies.
            let unpacking = flate2::read::DeflateDecoder::new(data).take(entry.size + 1).read_to_end(&mut text);
            unpacking.map_err(|error| broken(&error.to_string()))?;
        }
        method => {
            let what = format!("is a zip archive that is packed by method {method}");
            return Err(message![what; format!("unpack it and open the {ending} within")].into());
        }
    }
    let mut checksum = flate2::Crc::new();
    checksum.update(&text);
    if text.len() as u64 != entry.size || checksum.sum() != entry.checksum {
        return Err(broken("an entry is not what the directory says of it"));
    }
    Ok(text)
}
