//! A file → its text: the file itself, or the `.ifc` within a zip archive. The content decides which it is, not the
//! file's name.

use super::super::ModelFault;
use crate::message::message;
use std::fs::File;
use std::io::Read as _;
use std::path::Path;

/// As much as the reader's own 32-bit positions can say.
const MAX_TEXT_BYTES: u64 = u32::MAX as u64;

/// How many times its size an archive's entry may become. IFC's text becomes 5 to 20 times smaller; a bomb a thousand times.
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

/// The text of a file, and the entries of its archive that were not read.
pub(super) struct IfcText {
    pub bytes: Vec<u8>,
    pub ignored: Vec<String>,
}

/// Reads a file, and what is in it where it is an archive.
pub(super) fn read(path: &Path) -> Result<IfcText, ModelFault> {
    let length = std::fs::metadata(path).map_err(ModelFault::unreadable)?.len();
    if length > MAX_TEXT_BYTES {
        let what = format!("has {} MiB, and an IFC file may have 4095", length >> 20);
        return Err(message![what; "export it storey by storey"].into());
    }
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(ModelFault::unreadable)?;
    file.take(MAX_TEXT_BYTES).read_to_end(&mut bytes).map_err(ModelFault::unreadable)?;
    if bytes.starts_with(b"PK") {
        return unzipped(&bytes);
    }
    if bytes.starts_with(b"\xef\xbb\xbf") {
        bytes.drain(..3);
    }
    Ok(IfcText { bytes, ignored: Vec::new() })
}

fn broken(what: &str) -> ModelFault {
    message![format!("is a zip archive that is broken: {what}"); "export it again, or unpack it and open the .ifc within"]
        .into()
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

/// The first IFC file of an archive.
fn unzipped(bytes: &[u8]) -> Result<IfcText, ModelFault> {
    let entries = entries(bytes).ok_or_else(|| broken("its directory cannot be read"))?;
    let is_ifc = |entry: &&ZipEntry| entry.name.to_lowercase().ends_with(".ifc");
    let Some(entry) = entries.iter().find(is_ifc) else {
        return Err(message![
            "is a zip archive with no .ifc in it";
            "export the model as IFC, not as ifcXML"
        ]
        .into());
    };
    let ignored = entries.iter().filter(is_ifc).skip(1).map(|entry| entry.name.clone()).collect();
    let mut text = unpacked(bytes, entry)?;
    if text.starts_with(b"\xef\xbb\xbf") {
        text.drain(..3);
    }
    Ok(IfcText { bytes: text, ignored })
}

/// What an entry holds, within bounds that do not trust what it says of itself.
fn unpacked(bytes: &[u8], entry: &ZipEntry) -> Result<Vec<u8>, ModelFault> {
    if entry.is_encrypted {
        return Err(message!["is encrypted"; "unpack it with its password, and open the .ifc within"].into());
    }
    let most = entry.packed.saturating_mul(MAX_RATIO).saturating_add(FREE_BYTES).min(MAX_TEXT_BYTES);
    if entry.size > most {
        let (from, to) = (entry.packed, entry.size);
        let what =
            format!("is a zip archive whose {from} bytes claim to become {to}, more than {MAX_RATIO} times as many");
        return Err(message![what; "unpack it and open the .ifc within, if you trust it"].into());
    }
    let local = bytes.get(entry.at..).filter(|local| local.starts_with(b"PK\x03\x04"));
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
            return Err(message![what; "unpack it and open the .ifc within"].into());
        }
    }
    let mut checksum = flate2::Crc::new();
    checksum.update(&text);
    if text.len() as u64 != entry.size || checksum.sum() != entry.checksum {
        return Err(broken("an entry is not what the directory says of it"));
    }
    Ok(text)
}
