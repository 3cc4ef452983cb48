//! IFC → the parts that stand there. `ifc-lite` reads the text and builds the shapes; which of them stand there, what they
//! are called and where they lie is decided here.
//!
//! The reader is others' code, in the feature `ifc`: without it a file of the format is one error. The files of this
//! folder, in the order of the flow: `container` (a file, zipped or not → its text), `scan` (text → which records matter),
//! `layers` (and which of them are off), `relations` (whose storey and material), `parts` (shapes → parts), `lost` (what became of
//! the products without), `anchors` (where the file's zero lies), `build` (all of it → the model).

#[cfg(feature = "ifc")]
mod anchors;
#[cfg(feature = "ifc")]
mod build;
#[cfg(feature = "ifc")]
mod container;
#[cfg(feature = "ifc")]
mod layers;
#[cfg(feature = "ifc")]
mod lost;
#[cfg(feature = "ifc")]
mod parts;
#[cfg(feature = "ifc")]
mod relations;
#[cfg(feature = "ifc")]
mod scan;

use super::{Format, Model, ModelFault, ReadOptions};
use std::path::Path;

/// IFC 2x3, 4 and 4x3 as text (`.ifc`), also zipped (`.ifczip`).
pub(super) struct Ifc;

impl Format for Ifc {
    fn name(&self) -> &'static str {
        "IFC"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["ifc", "ifczip"]
    }

    fn begins(&self, head: &[u8]) -> bool {
        is_ifc_text(head) || is_zipped_ifc(head)
    }

    #[cfg(feature = "ifc")]
    fn read(&self, path: &Path, options: &ReadOptions) -> Result<Model, ModelFault> {
        let container = container::read(path)?;
        build::model(container, options)
    }

    #[cfg(not(feature = "ifc"))]
    fn read(&self, _path: &Path, _options: &ReadOptions) -> Result<Model, ModelFault> {
        Err(crate::message::message![
            "is IFC, and this gnomon was built without its reader";
            "build it with the feature ifc, or export the model as glTF"
        ]
        .into())
    }

    fn is_foreign(&self) -> bool {
        true
    }
}

/// Whether a file begins as STEP text whose schema is one of IFC. Other programs write other schemas in the same form.
fn is_ifc_text(head: &[u8]) -> bool {
    let text = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head).trim_ascii_start();
    let Some(header) = text.strip_prefix(b"ISO-10303-21") else { return false };
    let schema = header.windows(11).position(|word| word.eq_ignore_ascii_case(b"FILE_SCHEMA"));
    let Some(rest) = schema.and_then(|at| header.get(at..)) else { return false };
    let list = rest.split(|&byte| byte == b';').next().unwrap_or_default();
    list.windows(3).any(|word| word.eq_ignore_ascii_case(b"IFC"))
}

/// Whether a file begins as a zip archive whose first entry is an IFC file: others' archives begin alike.
fn is_zipped_ifc(head: &[u8]) -> bool {
    let Some(entry) = head.strip_prefix(b"PK\x03\x04") else { return false };
    let length = entry.get(22..24).and_then(|bytes| bytes.try_into().ok()).map(u16::from_le_bytes);
    let name = length.and_then(|length| entry.get(26..26 + usize::from(length)));
    name.is_some_and(|name| name.to_ascii_lowercase().ends_with(b".ifc"))
}
