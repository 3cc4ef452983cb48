//! When points lie in the sun, and what blocks it.

use crate::shadow::JUDGED_ABOVE_M;
use crate::sun::{DayWindow, Zone};
use crate::view::Probe;
use chrono::{DateTime, NaiveDate};
use glam::DVec3;

/// What bounds an interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IntervalBound {
    /// Nothing: the requested window begins or ends.
    Window,
    /// The sun is down.
    Horizon,
    /// The sun is behind the probe's own plane, or in it.
    Behind,
    /// The ground: the probe lies below it.
    Ground,
    /// The casting component that is nearest to the probe on the way to the sun, by its index in
    /// [`Sunlight::components`].
    Component(usize),
}

/// A time in sunlight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The first second in sunlight.
    pub start: DateTime<Zone>,
    /// The first second no longer in it.
    pub end: DateTime<Zone>,
    /// What blocks one second before the start.
    pub before: IntervalBound,
    /// What blocks at the end.
    pub after: IntervalBound,
}

impl Interval {
    /// Its length, seconds.
    pub fn secs(&self) -> i64 {
        (self.end - self.start).num_seconds()
    }
}

/// The intervals of several probes on several days.
#[derive(Clone, Debug)]
pub struct Sunlight {
    /// Whether directions include atmospheric refraction.
    pub refraction: bool,
    /// The days in their order.
    pub days: Vec<SunDay>,
    /// The probes in their order.
    pub probes: Vec<ProbeIntervals>,
    /// The names of the components that cast.
    pub components: Vec<String>,
}

/// One day, with what all probes share.
#[derive(Clone, Debug)]
pub struct SunDay {
    /// The date, and the requested part of it.
    pub window: DayWindow,
    /// When the sun is above the horizon within the window.
    pub up: Vec<Interval>,
}

/// One probe's intervals.
#[derive(Clone, Debug)]
pub struct ProbeIntervals {
    /// The probe.
    pub probe: Probe,
    /// How far it lies below the ground (terrain or plane) as judged, metres; `None` if it does not.
    pub below_ground_m: Option<f64>,
    /// The intervals of each day, in time's order. Where the sun shines across midnight, each of the two days has an
    /// interval.
    pub days: Vec<Vec<Interval>>,
}

impl Sunlight {
    /// What blocks, as a word or as the component's name. A component whose name is one of the words gets a distinct
    /// name.
    pub fn name(&self, blocked: IntervalBound) -> String {
        match blocked {
            IntervalBound::Window => "window".to_owned(),
            IntervalBound::Horizon => "horizon".to_owned(),
            IntervalBound::Behind => "behind".to_owned(),
            IntervalBound::Ground => "ground".to_owned(),
            IntervalBound::Component(component) => match self.components.get(component).map_or("", String::as_str) {
                word @ ("window" | "horizon" | "behind" | "ground") => format!("{word} (component)"),
                name => name.to_owned(),
            },
        }
    }

    /// The dates with the least and with the most sun for a probe, each the first of equals, with their seconds.
    pub fn least_and_most(&self, probed: &ProbeIntervals) -> Option<[(NaiveDate, i64); 2]> {
        let days = || self.days.iter().zip(&probed.days).map(|(day, found)| (day.window.day.date, secs(found)));
        let least = days().min_by_key(|(_, secs)| *secs)?;
        let most = days().min_by_key(|(_, secs)| -*secs)?;
        Some([least, most])
    }
}

/// Where a probe is judged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JudgedPoint {
    /// Metres in the world frame.
    pub point: DVec3,
    /// The plane in which it lies, as of the probe.
    pub normal: Option<DVec3>,
    /// How far it lies below the ground, metres; none where it does not.
    pub below_ground_m: Option<f64>,
}

/// Where a probe is judged: with a normal a millimetre before its plane.
pub fn judged(probe: &Probe) -> DVec3 {
    probe.point + probe.normal.unwrap_or(DVec3::ZERO) * JUDGED_ABOVE_M
}

impl ProbeIntervals {
    /// The time in the sun on all days, seconds.
    pub fn secs(&self) -> i64 {
        self.days.iter().map(|day| secs(day)).sum()
    }

    /// The longest interval of all days, the first of equals.
    pub fn longest(&self) -> Option<&Interval> {
        longest(self.days.iter().flatten())
    }
}

/// The total length of intervals, seconds.
pub fn secs(intervals: &[Interval]) -> i64 {
    intervals.iter().map(Interval::secs).sum()
}

/// The longest interval, the first of equals.
pub fn longest<'a>(intervals: impl IntoIterator<Item = &'a Interval>) -> Option<&'a Interval> {
    intervals.into_iter().min_by_key(|interval| -interval.secs())
}
