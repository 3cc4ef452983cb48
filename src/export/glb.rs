//! A binary glTF 2.0 file, assembled from lists and the data that they point to.

use super::ExportError;
use glam::Vec3;
use gltf::binary::{Glb, Header};
use serde_json::{Value, json};
use std::borrow::Cow;

/// Constants of the format (glTF 2.0, section 5).
pub(super) const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
pub(super) const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// The asset, with the program that wrote it.
pub(super) fn asset() -> Value {
    json!({"version": "2.0", "generator": concat!("gnomon ", env!("CARGO_PKG_VERSION"))})
}

/// The views and accessors so far, with their data.
#[derive(Default)]
pub(super) struct GlbFile {
    data: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl GlbFile {
    /// Adds data. Returns the index of its view.
    pub(super) fn view(&mut self, bytes: impl IntoIterator<Item = u8>, target: Option<u32>) -> usize {
        let offset = self.data.len();
        self.data.extend(bytes);
        let mut view = json!({"buffer": 0, "byteOffset": offset, "byteLength": self.data.len() - offset});
        if let Some(target) = target {
            view["target"] = target.into();
        }
        // what follows may be read as four-byte words
        self.data.resize(self.data.len().next_multiple_of(4), 0);
        self.views.push(view);
        self.views.len() - 1
    }

    /// Adds an accessor and its data. Returns its index.
    pub(super) fn accessor(&mut self, mut accessor: Value, bytes: impl IntoIterator<Item = u8>, target: u32) -> usize {
        accessor["bufferView"] = self.view(bytes, Some(target)).into();
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// Adds the accessors of positions and indices.
    pub(super) fn triangles(&mut self, positions: &[Vec3], corners: &[u32]) -> [usize; 2] {
        let low = positions.iter().copied().fold(Vec3::INFINITY, Vec3::min);
        let high = positions.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
        let position = self.accessor(
            json!({"componentType": FLOAT, "type": "VEC3", "count": positions.len(),
                   "min": low.to_array(), "max": high.to_array()}),
            positions.iter().flat_map(Vec3::to_array).flat_map(f32::to_le_bytes),
            ARRAY_BUFFER,
        );
        let indices = self.accessor(
            json!({"componentType": UNSIGNED_INT, "type": "SCALAR", "count": corners.len()}),
            corners.iter().copied().flat_map(u32::to_le_bytes),
            ELEMENT_ARRAY_BUFFER,
        );
        [position, indices]
    }

    /// Completes the file; `document` has all other lists.
    ///
    /// # Errors
    /// [`ExportError::LargeGlb`] if it would be 4 GiB or larger; [`ExportError::Encode`] of `what` if an encoder fails.
    pub(super) fn finish(self, what: &'static str, mut document: Value) -> Result<Vec<u8>, ExportError> {
        let refused = |why: String| ExportError::encode(what, why);
        document["accessors"] = self.accessors.into();
        document["bufferViews"] = self.views.into();
        document["buffers"] = json!([{"byteLength": self.data.len()}]);
        let document = serde_json::to_vec(&document).map_err(|error| refused(error.to_string()))?;
        let total = 12 + 8 + document.len().next_multiple_of(4) as u64 + 8 + self.data.len() as u64;
        let Ok(length) = u32::try_from(total) else {
            return Err(ExportError::LargeGlb { size: total });
        };
        let header = Header { magic: *b"glTF", version: 2, length };
        let glb = Glb { header, json: Cow::Owned(document), bin: Some(Cow::Owned(self.data)) };
        glb.to_vec().map_err(|error| refused(error.to_string()))
    }
}
