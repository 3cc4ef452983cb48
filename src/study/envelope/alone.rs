//! What a place keeps by itself: of its days, and of a thing's places, those that leave the most room, too.

use super::kept::{DaysNeeded, KeptPlace, KeptSun, KeptThing, SunNeeded};
use super::suns::SunsOfDay;
use crate::rules::{Spell, total_secs};
use crate::sunlight::{Headroom, KeptSeconds, PlotSight, RayHeight, roomiest, spells};

/// The seconds of a day that a place keeps; `None` if it must keep none.
pub(super) fn choose(plot: &Headroom, place: &KeptPlace, day: usize, suns: &SunsOfDay) -> Option<KeptSun> {
    let needed = place.days.get(day).filter(|needed| needed.secs > 0)?;
    let sights: Vec<PlotSight> = place.starts().map(|from| plot.sight(from)).collect();
    let is_clear = |secs: &i64| sights.iter().all(|sight| !sight.may_meet(suns.at(*secs)));
    if !needed.at_once {
        // most places have enough sun beside the plot
        let clear: Vec<i64> = seconds(needed).filter(is_clear).take(needed.secs as usize).collect();
        if clear.len() == needed.secs as usize {
            let kept = KeptSeconds { spells: spells(&clear), lowest: f64::INFINITY };
            return Some(kept_sun(day, kept, false));
        }
    }
    let height = |secs: i64| -> RayHeight {
        if is_clear(&secs) {
            return (secs, f64::INFINITY);
        }
        let lowest = place.starts().map(|from| plot.lowest(from, suns.at(secs)));
        (secs, lowest.fold(f64::INFINITY, f64::min))
    };
    let rays: Vec<RayHeight> = seconds(needed).map(height).collect();
    let found = roomiest(&rays, needed.secs as usize, needed.at_once);
    let lacks = found.is_none();
    let all = || KeptSeconds {
        spells: needed.lit.iter().map(|spell| [spell.start, spell.end]).collect(),
        lowest: rays.iter().map(|(_, height)| *height).fold(f64::INFINITY, f64::min),
    };
    Some(kept_sun(day, found.unwrap_or_else(all), lacks))
}

pub(super) fn seconds(needed: &SunNeeded) -> impl Iterator<Item = i64> {
    needed.lit.iter().flat_map(|spell| spell.start..spell.end)
}

pub(super) fn kept_sun(day: usize, KeptSeconds { spells, lowest }: KeptSeconds, lacks: bool) -> KeptSun {
    let spells = spells.into_iter().map(|[start, end]| Spell::new(start, end)).collect();
    KeptSun { day, spells, lowest, lacks }
}

/// The days of a place that count: all, or the one that leaves the most room among those with enough sun.
pub(super) fn of_days(chosen: Vec<Option<KeptSun>>, days: DaysNeeded) -> Vec<KeptSun> {
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
pub(super) fn roomiest_places(thing: &KeptThing, places: Vec<Vec<KeptSun>>) -> Vec<(usize, Vec<KeptSun>)> {
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
