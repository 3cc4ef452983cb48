//! Spells, and the ways to count them.

use super::{hours, minutes};
use gnomon::rules::{AreaUnit, Bridge, CountHow, CountedTime, Counting, Spell, common, merged, total_secs, without};

fn spell(start: i64, end: i64) -> Spell {
    Spell::new(start, end)
}

const PLAIN: Counting = Counting {
    what: CountedTime::Sun,
    how: CountHow::Total,
    shortest_secs: 0,
    bridge: None,
    step_secs: 0,
    unit: AreaUnit::SquareMetres,
};

#[test]
fn spells_are_merged_cut_and_taken_off() {
    let messy = [spell(10, 20), spell(0, 5), spell(20, 30), spell(4, 6), spell(50, 50), spell(60, 40)];
    assert_eq!(merged(messy), [spell(0, 6), spell(10, 30)]);
    assert_eq!(common(&messy, &[spell(3, 12), spell(29, 99)]), [spell(3, 6), spell(10, 12), spell(29, 30)]);
    assert_eq!(without(&[spell(0, 100)], &messy), [spell(6, 10), spell(30, 100)]);
    assert_eq!(
        without(&[spell(0, 10), spell(15, 40)], &[spell(5, 20), spell(30, 35)]),
        [spell(0, 5), spell(20, 30), spell(35, 40)]
    );
    assert_eq!(without(&messy, &[]), merged(messy));
    assert!(common(&messy, &[]).is_empty() && without(&messy, &[spell(-5, 60)]).is_empty());
}

/// Tests the sets second by second.
#[test]
fn sets_agree_with_single_seconds() {
    let mut seed = 7_u64;
    let mut random = |most: u64| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((seed >> 33) % most) as i64
    };
    for _ in 0..300 {
        let mut list = || -> Vec<Spell> {
            let count = random(5);
            (0..count)
                .map(|_| {
                    let start = random(60);
                    spell(start, start + random(20))
                })
                .collect()
        };
        let (one, other) = (list(), list());
        let holds = |spells: &[Spell], time: i64| spells.iter().any(|of| of.start <= time && time < of.end);
        for time in 0..80 {
            let (a, b) = (holds(&one, time), holds(&other, time));
            assert_eq!(holds(&common(&one, &other), time), a && b, "{one:?} {other:?} {time}");
            assert_eq!(holds(&without(&one, &other), time), a && !b, "{one:?} {other:?} {time}");
            assert_eq!(holds(&merged(one.clone()), time), a);
        }
    }
}

#[test]
fn total_longest_and_two_longest() {
    let spells = [spell(0, 100), spell(200, 250), spell(300, 370)];
    let window = [spell(0, 360)];
    let secs = |how| PLAIN.tally(how, &spells, &window).secs;
    assert_eq!([CountHow::Total, CountHow::Longest, CountHow::TwoLongest].map(secs), [210, 100, 160]);
    assert_eq!(PLAIN.tally(CountHow::Total, &spells, &window).longest_secs, 100);
    assert_eq!(PLAIN.tally(CountHow::Total, &spells, &[]).secs, 0);
    assert_eq!(PLAIN.tally(CountHow::TwoLongest, &spells[..1], &window).secs, 100);
}

#[test]
fn short_spells_do_not_count_from_the_limit_down() {
    let counting = Counting { shortest_secs: minutes(5), ..PLAIN };
    let window = [spell(0, hours(5))];
    let secs = |lengths: [i64; 2]| {
        let spells = [spell(0, lengths[0]), spell(hours(1), hours(1) + lengths[1])];
        counting.tally(CountHow::Total, &spells, &window).secs
    };
    assert_eq!(secs([minutes(5), minutes(5) - 1]), minutes(5));
    // the window cuts a spell before it is measured
    let cut = [spell(hours(5) - minutes(4), hours(6))];
    assert_eq!(counting.tally(CountHow::Total, &cut, &window).secs, 0);
}

#[test]
fn gaps_up_to_the_bridge_do_not_break_a_spell() {
    let with = |gap_secs, counts| Counting { bridge: Some(Bridge { gap_secs, counts }), ..PLAIN };
    let window = [spell(0, 1000)];
    let spells = [spell(0, 100), spell(110, 200), spell(211, 300)];
    let longest = |counting: Counting| counting.tally(CountHow::Longest, &spells, &window).secs;
    assert_eq!(longest(with(9, false)), 100);
    assert_eq!(longest(with(10, false)), 190);
    assert_eq!(longest(with(10, true)), 200);
    assert_eq!(longest(with(11, false)), 279);
    assert_eq!(longest(with(11, true)), 300);
    // what is short is judged when gaps are bridged
    let both = Counting { shortest_secs: 250, ..with(11, false) };
    assert_eq!(both.tally(CountHow::Total, &spells, &window).secs, 279);
}

#[test]
fn test_times_count_a_step_each() {
    let counting = Counting { how: CountHow::Instants, step_secs: hours(1), ..PLAIN };
    let window = [spell(hours(9), hours(15))];
    let lit = |spells: &[Spell]| counting.tally(CountHow::Instants, spells, &window).secs / hours(1);
    assert_eq!(lit(&window), 7);
    assert_eq!(lit(&[spell(hours(9), hours(9) + 1)]), 1);
    assert_eq!(lit(&[spell(hours(9) + 1, hours(10))]), 0);
    assert_eq!(lit(&[spell(hours(14) + 1, hours(20))]), 1);
    assert_eq!(lit(&[]), 0);
    assert_eq!(total_secs(&window), hours(6));
}
