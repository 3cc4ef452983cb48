//! Reads a file's text: the file itself, or the `.ifc` within a zip archive. The contents decide which it is, not the
//! file's name.

use crate::formats::ModelFault;
use crate::formats::archive::{self, ModelArchive};
use crate::message::message;
use std::fs::File;
use std::io::Read as _;
use std::path::Path;

/// The greatest length for the reader's 32-bit positions.
const MAX_TEXT_BYTES: u64 = u32::MAX as u64;

/// The text of a file, and the entries of its archive that were not read.
pub(super) struct IfcText {
    pub bytes: Vec<u8>,
    pub ignored: Vec<String>,
}

/// Reads a file, or the model in it if it is an archive.
pub(super) fn read(path: &Path) -> Result<IfcText, ModelFault> {
    let length = std::fs::metadata(path).map_err(ModelFault::unreadable)?.len();
    if length > MAX_TEXT_BYTES {
        let what = format!("has {} MiB, but an IFC file may have at most 4095", length >> 20);
        return Err(message![what; "export it storey by storey"].into());
    }
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(ModelFault::unreadable)?;
    file.take(MAX_TEXT_BYTES).read_to_end(&mut bytes).map_err(ModelFault::unreadable)?;
    if archive::is_archive(&bytes) {
        return unzipped(&bytes);
    }
    if bytes.starts_with(b"\xef\xbb\xbf") {
        bytes.drain(..3);
    }
    Ok(IfcText { bytes, ignored: Vec::new() })
}

/// Unpacks the first IFC file of an archive.
fn unzipped(bytes: &[u8]) -> Result<IfcText, ModelFault> {
    let archive = ModelArchive::open(bytes, ".ifc")?;
    let mut models = archive.models();
    let text = models.next().map(|name| archive.unpacked(name, MAX_TEXT_BYTES)).transpose()?.flatten();
    let Some(mut text) = text else {
        return Err(message![
            "is a zip archive with no .ifc in it";
            "export the model as IFC, not as ifcXML"
        ]
        .into());
    };
    if text.starts_with(b"\xef\xbb\xbf") {
        text.drain(..3);
    }
    Ok(IfcText { bytes: text, ignored: models.map(str::to_owned).collect() })
}
