//! The sun track of a study: its instants, and the days on which they lie.

use super::{Air, Day, Instant, Place, Polar, Reading, Sky, Zone};
use crate::message::Message;

/// The part of each day that a study of several days covers, as written; the whole day where neither end is given.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EachDay {
    /// Its beginning.
    pub from: Option<Reading>,
    /// Its end.
    pub to: Option<Reading>,
}

/// The instants of a study, in time's order, and the days they lie on.
#[derive(Clone, Debug, PartialEq)]
pub struct SunTrack {
    /// In time's order, at least one.
    pub instants: Vec<Instant>,
    /// The days the window touches.
    pub days: Vec<Day>,
    /// The window of each day, if the study has several days.
    pub each_day: Option<EachDay>,
    /// The step between instants in seconds; 0 for a single instant.
    pub step_secs: u32,
    /// How near together the instants lie between which times of change are found, seconds; 0 where the instants alone are
    /// asked. A minute, or the step where that is shorter, unless the site file says otherwise.
    pub resolution_secs: u32,
    /// Whether directions include atmospheric refraction.
    pub refraction: bool,
    /// ΔT used, seconds (Espenak and Meeus), at the window's start.
    pub delta_t_secs: f64,
}

impl SunTrack {
    /// Each of the instants by itself, on its own day, as [`SunTrack::at`] tells of one: of weight and step 0.
    pub fn each(&self) -> impl Iterator<Item = SunTrack> {
        self.instants.iter().map(|instant| {
            let date = instant.time.date_naive();
            SunTrack {
                instants: vec![Instant { weight_secs: 0, gap_secs: 0, ..instant.clone() }],
                days: self.days.iter().filter(|day| day.date == date).cloned().collect(),
                each_day: None,
                step_secs: 0,
                resolution_secs: 0,
                refraction: self.refraction,
                delta_t_secs: self.delta_t_secs,
            }
        })
    }

    /// The sky under which its instants were found: the sun at any time between them.
    pub fn sky<'a>(&self, place: &'a Place) -> Sky<'a> {
        let air = self.refraction.then(|| Air::standard(place.elevation_m));
        Sky { place, delta_t_secs: self.delta_t_secs, air }
    }

    /// What the user should know of its clock, and of days without a sun; each a sentence without its stop.
    pub fn notes(&self) -> Vec<Message> {
        let dark = self.days.iter().filter(|day| day.polar == Some(Polar::Night)).count();
        let dark = match self.days.as_slice() {
            _ if dark == 0 => None,
            [day] => Some(format!("no sun on {} (polar night)", day.date)),
            days => Some(format!("no sun on {dark} of {} days (polar night)", days.len())),
        };
        let doubt = self.instants.last().and_then(|instant| Zone::doubt(&instant.time));
        doubt.into_iter().chain(dark).map(Message::from).collect()
    }

    /// How long the window is, seconds: the sum of the weights.
    #[cfg(feature = "test-hooks")]
    pub fn window_secs(&self) -> u64 {
        self.instants.iter().map(|instant| u64::from(instant.weight_secs)).sum()
    }
}
