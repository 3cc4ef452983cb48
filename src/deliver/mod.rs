//! Deliverables: a request in, files out. What both faces make of a site is made here, once.
//!
//! Each deliverable is one function: from a checked [`Site`](crate::site::Site) and a small request, through events, into a
//! [`Sink`], with a typed answer that a face prints or shows. What lies on the disk while a study goes on lies beside it.

pub mod animation;
pub mod comparison;
pub mod conversion;
pub mod disk;
mod error;
pub mod instant;
pub mod lines;
mod parts;
pub mod patches;
pub mod probe;
pub mod profile;
mod shelf;
mod sink;
pub mod verification;
pub mod volumes;

pub use error::DeliverError;
pub use parts::{DrawnView, figure_context};
pub use sink::{Folder, NamedFile, Sink, WrittenFiles};
