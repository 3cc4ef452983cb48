//! Where the sun is: the position by NREL SPA, and the instants of a study with their weights.

mod clock;
mod day;
mod day_window;
mod days;
mod disc;
mod error;
mod meant;
mod place;
mod position;
mod rules;
mod sky;
mod window;
mod zone;

pub use clock::{Reading, TimeOfDay};
#[doc(hidden)]
pub use clock::{parse_date, parse_duration_secs};
#[doc(hidden)]
pub use day_window::DayWindow;
pub use days::EachDay;
#[doc(hidden)]
pub use disc::{SUN_DISC_RAD, disc};
pub use error::SunError;
#[doc(hidden)]
pub use place::zone_at;
pub use position::Position;
#[doc(hidden)]
pub use position::{Air, delta_t_secs, position};
pub use rules::TzVersion;
#[doc(hidden)]
pub use rules::{ZoneRules, zone_names};
#[doc(hidden)]
pub use sky::{HorizonCrossings, Sky};
#[doc(hidden)]
pub use window::MOST_DAYS;
pub use window::Window;
pub use zone::{Zone, ZoneOffset};

use chrono::{DateTime, NaiveDate};
use glam::DVec3;

/// A point on the earth and its clock.
///
/// Latitude and longitude stay in degrees, as the world writes them and as SPA takes them.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// What people call it; empty when nobody said.
    pub name: String,
    /// Degrees, north positive.
    pub latitude_deg: f64,
    /// Degrees, east positive.
    pub longitude_deg: f64,
    /// Metres above sea level.
    pub elevation_m: f64,
    /// The zone whose clock is read there.
    pub time_zone: Zone,
}

/// One instant of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Instant {
    /// Local clock time of the place.
    pub time: DateTime<Zone>,
    /// Unit vector to the sun's centre in the world frame (refraction included where it is on).
    pub to_sun: DVec3,
    /// Clockwise from true north, radians.
    pub azimuth_rad: f64,
    /// Above the horizon, radians.
    pub altitude_rad: f64,
    /// How many seconds of the window this instant stands for.
    pub weight_secs: u32,
    /// Whether the sun is below the horizon: the mask is 0 everywhere and the instant enters no sum.
    pub night: bool,
}

/// One calendar day at the place; what does not happen on it (polar day and night) is absent.
#[derive(Clone, Debug, PartialEq)]
pub struct Day {
    /// The local date.
    pub date: NaiveDate,
    /// Upper limb at −0.833°.
    pub sunrise: Option<DateTime<Zone>>,
    /// The sun's transit.
    pub noon: Option<DateTime<Zone>>,
    /// Upper limb at −0.833°.
    pub sunset: Option<DateTime<Zone>>,
    /// Whether the sun neither rises nor sets on it.
    pub polar: Option<Polar>,
}

/// A day on which the sun neither rises nor sets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Polar {
    /// It stays up.
    Day,
    /// It stays down.
    Night,
}

/// The instants of a study, in time's order, and the days they lie on.
#[derive(Clone, Debug, PartialEq)]
pub struct SunTrack {
    /// In time's order, at least one.
    pub instants: Vec<Instant>,
    /// The days the window touches.
    pub days: Vec<Day>,
    /// Where a window was asked on each of several days: which.
    pub each_day: Option<EachDay>,
    /// The step between instants in seconds; 0 for a single instant.
    pub step_secs: u32,
    /// Whether directions include atmospheric refraction.
    pub refraction: bool,
    /// ΔT used, seconds (Espenak and Meeus), at the window's start.
    pub delta_t_secs: f64,
}

impl Instant {
    /// Clockwise from true north, degrees, as it is printed: to 0.00001°.
    pub fn azimuth_deg(&self) -> f64 {
        as_printed(self.azimuth_rad.to_degrees()) % 360.0
    }

    /// Above the horizon, degrees, as it is printed: to 0.00001°. Below 0 is night.
    pub fn altitude_deg(&self) -> f64 {
        as_printed(self.altitude_rad.to_degrees())
    }
}

impl SunTrack {
    /// Each of the instants by itself, on its own day, as [`SunTrack::at`] tells of one: of weight and step 0.
    pub fn each(&self) -> impl Iterator<Item = SunTrack> {
        self.instants.iter().map(|instant| {
            let date = instant.time.date_naive();
            SunTrack {
                instants: vec![Instant { weight_secs: 0, ..instant.clone() }],
                days: self.days.iter().filter(|day| day.date == date).cloned().collect(),
                each_day: None,
                step_secs: 0,
                refraction: self.refraction,
                delta_t_secs: self.delta_t_secs,
            }
        })
    }

    /// What the user should know of its clock, and of days without a sun; each a sentence without its stop.
    pub fn notes(&self) -> Vec<String> {
        let dark = self.days.iter().filter(|day| day.polar == Some(Polar::Night)).count();
        let dark = match self.days.as_slice() {
            _ if dark == 0 => None,
            [day] => Some(format!("no sun on {} (polar night)", day.date)),
            days => Some(format!("no sun on {dark} of {} days (polar night)", days.len())),
        };
        self.instants.last().and_then(|instant| Zone::doubt(&instant.time)).into_iter().chain(dark).collect()
    }

    /// How long the window is, seconds: the sum of the weights.
    #[cfg(feature = "test-hooks")]
    pub fn window_secs(&self) -> u64 {
        self.instants.iter().map(|instant| u64::from(instant.weight_secs)).sum()
    }
}

/// SPA is good to 0.0003°; more digits than these say nothing. Never −0.
fn as_printed(degrees: f64) -> f64 {
    (degrees * 1e5).round() / 1e5 + 0.0
}
