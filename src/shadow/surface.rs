//! .
/// x
pub struct GpuSurface;
