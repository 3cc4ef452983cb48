//! Time in the sun without a raster: intervals of single points, and hours on flat patches.

mod face_tree;
#[cfg(feature = "test-hooks")]
mod halving;
mod headroom;
mod kept_seconds;
mod patches;
mod probes;
mod search;
mod shade;
mod sift;
mod sky_cells;
mod sky_lines;
mod sky_raster;
mod sun_path;
mod sun_slopes;
mod wall_front;

pub use headroom::{Headroom, PlotSight, RaySource};
pub use kept_seconds::{KeptSeconds, RayHeight, roomiest, spells};
pub use patches::{Exposure, PatchHours};
pub use probes::{Interval, IntervalBound, JudgedPoint, ProbeIntervals, SunDay, Sunlight, judged, longest, secs};
pub use search::{ProbeSearch, SearchedDays};
pub use sky_lines::{DayWay, HourLine, ProbeWay, SkyLines};
pub use sky_raster::{SkyCaster, SkyCell, SkyRaster};
pub use sun_path::SunPath;
pub use sun_slopes::SunSlopes;
pub use wall_front::WallFront;
