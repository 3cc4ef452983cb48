//! Zip archives of models: finds the model in an archive, and unpacks it.
//!
//! Nothing is unpacked to disk, no name in an archive is used as a path, and the unpacked size is limited, since the
//! sizes that an archive states are not trusted.

use super::ModelFault;
use crate::message::message;
use std::io::Read as _;

/// The greatest ratio by which an entry may grow. Text of a model is compressed 5 to 20 times, a zip bomb a thousand
/// times.
const MAX_RATIO: u64 = 100;

/// The bytes that an entry of any archive may have beyond that ratio.
const FREE_BYTES: u64 = 1 << 20;

/// The fixed bytes of the record at an archive's end, of an entry in its directory, and of the header before an entry's
/// data.
const END_BYTES: usize = 22;
const LISTED_BYTES: usize = 46;
const LOCAL_BYTES: usize = 30;

/// The longest comment after an archive's last record.
const MAX_COMMENT: usize = u16::MAX as usize;

/// The first bytes of every archive that is not empty.
const LOCAL_MARK: &[u8] = b"PK\x03\x04";

/// Whether a file begins as an archive whose first entry has this ending, in lower case. Other archives begin in the
/// same way.
pub(super) fn begins_with(head: &[u8], ending: &str) -> bool {
    let Some(entry) = head.strip_prefix(LOCAL_MARK) else { return false };
    let length = entry.get(22..24).and_then(|bytes| bytes.try_into().ok()).map(u16::from_le_bytes);
    let name = length.and_then(|length| entry.get(26..26 + usize::from(length)));
    name.is_some_and(|name| name.to_ascii_lowercase().ends_with(ending.as_bytes()))
}

/// Whether bytes are a zip archive.
pub(super) fn is_archive(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PK")
}

/// An archive of models with the same ending.
pub(super) struct ModelArchive<'a> {
    bytes: &'a [u8],
    entries: Vec<ZipEntry>,
    /// The ending of the models' names, lower-case and with the dot.
    ending: &'static str,
}

impl<'a> ModelArchive<'a> {
    pub(super) fn open(bytes: &'a [u8], ending: &'static str) -> Result<Self, ModelFault> {
        match entries(bytes) {
            Some(entries) => Ok(Self { bytes, entries, ending }),
            None => Err(broken(ending, "its directory cannot be read")),
        }
    }

    /// The names of all models in it, in order.
    pub(super) fn models(&self) -> impl Iterator<Item = &str> {
        let names = self.entries.iter().map(|entry| entry.name.as_str());
        names.filter(|name| name.to_lowercase().ends_with(self.ending))
    }

    /// The unpacked bytes of the entry of that name, at most `most_bytes`; `None` without such an entry.
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

/// An entry in an archive's directory.
struct ZipEntry {
    name: String,
    is_encrypted: bool,
    method: usize,
    checksum: u32,
    packed: u64,
    size: u64,
    at: usize,
}

/// The entries in an archive's directory.
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

/// Unpacks an entry, within limits that do not depend on the sizes that it states.
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
            // one byte more than stated shows that the statement is false
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
        return Err(broken("an entry differs from what the directory says"));
    }
    Ok(text)
}
