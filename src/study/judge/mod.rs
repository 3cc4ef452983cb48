//! A site judged by a rule: what the rule needs, the light of each receiver to the second, and its verdicts.
//!
//! Points are searched exactly, as probes are, in the state that is judged and in the one before. On an area, points
//! are added until the parts that the rule asks for are known precisely enough.

mod area_light;
mod areas;
mod asking;
mod bands;
mod border_points;
mod days;
mod facades;
mod groups;
mod judging;
mod kept;
mod kept_demand;
mod needs;
mod on_plot;
mod open_spaces;
mod parts;
mod point_light;
mod receivers;
mod samples;
mod state_search;
mod takers;
mod whole;
mod windows;

pub use asking::judge;
pub use kept::{KeptByDemand, kept_by, plot_to_build_on};
pub use needs::with_needs;
#[cfg(feature = "test-hooks")]
pub use parts::{MeasuredPart, measured_part};
