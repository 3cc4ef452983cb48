//! The window: a site, its sun and its shadows at the speed of the hand. The library computes everything that it shows.
//!
//! One thread draws the window and never waits. A second one (`stage`) draws the picture and takes the newest wish, on a
//! device of its own; others load sites and add up hours (`work`).
//!
//! The folders are layers, from the lowest: `state`, what is open and what a person sets; `results`, what a study came to;
//! `work`, the threads beside the window; `stage`, the thread that draws the picture; `parts`, what the window is drawn of;
//! `app`, the window that owns all of these. Arrows point from a layer to those before it, and within a layer one way.

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
