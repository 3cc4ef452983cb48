//! The machine, which knows no sun and no shadow: device, layouts, shaders, targets, computing, readback, timers.

pub mod compute;
mod device;
pub mod layout;
pub mod readback;
pub mod shaders;
pub mod targets;
mod timers;
mod timing;

pub use device::{Gpu, GpuError, lose_after};
