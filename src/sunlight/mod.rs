//! Time in the sun where there is no raster: the intervals of single points, and hours on flat patches.

mod patches;
mod probes;

pub use patches::{Exposure, PatchHours};
pub use probes::{Interval, IntervalBound, ProbeIntervals, SunDay, Sunlight, judged, longest, secs};
