//! How high may be built: over each cell of a plot, the least height of the rays to the suns that must stay.
//!
//! Each place keeps as much sun as it must: those seconds whose rays pass highest over the plot, so that the least
//! height that the place leaves is as great as it can be. Places choose independently of each other.

use super::{Event, OnEvent, StudyError, tell};
use crate::rules::{Spell, total_secs};
use crate::sun::{Sky, SunError, Zone};
use crate::sunlight::{Headroom, KeptSeconds, RayHeight, roomiest};
use chrono::{DateTime, TimeZone};
use glam::DVec3;
use rayon::prelude::*;

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

/// The heights that are left, and the sun for which they are left.
#[derive(Clone, Debug)]
pub struct EnvelopeOutcome {
    /// The heights over the plot.
    pub headroom: Headroom,
    /// Each thing, in the order of the request.
    pub kept: Vec<KeptOf>,
}

/// The most rays whose heights are computed; more would take hours.
pub const MOST_RAYS: i64 = 400_000_000;

/// Computes how high may be built.
///
/// # Errors
/// [`StudyError`].
pub fn envelope(
    sky: &Sky<'_>,
    plot: Headroom,
    (things, days): (&[KeptThing], DaysNeeded),
    on_event: &mut OnEvent<'_>,
) -> Result<EnvelopeOutcome, StudyError> {
    let places: Vec<&KeptPlace> = things.iter().flat_map(|thing| &thing.places).collect();
    let count = places.iter().map(|place| place.days.len()).max().unwrap_or(0);
    check_rays(&places)?;
    tell(on_event, Event::Started { instants: 2 * count, tiles: 1 })?;
    let first = time(sky, places.iter().find_map(|place| start_of(place)).unwrap_or(0));
    let mut chosen: Vec<Vec<Option<KeptSun>>> = vec![Vec::with_capacity(count); places.len()];
    for day in 0..count {
        let suns = SunsOfDay::of(sky, &places, day)?;
        let found: Vec<Option<KeptSun>> = places.par_iter().map(|place| choose(&plot, place, day, &suns)).collect();
        chosen.iter_mut().zip(found).for_each(|(all, found)| all.push(found));
        tell(on_event, Event::Drawn { index: day, count: 2 * count, time: first, mask: None, bits: None })?;
    }
    let mut chosen = chosen.into_iter().map(|of| of_days(of, days));
    let kept: Vec<KeptOf> = things
        .iter()
        .map(|thing| {
            let places: Vec<_> = chosen.by_ref().take(thing.places.len()).collect();
            KeptOf { name: thing.name.clone(), places: roomiest_places(thing, places) }
        })
        .collect();
    let mut headroom = plot;
    for day in 0..count {
        let suns = SunsOfDay::of(sky, &places, day)?;
        headroom = keep(headroom, things, &kept, (day, &suns));
        tell(on_event, Event::Drawn { index: count + day, count: 2 * count, time: first, mask: None, bits: None })?;
    }
    Ok(EnvelopeOutcome { headroom, kept })
}

fn check_rays(places: &[&KeptPlace]) -> Result<(), StudyError> {
    let of = |place: &&KeptPlace| {
        let secs = place.days.iter().map(|day| total_secs(&day.lit)).sum::<i64>();
        secs.saturating_mul(place.points.len() as i64)
    };
    let rays = places.iter().map(of).fold(0i64, i64::saturating_add);
    if rays > MOST_RAYS { Err(StudyError::TooManyRays { rays, most: MOST_RAYS }) } else { Ok(()) }
}

fn start_of(place: &KeptPlace) -> Option<i64> {
    place.days.iter().flat_map(|day| &day.lit).map(|spell| spell.start).min()
}

fn time(sky: &Sky<'_>, secs: i64) -> DateTime<Zone> {
    // a day's windows are within the years that chrono supports
    let utc = DateTime::from_timestamp(secs, 0).unwrap_or_default().naive_utc();
    sky.place.time_zone.from_utc_datetime(&utc)
}

/// The exact direction to the sun at each second of a day at which some place is lit.
struct SunsOfDay {
    first: i64,
    to_sun: Vec<DVec3>,
}

impl SunsOfDay {
    fn of(sky: &Sky<'_>, places: &[&KeptPlace], day: usize) -> Result<SunsOfDay, SunError> {
        let asked = || places.iter().filter_map(|place| place.days.get(day)).filter(|asked| asked.secs > 0);
        let spells = || asked().flat_map(|asked| &asked.lit);
        let first = spells().map(|spell| spell.start).min().unwrap_or(0);
        let end = spells().map(|spell| spell.end).max().unwrap_or(first);
        let to_sun = (first..end).into_par_iter().map(|secs| Ok(sky.at(time(sky, secs))?.to_sun));
        Ok(SunsOfDay { first, to_sun: to_sun.collect::<Result<_, SunError>>()? })
    }

    fn at(&self, secs: i64) -> DVec3 {
        self.to_sun[(secs - self.first) as usize]
    }
}

/// The seconds of a day that a place keeps; `None` if it must keep none.
fn choose(plot: &Headroom, place: &KeptPlace, day: usize, suns: &SunsOfDay) -> Option<KeptSun> {
    let needed = place.days.get(day).filter(|needed| needed.secs > 0)?;
    let height = |secs: i64| -> RayHeight {
        let lowest = place.points.iter().map(|point| plot.lowest(*point, suns.at(secs)));
        (secs, lowest.fold(f64::INFINITY, f64::min))
    };
    let rays: Vec<RayHeight> = needed.lit.iter().flat_map(|spell| spell.start..spell.end).map(height).collect();
    let found = roomiest(&rays, needed.secs as usize, needed.at_once);
    let lacks = found.is_none();
    let KeptSeconds { spells, lowest } = found.unwrap_or_else(|| KeptSeconds {
        spells: needed.lit.iter().map(|spell| [spell.start, spell.end]).collect(),
        lowest: rays.iter().map(|(_, height)| *height).fold(f64::INFINITY, f64::min),
    });
    let spells = spells.into_iter().map(|[start, end]| Spell::new(start, end)).collect();
    Some(KeptSun { day, spells, lowest, lacks })
}

/// The days of a place that count: all, or the one that leaves the most room among those with enough sun.
fn of_days(chosen: Vec<Option<KeptSun>>, days: DaysNeeded) -> Vec<KeptSun> {
    let chosen = chosen.into_iter().flatten();
    match days {
        DaysNeeded::Each => chosen.collect(),
        DaysNeeded::One => {
            let better = |one: &KeptSun, other: &KeptSun| {
                let order = other.lacks.cmp(&one.lacks).then(one.lowest.total_cmp(&other.lowest));
                // if no day has enough sun, the one with the most
                let secs = |kept: &KeptSun| if kept.lacks { total_secs(&kept.spells) } else { 0 };
                order.then(secs(one).cmp(&secs(other))).then(other.day.cmp(&one.day))
            };
            chosen.max_by(better).into_iter().collect()
        }
    }
}

/// Chooses as many of a thing's places as are needed, those that leave the most room first, and those that lack sun
/// last.
fn roomiest_places(thing: &KeptThing, places: Vec<Vec<KeptSun>>) -> Vec<(usize, Vec<KeptSun>)> {
    /// The rounding error of sums of weights, as a share of the whole weight.
    const ROUNDED: f64 = 1e-9;
    let merit = |kept: &[KeptSun]| {
        let lowest = kept.iter().map(|kept| kept.lowest).fold(f64::INFINITY, f64::min);
        (kept.iter().any(|kept| kept.lacks), lowest)
    };
    let mut places: Vec<(usize, Vec<KeptSun>)> = places.into_iter().enumerate().collect();
    places.sort_by(|(_, one), (_, other)| {
        let (one, other) = (merit(one), merit(other));
        one.0.cmp(&other.0).then(other.1.total_cmp(&one.1))
    });
    let mut left = thing.needed - ROUNDED * thing.places.iter().map(|place| place.weight).sum::<f64>();
    places.retain(|(number, _)| {
        let is_needed = left > 0.0;
        left -= thing.places[*number].weight;
        is_needed
    });
    places.sort_by_key(|(number, _)| *number);
    places
}

/// Lowers the heights so that the rays of a day stay free.
fn keep(plot: Headroom, things: &[KeptThing], kept: &[KeptOf], (day, suns): (usize, &SunsOfDay)) -> Headroom {
    let rays = |(thing, kept): (&KeptThing, &KeptOf)| {
        let of = |(number, of_days): &(usize, Vec<KeptSun>)| {
            let spells: Vec<Spell> =
                of_days.iter().filter(|kept| kept.day == day).flat_map(|kept| kept.spells.clone()).collect();
            (thing.places[*number].points.clone(), spells)
        };
        kept.places.iter().map(of).collect::<Vec<_>>()
    };
    let rays: Vec<(Vec<DVec3>, Vec<Spell>)> = things.iter().zip(kept).flat_map(rays).collect();
    let lowered = |mut headroom: Headroom, (points, spells): &(Vec<DVec3>, Vec<Spell>)| {
        for secs in spells.iter().flat_map(|spell| spell.start..spell.end) {
            points.iter().for_each(|point| headroom.keep(*point, suns.at(secs)));
        }
        headroom
    };
    rays.par_iter().fold(|| plot.clone(), lowered).reduce(|| plot.clone(), |one, other| one.and(&other))
}
