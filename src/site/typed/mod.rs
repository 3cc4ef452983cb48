//! Numbers, degrees, dates and times in all the ways in which people type and paste them.
//!
//! The window's fields and the command's place are read in this way. Site files and all other options have one way,
//! which is documented, and a few of their readers stand here, too.

mod axis;
mod date;
mod degrees;
mod documented;
mod error;
mod number;

pub use axis::Axis;
pub use date::{clock, date, resolution, step};
pub use degrees::{Degrees, degrees, place};
pub use documented::{numbers, resolution_secs};
pub use error::TypedError;
pub use number::{number, within};
