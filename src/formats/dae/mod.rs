//! Collada 1.4 and 1.5 → parts: one per node and material for each place where the node stands.
//!
//! The XML is read once, from its beginning to its end, and no entity in it is expanded. `xml` reads elements, `library`
//! and its `mesh`, `node` and `effect` what they say, `build` places the nodes.

mod build;
mod document;
mod effect;
mod library;
mod mesh;
mod node;
mod xml;

use super::source::{as_ascii, text};
use super::whole::whole_file;
use super::{Format, Model, ModelFault, ReadOptions};
use document::DaeDocument;
use std::path::Path;

/// Collada, `.dae`.
pub(super) struct Dae;

impl Format for Dae {
    fn name(&self) -> &'static str {
        "Collada"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["dae"]
    }

    fn begins(&self, head: &[u8]) -> bool {
        let head = as_ascii(head.to_vec());
        head.trim_ascii_start().starts_with(b"<") && head.windows(8).any(|eight| eight == b"<COLLADA")
    }

    fn read(&self, path: &Path, _options: &ReadOptions) -> Result<Model, ModelFault> {
        let source = String::from_utf8(as_ascii(whole_file(path)?)).unwrap_or_else(|error| text(error.as_bytes()));
        Ok(build::model_of(DaeDocument::read(&source)?)?)
    }
}
