//! The sun: its position by NREL SPA, and the instants of a study with their weights.

mod clock;
mod day;
mod day_window;
mod days;
mod disc;
mod error;
mod instant;
mod meant;
mod place;
mod position;
mod reading;
mod rules;
mod season;
mod sky;
mod smooth_sky;
mod track;
mod true_solar;
mod tz_version;
mod window;
mod zone;

#[doc(hidden)]
pub use day::Sunrise;
pub use day::{Day, Polar};
#[doc(hidden)]
pub use day_window::DayWindow;
#[doc(hidden)]
pub use disc::{SUN_DISC_RAD, disc};
pub use error::SunError;
pub use instant::Instant;
pub use place::Place;
#[doc(hidden)]
pub use place::zone_at;
pub use position::Position;
#[doc(hidden)]
pub use position::{Air, delta_t_secs, position};
pub use reading::{Reading, TimeOfDay};
#[doc(hidden)]
pub use reading::{parse_date, parse_duration_secs};
#[doc(hidden)]
pub use rules::{ZoneRules, zone_names};
#[doc(hidden)]
pub use season::{Season, apparent_longitude_deg};
#[doc(hidden)]
pub use sky::{HorizonCrossings, Sky};
#[doc(hidden)]
pub use smooth_sky::SmoothSky;
pub use track::{EachDay, SunTrack};
#[doc(hidden)]
pub use true_solar::true_solar;
pub use tz_version::TzVersion;
#[doc(hidden)]
pub use window::MOST_DAYS;
pub use window::Window;
pub use zone::{Zone, ZoneOffset};
