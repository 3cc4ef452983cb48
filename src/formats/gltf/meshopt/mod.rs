//! EXT_meshopt_compression and KHR_meshopt_compression: decodes a compressed buffer view.
//!
//! Written from the specification's Appendix A (bitstream) and B (filters); `attributes` and `indices` are its modes.
//! The existing binding to the C++ library needs a C++ compiler, and the existing port fixes the size of a vertex at
//! compile time.

mod attributes;
mod indices;

use super::Fault;
use super::document::Document;
use gltf::json::validation::USize64;
use serde_json::Value;
use std::ops::Range;

/// The compression of a view.
pub(super) struct CompressedView<'a> {
    view: usize,
    view_bytes: u64,
    said: &'a Value,
}

impl<'a> CompressedView<'a> {
    /// The compression of a view, if it has one.
    pub(super) fn of(document: &'a Document, index: usize) -> Option<Self> {
        let view = document.buffer_views.get(index)?;
        let mut extensions = view.extensions.as_ref()?.others.iter();
        let (_, said) = extensions
            .find(|(name, _)| matches!(name.as_str(), "EXT_meshopt_compression" | "KHR_meshopt_compression"))?;
        let USize64(view_bytes) = view.byte_length;
        Some(Self { view: index, view_bytes, said })
    }

    fn number(&self, key: &str) -> Option<u64> {
        self.said.get(key)?.as_u64()
    }

    /// The buffer with the compressed bytes, and their range.
    pub(super) fn source(&self) -> Result<(usize, Range<u64>), Fault> {
        let buffer = self.number("buffer").and_then(|buffer| usize::try_from(buffer).ok());
        let start = self.number("byteOffset").unwrap_or(0);
        match (buffer, self.number("byteLength")) {
            (Some(buffer), Some(length)) => Ok((buffer, start..start.saturating_add(length))),
            _ => Err(self.damaged("does not say where its bytes are")),
        }
    }

    /// Decodes the bytes that the view's accessors read.
    pub(super) fn decode(&self, source: &[u8]) -> Result<Vec<u8>, Fault> {
        let size = |key| self.number(key).and_then(|number| usize::try_from(number).ok());
        let (Some(count), Some(stride)) = (size("count"), size("byteStride")) else {
            return Err(self.damaged("does not say how many elements it has"));
        };
        if count.checked_mul(stride).is_none_or(|bytes| bytes as u64 != self.view_bytes) {
            return Err(self.damaged("has a different size than its elements"));
        }
        let mode = self.said.get("mode").and_then(Value::as_str).unwrap_or_default();
        let mut decoded = match mode {
            "ATTRIBUTES" => attributes::decode(source, count, stride),
            "TRIANGLES" => indices::triangles(source, count, stride),
            "INDICES" => indices::sequence(source, count, stride),
            _ => None,
        }
        .ok_or_else(|| self.damaged("cannot be unpacked"))?;
        match (self.said.get("filter").and_then(Value::as_str).unwrap_or("NONE"), stride) {
            ("NONE", _) => (),
            ("EXPONENTIAL", _) => attributes::exponential(&mut decoded),
            ("QUATERNION", 8) => attributes::quaternion(&mut decoded),
            // such elements do not move vertices
            ("OCTAHEDRAL" | "COLOR", _) => {
                return Err(self.damaged("contains directions or colours where other values are expected"));
            }
            _ => return Err(self.damaged("has an unknown filter")),
        }
        Ok(decoded)
    }

    fn damaged(&self, problem: &str) -> Fault {
        Fault::Unpacking { what: format!("buffer view {}", self.view), problem: format!("{problem} (meshopt)") }
    }
}
