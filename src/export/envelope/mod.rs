//! How high may be built on a plot: heights as a raster, a drawing with contours, and a solid.

mod map;
mod report;
mod solid;

pub use map::EnvelopeMap;
pub use report::{EnvelopeContext, KeptReceiver, KeptSpot, json, table, window_said};
pub use solid::EnvelopeSolid;
