//! Where the sun is: the position by NREL SPA, and the instants of a study with their weights.

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
mod sky;
mod track;
mod tz_version;
mod window;
mod zone;

pub use day::{Day, Polar};
pub use day_window::DayWindow;
pub use disc::{SUN_DISC_RAD, disc};
pub use error::SunError;
pub use instant::Instant;
pub use place::{Place, zone_at};
pub use position::{Air, Position, delta_t_secs, position};
pub use reading::{Reading, TimeOfDay, parse_date, parse_duration_secs};
pub use rules::{ZoneRules, zone_names};
pub use sky::{HorizonCrossings, Sky};
pub use track::{EachDay, SunTrack};
pub use tz_version::TzVersion;
pub use window::{MOST_DAYS, Window};
pub use zone::{Zone, ZoneOffset};
