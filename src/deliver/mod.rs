//! Deliverables: a request goes in, files come out. Both faces use these functions, so that everything that is made
//! from a site is made in one place.
//!
//! Each deliverable is one function. It takes a checked [`Site`](crate::site::Site) and a small request, reports
//! events, writes to a [`Sink`], and returns a typed answer that a face prints or shows. `disk` handles a study's files
//! while it runs.

pub mod animation;
pub mod comparison;
pub mod conversion;
pub mod disk;
pub mod envelope;
mod error;
pub mod instant;
pub mod judgement;
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
