//! Places that choose their hours together.

use super::{HEIGHTS, found, place, plot, rays, secs, thing};
use glam::{DVec3, dvec3};
use gnomon::rules::{Spell, total_secs};
use gnomon::study::envelope::{DaysNeeded, EnvelopeOutcome, KeptPlace, KeptThing, SunNeeded};
use gnomon::sunlight::RaySource;

/// A place that has sun in these spells of the day, of which it must keep so much.
fn with(point: DVec3, lit: &[[&str; 2]], secs_needed: i64) -> KeptPlace {
    let at = |clock: &str| secs(&format!("2026-03-21T{clock}:00Z"));
    let lit = lit.iter().map(|[from, to]| Spell::new(at(from), at(to))).collect();
    KeptPlace { days: vec![SunNeeded { lit, secs: secs_needed, at_once: false }], ..place(vec![point], 0, false) }
}

fn volume(outcome: &EnvelopeOutcome) -> f64 {
    outcome.headroom.volume_m3(HEIGHTS.ground, HEIGHTS.most)
}

/// Alone, the second window would take the earlier hour, whose rays pass higher; but the first has no choice and keeps the
/// later one, in which the second costs nothing more.
fn two() -> [KeptThing; 2] {
    let fixed = with(dvec3(14.0, -2.0, 1.0), &[["16:00", "17:00"]], 3600);
    let free = with(dvec3(14.0, -2.0, 1.5), &[["15:00", "16:00"], ["16:01", "17:00"]], 3540);
    [thing(vec![fixed], 1.0), thing(vec![free], 1.0)]
}

#[test]
fn sharing_hours_leaves_more() {
    let things = two();
    let both = found(&things, DaysNeeded::Each);
    assert!(both.is_together);
    let of_free = &both.kept[1].places[0].1[0];
    assert_eq!(total_secs(&of_free.spells), 3540);
    let late = secs("2026-03-21T15:50:00Z");
    assert!(of_free.spells.iter().all(|spell| spell.start > late), "the later hour: {:?}", of_free.spells);
    // by itself it takes the earlier hour, and that leaves less
    let alone = found(&things[1..], DaysNeeded::Each);
    assert!(!alone.is_together);
    let early = secs("2026-03-21T15:00:00Z");
    assert_eq!(alone.kept[0].places[0].1[0].spells, [Spell::new(early, early + 3540)]);
    let first = found(&things[..1], DaysNeeded::Each);
    let apart = first.headroom.clone().and(&alone.headroom).volume_m3(HEIGHTS.ground, HEIGHTS.most);
    assert!(volume(&both) > apart + 1.0, "{} is not more than {apart}", volume(&both));
    // the heights are those of the rays that are kept, and no choice leaves more than the first window does
    let lowest = rays(&things, &both)
        .iter()
        .map(|(from, to_sun)| plot().lowest(RaySource::point(*from), *to_sun))
        .fold(f64::INFINITY, f64::min);
    let least = both.headroom.top.iter().copied().fold(f64::INFINITY, f64::min);
    assert!((lowest - least).abs() < 1e-9, "{lowest} is not {least}");
    assert!((both.most_m3.unwrap() - volume(&first)).abs() < 1e-6 && volume(&both) <= volume(&first));
}

/// The bound is that of what every choice keeps: without a choice there is none, and where all is choice it is the whole plot.
#[test]
fn no_choice_exceeds_the_bound() {
    let [fixed, free] = two();
    assert_eq!(found(&[fixed], DaysNeeded::Each).most_m3, None);
    let alone = found(std::slice::from_ref(&free), DaysNeeded::Each);
    let cells = plot().inside.iter().filter(|inside| **inside).count() as f64;
    assert_eq!(alone.most_m3, Some(60.0 * cells));
    // either hour leaves less than that
    for lit in &free.places[0].days[0].lit {
        let days = vec![SunNeeded { lit: vec![*lit], secs: 3540, at_once: false }];
        let one = found(&[thing(vec![KeptPlace { days, ..free.places[0].clone() }], 1.0)], DaysNeeded::Each);
        assert!(volume(&one) < 60.0 * cells);
    }
}
