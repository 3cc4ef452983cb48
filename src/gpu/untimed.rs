//! The build without timing of passes: only tests and benches time them, with the feature `test-hooks`.

use super::Gpu;
use wgpu::{ComputePassTimestampWrites, RenderPassTimestampWrites};

#[doc(hidden)]
impl Gpu {
    /// The timestamps that a render pass must write: none in this build.
    pub fn timed(&self, _label: &str) -> Option<RenderPassTimestampWrites<'_>> {
        None
    }

    /// The same for a compute pass.
    pub(crate) fn timed_compute(&self, _label: &str) -> Option<ComputePassTimestampWrites<'_>> {
        None
    }
}
