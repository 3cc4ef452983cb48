//! Reads Collada 1.4 and 1.5: one part per node and material for each place of the node.
//!
//! The XML is read once, from beginning to end, without expanding entities. `zipped` finds it in an archive, `xml`
//! reads elements, `library` with its `mesh`, `node` and `effect` interprets them, and `build` places the nodes.

mod build;
mod document;
mod effect;
mod library;
mod mesh;
mod node;
mod xml;
mod zipped;

use super::source::as_ascii;
use super::whole::whole_file;
use super::{Format, Model, ModelFault, ReadOptions, archive};
use document::DaeDocument;
use std::path::Path;

/// Collada, `.dae`, also zipped, `.zae`.
pub(super) struct Dae;

impl Format for Dae {
    fn name(&self) -> &'static str {
        "Collada"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["dae", "zae"]
    }

    fn begins(&self, head: &[u8]) -> bool {
        if archive::begins_with(head, zipped::ENDING) {
            return true;
        }
        let head = as_ascii(head.to_vec());
        head.trim_ascii_start().starts_with(b"<") && head.windows(8).any(|eight| eight == b"<COLLADA")
    }

    fn read(&self, path: &Path, _options: &ReadOptions) -> Result<Model, ModelFault> {
        let bytes = whole_file(path)?;
        if !archive::is_archive(&bytes) {
            return Ok(build::model_of(DaeDocument::read(&xml::text_of(bytes))?)?);
        }
        let zipped = zipped::document(&bytes)?;
        let mut model = build::model_of(DaeDocument::read(&xml::text_of(zipped.bytes))?)?;
        model.notes.extend(zipped.note);
        Ok(model)
    }
}
