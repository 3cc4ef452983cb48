//! Reads numbers, degrees, dates and times in all the spellings that people type and paste.
//!
//! The window's fields and the command's place are read in this way. Site files and all other options have one
//! documented spelling; a few of their readers are here, too.

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
