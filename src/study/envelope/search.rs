//! The search for an envelope, step by step.

use super::super::{Event, OnEvent, StudyError, tell};
use super::alone::{choose, of_days, roomiest_places};
use super::kept::{DaysNeeded, KeptOf, KeptPlace, KeptSun, KeptThing};
use super::suns::{SunsOfDay, time};
use super::together::{KeptDay, KeptDays, choose_together};
use crate::rules::total_secs;
use crate::sun::Sky;
use crate::sunlight::Headroom;
use rayon::prelude::*;

/// The heights that are left, and the sun for which they are left.
#[derive(Clone, Debug)]
pub struct EnvelopeOutcome {
    /// The heights over the plot.
    pub headroom: Headroom,
    /// Each thing, in the order of the request.
    pub kept: Vec<KeptOf>,
    /// Whether the hours were chosen together, since that leaves more than if each place chooses by itself.
    pub is_together: bool,
    /// What no choice of hours exceeds, cubic metres; `None` if there is no choice.
    pub most_m3: Option<f64>,
}

/// Between which z heights count.
#[derive(Clone, Copy, Debug)]
pub struct CountedHeights {
    /// The ground.
    pub ground: f64,
    /// Nothing is built above this.
    pub most: f64,
}

/// The most rays whose heights are computed; more would take hours.
pub const MOST_RAYS: i64 = 2_000_000_000;

/// A request, as the steps share it.
struct EnvelopeSearch<'a> {
    sky: &'a Sky<'a>,
    things: &'a [KeptThing],
    /// The number of days.
    count: usize,
}

/// Computes how high may be built.
///
/// # Errors
/// [`StudyError`].
pub fn envelope(
    sky: &Sky<'_>,
    (plot, heights): (Headroom, CountedHeights),
    (things, days): (&[KeptThing], DaysNeeded),
    on_event: &mut OnEvent<'_>,
) -> Result<EnvelopeOutcome, StudyError> {
    let places: Vec<&KeptPlace> = things.iter().flat_map(|thing| &thing.places).collect();
    let count = places.iter().map(|place| place.days.len()).max().unwrap_or(0);
    check_rays(&places)?;
    let search = EnvelopeSearch { sky, things, count };
    tell(on_event, Event::Started { instants: 2 * count, tiles: 1 })?;
    let kept = search.kept_alone(&plot, (&places, days), on_event)?;
    let all: Vec<KeptDay> = {
        let KeptDays { fixed, free } = KeptDays::of(things, &kept, days);
        [fixed, free].concat()
    };
    let headroom = search.left(&plot, (&kept, &all), |day, on_event| search.drawn(count + day, on_event), on_event)?;
    let alone = EnvelopeOutcome { headroom, kept, is_together: false, most_m3: None };
    search.with_bound(plot, (alone, days, heights), on_event)
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

impl EnvelopeSearch<'_> {
    fn drawn(&self, index: usize, on_event: &mut OnEvent<'_>) -> Result<(), StudyError> {
        let first = self.places().find_map(start_of).unwrap_or(0);
        let time = time(self.sky, first);
        tell(on_event, Event::Drawn { index, count: 2 * self.count, time, mask: None, bits: None })
    }

    fn places(&self) -> impl Iterator<Item = &KeptPlace> + Clone {
        self.things.iter().flat_map(|thing| &thing.places)
    }

    /// What each place keeps by itself.
    fn kept_alone(
        &self,
        plot: &Headroom,
        (places, days): (&[&KeptPlace], DaysNeeded),
        on_event: &mut OnEvent<'_>,
    ) -> Result<Vec<KeptOf>, StudyError> {
        let mut chosen: Vec<Vec<Option<KeptSun>>> = vec![Vec::with_capacity(self.count); places.len()];
        for day in 0..self.count {
            let suns = SunsOfDay::of(self.sky, self.places(), day)?;
            let found: Vec<Option<KeptSun>> = places.par_iter().map(|place| choose(plot, place, day, &suns)).collect();
            chosen.iter_mut().zip(found).for_each(|(all, found)| all.push(found));
            self.drawn(day, on_event)?;
        }
        let mut chosen = chosen.into_iter().map(|of| of_days(of, days));
        let of = |thing: &KeptThing| {
            let places: Vec<_> = chosen.by_ref().take(thing.places.len()).collect();
            KeptOf { name: thing.name.clone(), places: roomiest_places(thing, places) }
        };
        Ok(self.things.iter().map(of).collect())
    }

    /// The heights that some days of places leave.
    fn left(
        &self,
        plot: &Headroom,
        (kept, which): (&[KeptOf], &[KeptDay]),
        mut after: impl FnMut(usize, &mut OnEvent<'_>) -> Result<(), StudyError>,
        on_event: &mut OnEvent<'_>,
    ) -> Result<Headroom, StudyError> {
        let mut left = plot.clone();
        for day in 0..self.count {
            let on_day: Vec<(&KeptPlace, &KeptSun)> =
                which.iter().map(|one| one.of(self.things, kept)).filter(|(_, sun)| sun.day == day).collect();
            if !on_day.is_empty() {
                let suns = SunsOfDay::of(self.sky, on_day.iter().map(|(place, _)| *place), day)?;
                let slopes = suns.slopes();
                let lowered = |mut left: Headroom, (place, sun): &(&KeptPlace, &KeptSun)| {
                    place.starts().for_each(|from| left.keep(from, &sun.seconds(), &slopes));
                    left
                };
                let none = || plot.clone();
                let of_day = on_day.par_iter().fold(none, lowered).reduce(none, |one, other| one.and(&other));
                left = left.and(&of_day);
            }
            after(day, on_event)?;
        }
        Ok(left)
    }

    /// Lets the places choose together if they can share what they keep, and adds what no choice exceeds.
    fn with_bound(
        &self,
        plot: Headroom,
        (alone, days, heights): (EnvelopeOutcome, DaysNeeded, CountedHeights),
        on_event: &mut OnEvent<'_>,
    ) -> Result<EnvelopeOutcome, StudyError> {
        let volume_m3 = |left: &Headroom| left.volume_m3(heights.ground, heights.most);
        let of = KeptDays::of(self.things, &alone.kept, days);
        if of.free.is_empty() {
            return Ok(alone);
        }
        let poll = |_, on_event: &mut OnEvent<'_>| tell(on_event, Event::Stage("choosing hours"));
        let certain: Vec<KeptDay> = of.certain().copied().collect();
        let most_m3 = Some(volume_m3(&self.left(&plot, (&alone.kept, &certain), poll, on_event)?));
        if !of.can_share() {
            return Ok(EnvelopeOutcome { most_m3, ..alone });
        }
        let mut kept = alone.kept.clone();
        let mut left = self.left(&plot, (&kept, &of.fixed), poll, on_event)?;
        for day in 0..self.count {
            let is_of_day = |one: &&KeptDay| one.of(self.things, &kept).1.day == day;
            let on_day: Vec<KeptDay> = of.free.iter().filter(is_of_day).copied().collect();
            if !on_day.is_empty() {
                let places = on_day.iter().map(|one| one.of(self.things, &alone.kept).0);
                let suns = SunsOfDay::of(self.sky, places, day)?;
                left =
                    choose_together(left, (self.things, &mut kept), (&on_day, day, &suns), (heights.most, of.stride()));
            }
            poll(day, on_event)?;
        }
        match volume_m3(&left) > volume_m3(&alone.headroom) {
            true => Ok(EnvelopeOutcome { headroom: left, kept, is_together: true, most_m3 }),
            false => Ok(EnvelopeOutcome { most_m3, ..alone }),
        }
    }
}
