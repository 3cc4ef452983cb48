//! The GPU, without any knowledge of sun and shadow: device, layouts, shaders, targets, compute passes, readback,
//! timers.

mod compute;
mod device;
#[doc(hidden)]
pub mod layout;
#[cfg(feature = "test-hooks")]
mod losing;
#[doc(hidden)]
pub mod readback;
#[doc(hidden)]
pub mod shaders;
pub(crate) mod targets;
#[cfg(feature = "test-hooks")]
mod timers;
#[cfg(feature = "test-hooks")]
mod timing;
#[cfg(not(feature = "test-hooks"))]
mod untimed;

pub use device::{Gpu, GpuError};
#[cfg(feature = "test-hooks")]
pub use losing::lose_after;
