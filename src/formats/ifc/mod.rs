//! Reads IFC. `ifc-lite` parses the text and builds the shapes; this folder decides which of them are used, their names
//! and their places.
//!
//! The reader is another library, in the feature `ifc`; without it, an IFC file is an error. The files of this folder,
//! in the order of the flow: `marks` (recognises complete IFC files), `container` (finds the text in a file, zipped or
//! not), `scan` (finds the relevant records), `layers` (finds hidden layers), `relations` (storeys and materials),
//! `parts` (makes parts of shapes), `lost` (products without triangles), `anchors` (where the origin lies), and `build`
//! (makes the model).

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
mod marks;
#[cfg(feature = "ifc")]
mod parts;
#[cfg(feature = "ifc")]
mod relations;
#[cfg(feature = "ifc")]
mod scan;

use super::{Format, Model, ModelFault, ReadOptions, archive};
use marks::is_ifc_text;
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
        is_ifc_text(head) || archive::begins_with(head, ".ifc")
    }

    #[cfg(feature = "ifc")]
    fn read(&self, path: &Path, options: &ReadOptions) -> Result<Model, ModelFault> {
        let container = container::read(path)?;
        build::model(container, options)
    }

    #[cfg(not(feature = "ifc"))]
    fn read(&self, _path: &Path, _options: &ReadOptions) -> Result<Model, ModelFault> {
        Err(crate::message::message![
            "is IFC, but this gnomon was built without a reader for it";
            "build it with the feature ifc, or export the model as glTF"
        ]
        .into())
    }

    fn is_foreign(&self, _path: &Path, _options: &ReadOptions) -> bool {
        true
    }
}
