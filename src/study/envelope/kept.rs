//! What must keep its sun, and the sun of it that is kept.

use crate::rules::Spell;
use crate::sunlight::RaySource;
use glam::DVec3;

/// A thing that must keep its sun.
#[derive(Clone, Debug)]
pub struct KeptThing {
    /// Its name.
    pub name: String,
    /// Its places.
    pub places: Vec<KeptPlace>,
    /// The weight of the places that must keep it, out of the sum of all weights.
    pub needed: f64,
}

/// A place whose sun may be kept.
#[derive(Clone, Debug)]
pub struct KeptPlace {
    /// Its weight, the part of the thing that it stands for: 1, or square metres.
    pub weight: f64,
    /// Its points; it is lit while all of them are.
    pub points: Vec<DVec3>,
    /// The radius in plan of the part of an area that it stands for, metres; 0 for points.
    pub around_m: f64,
    /// What it must keep on each day.
    pub days: Vec<SunNeeded>,
}

/// What a place must keep on a day.
#[derive(Clone, Debug, Default)]
pub struct SunNeeded {
    /// The spells in which it has sun that counts.
    pub lit: Vec<Spell>,
    /// The seconds that must stay; 0 on a day without a demand.
    pub secs: i64,
    /// Whether they must be one stretch.
    pub at_once: bool,
}

/// Whether the sun must stay on all days or on one of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DaysNeeded {
    /// On each of them.
    Each,
    /// On one of them: the one that leaves the most room.
    One,
}

/// The sun of a place that is kept on a day.
#[derive(Clone, Debug, PartialEq)]
pub struct KeptSun {
    /// The day's index.
    pub day: usize,
    /// The spells that are kept, seconds since 1970.
    pub spells: Vec<Spell>,
    /// The z of its lowest ray over the plot; infinite if none passes over it.
    pub lowest: f64,
    /// Whether the place has less sun than it must keep; then all of its sun is kept.
    pub lacks: bool,
}

impl KeptPlace {
    /// Where its rays begin.
    pub(super) fn starts(&self) -> impl Iterator<Item = RaySource> + '_ {
        self.points.iter().map(|at| RaySource { at: *at, around_m: self.around_m })
    }
}

impl KeptSun {
    /// The spells as pairs: the first second, and the one after the last.
    pub(super) fn seconds(&self) -> Vec<[i64; 2]> {
        self.spells.iter().map(|spell| [spell.start, spell.end]).collect()
    }
}

/// The sun of a thing that is kept.
#[derive(Clone, Debug)]
pub struct KeptOf {
    /// Its name.
    pub name: String,
    /// For each place that is kept, its index and its sun on the days that count.
    pub places: Vec<(usize, Vec<KeptSun>)>,
}

impl KeptOf {
    /// The z of the lowest ray over the plot.
    pub fn lowest(&self) -> f64 {
        self.places.iter().flat_map(|(_, kept)| kept).map(|kept| kept.lowest).fold(f64::INFINITY, f64::min)
    }

    /// Whether one of its places has less sun than it must keep.
    pub fn lacks(&self) -> bool {
        self.places.iter().flat_map(|(_, kept)| kept).any(|kept| kept.lacks)
    }
}
