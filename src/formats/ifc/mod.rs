//! IFC → parts. `ifc-lite` reads the text and builds the shapes; which of them are taken, their names and their places
//! are decided here.
//!
//! The reader is another library, in the feature `ifc`; without it a file of the format is one error. The files of this
//! folder, in the order of the flow: `marks` (whether a file is IFC, and complete), `container` (a file, zipped or not
//! → its text), `scan` (text → which records matter), `layers` (which of them are off), `relations` (storeys and
//! materials), `parts` (shapes → parts), `lost` (products without triangles), `anchors` (where the file's zero lies),
//! `build` (all of it → the model).

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
            "is IFC, and this gnomon was built without its reader";
            "build it with the feature ifc, or export the model as glTF"
        ]
        .into())
    }

    fn is_foreign(&self, _path: &Path, _options: &ReadOptions) -> bool {
        true
    }
}
