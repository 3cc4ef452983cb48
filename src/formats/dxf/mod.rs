//! Reads DXF, ASCII or binary: one part per layer, and per block and layer.
//!
//! The reader is our own: the crate `dxf` keeps all entities of a drawing as structs, does not know MESH, and does not
//! report what it skipped. `group` reads codes and values, `sections` the sections, and `fields` an entity. `entity`,
//! `outline` and `polyline` turn entities into triangles, `frame` computes the axes of planes, and `place` puts blocks
//! where they are inserted.

mod drawing;
mod entity;
mod faces;
mod fields;
mod frame;
mod group;
mod outline;
mod place;
mod polyline;
mod sections;

use super::source::{as_ascii, words};
use super::whole::whole_file;
use super::{Format, Model, ModelFault, ReadOptions};
use drawing::Drawing;
use std::path::Path;

/// DXF, `.dxf`.
pub(super) struct Dxf;

impl Format for Dxf {
    fn name(&self) -> &'static str {
        "DXF"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["dxf"]
    }

    fn begins(&self, head: &[u8]) -> bool {
        if head.starts_with(group::SENTINEL) {
            return true;
        }
        // comments may stand before the first section
        let head = as_ascii(head.get(..4096).unwrap_or(head).to_vec());
        let begin: Vec<&[u8]> = words(&head).collect();
        let is_section = begin.windows(3).any(|three| matches!(three, [b"0", b"SECTION", b"2"]));
        is_section && matches!(begin.first(), Some(&b"0" | &b"999"))
    }

    fn read(&self, path: &Path, _options: &ReadOptions) -> Result<Model, ModelFault> {
        let bytes = whole_file(path)?;
        let bytes = if bytes.starts_with(group::SENTINEL) { bytes } else { as_ascii(bytes) };
        Ok(place::model_of(Drawing::read(&bytes)?)?)
    }
}
