//! What drew an answer, and how long it took.

use crate::choice::{Engine, Finder, Method, Settings};

/// What drew an answer: never [`Method::Auto`], [`Finder::Auto`] or [`Engine::Auto`], always the choice that was made.
#[derive(Clone, Debug, PartialEq)]
pub struct Provenance {
    /// The technique.
    pub technique: Method,
    /// The finder of silhouettes; absent if none was used.
    pub finder: Option<Finder>,
    /// The machine.
    pub engine: Engine,
    /// The graphics adapter's own name; absent if none was used.
    pub adapter: Option<String>,
    /// The settings of the technique; those that it does not use are absent. Without [`Settings::sun_samples`] the sun
    /// was its centre; [`Settings::smoothie_width_m`] is present only if it was set by hand.
    pub settings: Settings,
    /// The precision of the times at which light changes between two instants, seconds; 0 if the answer uses the
    /// instants alone.
    pub resolution_secs: u32,
}

/// The duration of each stage in seconds, in the order of the work; the last one is `total`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Timings(pub Vec<(&'static str, f64)>);
