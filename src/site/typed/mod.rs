//! What people type and paste for numbers, degrees, dates and times, in the ways in which they write them.
//!
//! The window's fields and `--place` read so. Site files and all other options keep to the one way that is documented.

mod axis;
mod date;
mod degrees;
mod error;
mod number;

pub use axis::Axis;
pub(super) use date::INSTANTS_ALONE;
pub use date::{clock, date, resolution, step};
pub use degrees::{Degrees, degrees, place};
pub use error::TypedError;
pub use number::{number, within};
