//! Finds the JSON in a file and, in a `.glb`, its binary chunk. The contents decide which it is, not the file's name.

use super::Fault;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// The greatest length that a `.glb`'s 32-bit fields can hold.
const MAX_FILE_BYTES: u64 = u32::MAX as u64;

/// The bytes of a `.glb` header: magic, version, length.
const HEADER: usize = 12;
/// The bytes before a chunk's data: length, type.
const CHUNK_HEADER: usize = 8;

/// The two halves of a model file.
pub(super) struct Container<'a> {
    /// The JSON.
    pub json: &'a [u8],
    /// The contents of buffer 0 in a `.glb`.
    pub binary: Option<&'a [u8]>,
}

/// Reads a whole regular file of at most 4 GiB.
pub(super) fn read_file(path: &Path) -> Result<Vec<u8>, Fault> {
    // checked before opening: opening a pipe would wait for its writer
    let metadata = std::fs::metadata(path).map_err(Fault::Unreadable)?;
    if !metadata.is_file() {
        return Err(Fault::NotAFile);
    }
    if metadata.len() > MAX_FILE_BYTES {
        return Err(Fault::TooLarge(metadata.len()));
    }
    let file = File::open(path).map_err(Fault::Unreadable)?;
    let mut bytes = Vec::with_capacity(usize::try_from(metadata.len()).unwrap_or(0));
    file.take(MAX_FILE_BYTES).read_to_end(&mut bytes).map_err(Fault::Unreadable)?;
    Ok(bytes)
}

/// Only the JSON of a model's file, without a `.glb`'s binary chunk; `None` if it cannot be read.
pub(super) fn json_of_file(path: &Path) -> Option<Vec<u8>> {
    if !path.is_file() {
        return None;
    }
    let mut file = File::open(path).ok()?;
    let mut bytes = Vec::new();
    file.by_ref().take((HEADER + CHUNK_HEADER) as u64).read_to_end(&mut bytes).ok()?;
    if bytes.starts_with(b"glTF") {
        let length = u32_at(&bytes, HEADER)? as u64;
        bytes.clear();
        file.take(length).read_to_end(&mut bytes).ok()?;
    } else {
        file.take(MAX_FILE_BYTES).read_to_end(&mut bytes).ok()?;
    }
    Some(json_alone(&bytes).to_vec())
}

/// Finds the JSON and the binary chunk.
pub(super) fn open(bytes: &[u8]) -> Result<Container<'_>, Fault> {
    if bytes.starts_with(b"glTF") {
        return open_binary(bytes);
    }
    // glTF forbids a byte-order mark, but some editors write one
    let text = without_mark(bytes);
    if text.trim_ascii_start().starts_with(b"{") {
        return Ok(Container { json: text, binary: None });
    }
    Err(Fault::NotGltf)
}

fn open_binary(bytes: &[u8]) -> Result<Container<'_>, Fault> {
    let (Some(version), Some(length)) = (u32_at(bytes, 4), u32_at(bytes, 8)) else {
        return Err(Fault::Container(format!("its header has {} of {HEADER} bytes", bytes.len())));
    };
    if version != 2 {
        return Err(Fault::Version(format!("{version}.0")));
    }
    // bytes after the stated length do not belong to the container
    let Some(body) = bytes.get(HEADER..length) else {
        return Err(Fault::Container(format!("its header states {length} bytes, but the file has {}", bytes.len())));
    };
    let first = split_chunk(body)?;
    if &first.kind != b"JSON" {
        return Err(Fault::Container("its first chunk is not JSON".into()));
    }
    let (mut binary, mut rest) = (None, first.rest);
    while binary.is_none() && !rest.is_empty() {
        // chunks of unknown types must be skipped
        let chunk = split_chunk(rest)?;
        binary = (&chunk.kind == b"BIN\0").then_some(chunk.data);
        rest = chunk.rest;
    }
    Ok(Container { json: json_alone(first.data), binary })
}

/// Removes a byte-order mark, and trailing zeros, with which some writers pad instead of spaces.
fn json_alone(bytes: &[u8]) -> &[u8] {
    let json = without_mark(bytes);
    let end = json.iter().rposition(|&byte| byte != 0).map_or(0, |last| last + 1);
    json.get(..end).unwrap_or_default()
}

struct Chunk<'a> {
    kind: [u8; 4],
    data: &'a [u8],
    /// The bytes after it.
    rest: &'a [u8],
}

fn split_chunk(bytes: &[u8]) -> Result<Chunk<'_>, Fault> {
    let (Some(length), Some(kind)) = (u32_at(bytes, 0), bytes.get(4..).and_then(<[u8]>::first_chunk)) else {
        return Err(Fault::Container(format!("a chunk's header has {} of {CHUNK_HEADER} bytes", bytes.len())));
    };
    let body = bytes.get(CHUNK_HEADER..).unwrap_or_default();
    let Some((data, rest)) = body.split_at_checked(length) else {
        return Err(Fault::Container(format!("a chunk states {length} bytes, but {} are left", body.len())));
    };
    Ok(Chunk { kind: *kind, data, rest })
}

fn u32_at(bytes: &[u8], offset: usize) -> Option<usize> {
    let four = bytes.get(offset..)?.first_chunk()?;
    usize::try_from(u32::from_le_bytes(*four)).ok()
}

fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes)
}
