//! What several places keep: one after the other takes the seconds that lower what the ones before it left the least.
//!
//! Which seconds leave the most room together is a problem of covering, for which no fast exact method is known. This
//! one is greedy: first the places that have no choice, then the others, those with the least to spare first. Its result
//! counts only if more may be built than where each place chooses by itself, so it never leaves less. What the places
//! without a choice leave bounds every choice from above.

use super::alone::{kept_sun, seconds};
use super::kept::{DaysNeeded, KeptOf, KeptPlace, KeptSun, KeptThing, SunNeeded};
use super::suns::SunsOfDay;
use crate::rules::total_secs;
use crate::sunlight::{Headroom, RayHeight, roomiest};
use rayon::prelude::*;

/// The most days of places that choose together; more would take minutes.
const MOST_TOGETHER: usize = 5000;
/// About so many rays are compared with the heights: if there are more, one of several seconds each time.
const MOST_COMPARED: i64 = 4_000_000;

/// A place and a day of it whose sun is kept.
#[derive(Clone, Copy)]
pub(super) struct KeptDay {
    /// The indices of the thing, of its place among those that are kept, and of the day among its days.
    at: [usize; 3],
    /// The seconds that it may leave out.
    spare: i64,
    rays: i64,
    /// Whether every choice keeps all of it.
    is_fixed: bool,
}

/// The days of places on which rays pass over the plot: those without a choice, and the others in the order in which
/// they choose.
pub(super) struct KeptDays {
    pub(super) fixed: Vec<KeptDay>,
    pub(super) free: Vec<KeptDay>,
}

impl KeptDay {
    pub(super) fn of<'a>(&self, things: &'a [KeptThing], kept: &'a [KeptOf]) -> (&'a KeptPlace, &'a KeptSun) {
        let [thing, place, day] = self.at;
        let (number, days) = &kept[thing].places[place];
        (&things[thing].places[*number], &days[day])
    }
}

impl KeptDays {
    pub(super) fn of(things: &[KeptThing], kept: &[KeptOf], needed: DaysNeeded) -> KeptDays {
        let mut days = KeptDays { fixed: Vec::new(), free: Vec::new() };
        for (thing, of) in kept.iter().enumerate() {
            let has_all = of.places.len() == things[thing].places.len() && needed == DaysNeeded::Each;
            for (place, (number, of_days)) in of.places.iter().enumerate() {
                for (day, sun) in of_days.iter().enumerate().filter(|(_, sun)| sun.lowest.is_finite()) {
                    let from = &things[thing].places[*number];
                    let lit = total_secs(&from.days[sun.day].lit);
                    let spare = lit - total_secs(&sun.spells);
                    let rays = lit.saturating_mul(from.points.len() as i64);
                    let one = KeptDay { at: [thing, place, day], spare, rays, is_fixed: has_all && spare == 0 };
                    if spare == 0 { days.fixed.push(one) } else { days.free.push(one) }
                }
            }
        }
        days.free.sort_by_key(|one| one.spare);
        days
    }

    /// Whether places can share what they keep, and are few enough.
    pub(super) fn can_share(&self) -> bool {
        !self.free.is_empty() && self.fixed.len() + self.free.len() > 1 && self.free.len() <= MOST_TOGETHER
    }

    /// The number of seconds of which one is compared.
    pub(super) fn stride(&self) -> usize {
        let rays = self.free.iter().map(|one| one.rays).fold(0i64, i64::saturating_add);
        rays.div_euclid(MOST_COMPARED) as usize + 1
    }

    /// Those whose sun every choice keeps, as far as that is certain.
    pub(super) fn certain(&self) -> impl Iterator<Item = &KeptDay> {
        self.fixed.iter().filter(|one| one.is_fixed)
    }
}

/// Lets the places of one day choose, in their order, below the heights that are left so far.
pub(super) fn choose_together(
    mut left: Headroom,
    (things, kept): (&[KeptThing], &mut [KeptOf]),
    (free, day, suns): (&[KeptDay], usize, &SunsOfDay),
    (most, stride): (f64, usize),
) -> Headroom {
    let slopes = suns.slopes();
    for one in free {
        let (place, sun) = one.of(things, kept);
        if sun.day != day {
            continue;
        }
        let better = choose_below(&left, (place, sun), suns, (most, stride));
        place.starts().for_each(|from| left.keep(from, &better.seconds(), &slopes));
        let [thing, place, of_day] = one.at;
        kept[thing].places[place].1[of_day] = better;
    }
    left
}

/// The seconds that a place keeps below some heights: those of which each lowers them the least; of equal ones the first.
fn choose_below(
    left: &Headroom,
    (place, sun): (&KeptPlace, &KeptSun),
    suns: &SunsOfDay,
    (most, stride): (f64, usize),
) -> KeptSun {
    let needed: &SunNeeded = &place.days[sun.day];
    let all: Vec<i64> = seconds(needed).collect();
    let cuts = |some: &[i64]| -> Vec<RayHeight> {
        let middle = suns.at(some[some.len() / 2]);
        let cut: f64 = place.starts().map(|from| left.cut(from, middle, most)).sum();
        some.iter().map(|secs| (*secs, -cut)).collect()
    };
    let cuts: Vec<RayHeight> = all.par_chunks(stride).flat_map_iter(cuts).collect();
    let Some(mut found) = roomiest(&cuts, needed.secs as usize, needed.at_once) else { return sun.clone() };
    let kept = || found.spells.iter().flat_map(|[start, end]| *start..*end);
    let heights = kept().flat_map(|secs| place.starts().map(move |from| left.lowest(from, suns.at(secs))));
    found.lowest = heights.fold(f64::INFINITY, f64::min);
    kept_sun(sun.day, found, false)
}
