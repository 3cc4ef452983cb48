//! The window: a site, its sun and its shadows, drawn interactively. The library computes everything that the window
//! shows.
//!
//! One thread draws the window and never waits. A second one (`stage`) takes the newest wish and draws the picture on a
//! device of its own; others load sites and run studies (`work`).
//!
//! The folders are layers, from the lowest: `state`, what is open and the settings; `results`, the results of studies;
//! `work`, the worker threads; `stage`, the thread that draws the picture; `parts`, the parts of the window; `app`, the
//! window itself, which owns all of these. A layer uses only those before it, and within a layer files use each other
//! in one direction.

mod app;
mod event_loop;
#[cfg(feature = "test-hooks")]
mod hooks;
mod parts;
mod reopening;
mod results;
mod stage;
mod state;
mod work;

pub use app::state::App;
#[cfg(feature = "test-hooks")]
pub use reopening::setup;
pub use reopening::{open, open_with};
