//! Masks times weights, added up where the masks are.
use crate::gpu::Gpu;
use crate::shadow::{DrawnMask, ShadowError};
use std::sync::Arc;
/// The running sum of shaded time, in 1/255 s.
pub struct Sum {}
impl Sum {
    /// All zero; on the GPU where masks are drawn there.
    pub fn new(_gpu: Option<Arc<Gpu>>, _width: u32, _height: u32) -> Sum {
        todo!()
    }
    /// Adds one mask for so many seconds.
    pub fn add(&mut self, _mask: &DrawnMask<'_>, _weight_secs: u32) -> Result<(), ShadowError> {
        todo!()
    }
    /// Per cell the shaded time in 1/255 s.
    pub fn finish(self) -> Result<Vec<u32>, ShadowError> {
        todo!()
    }
}
