//! The sun track of a study: its instants, and the days on which they lie.

use super::{Air, Day, Instant, Place, Polar, Reading, Sky, Zone};
use crate::message::Message;

/// The part of each day in a study of several days, as written; the whole day if neither end is given.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EachDay {
    /// Its beginning.
    pub from: Option<Reading>,
    /// Its end.
    pub to: Option<Reading>,
}

/// The instants of a study, in order of time, and the days that they are on.
#[derive(Clone, Debug, PartialEq)]
pub struct SunTrack {
    /// In order of time, at least one.
    pub instants: Vec<Instant>,
    /// The days that the window touches.
    pub days: Vec<Day>,
    /// The window of each day, if the study has several days.
    pub each_day: Option<EachDay>,
    /// The step between instants in seconds; 0 for a single instant.
    pub step_secs: u32,
    /// The precision of times of change between instants, seconds; 0 to use the instants alone. By default a minute, or
    /// the step if that is shorter.
    pub resolution_secs: u32,
    /// Whether directions include atmospheric refraction.
    pub refraction: bool,
    /// The ΔT that was used, seconds (Espenak and Meeus), at the window's start.
    pub delta_t_secs: f64,
}

impl SunTrack {
    /// Returns tracks of single instants, each on its own day, as [`SunTrack::at`] returns them: with weight and step
    /// 0.
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

    /// Returns the sky for these instants, to find the sun at times between them.
    pub fn sky<'a>(&self, place: &'a Place) -> Sky<'a> {
        let air = self.refraction.then(|| Air::standard(place.elevation_m));
        Sky { place, delta_t_secs: self.delta_t_secs, air }
    }

    /// The notes on its clock, and on days without a sun; each a sentence without a full stop.
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

    /// The length of the window, seconds: the sum of the weights.
    #[cfg(feature = "test-hooks")]
    pub fn window_secs(&self) -> u64 {
        self.instants.iter().map(|instant| u64::from(instant.weight_secs)).sum()
    }
}
