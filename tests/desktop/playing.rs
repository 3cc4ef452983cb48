//! Playing the day and the year.

use super::*;
use chrono::{NaiveDate, NaiveTime};

fn date(harness: &Harness<'_, App>) -> NaiveDate {
    value(harness, "Date").parse().expect("a date")
}

fn clock(harness: &Harness<'_, App>) -> NaiveTime {
    NaiveTime::parse_from_str(&value(harness, "Clock"), "%H:%M").expect("a clock time")
}

fn plays(harness: &Harness<'_, App>, name: &str) -> bool {
    harness.get_by_label(name).accesskit_node().toggled() == Some(egui::accesskit::Toggled::True)
}

/// All texts that a part shows while something plays to its end, each once.
fn played<T: PartialEq>(harness: &mut Harness<'_, App>, name: &str, says: impl Fn(&Harness<'_, App>) -> T) -> Vec<T> {
    let mut said = Vec::new();
    for _ in 0..800 {
        let now = says(harness);
        if said.last() != Some(&now) {
            said.push(now);
        }
        if !plays(harness, name) {
            return said;
        }
        harness.step();
    }
    panic!("{name}: no end")
}

#[test]
fn day_plays_round_to_where_it_began() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    harness.key_press(Key::Space);
    harness.step();
    harness.step();
    assert!(plays(&harness, "Play the day"));
    let times = played(&mut harness, "Play the day", clock);
    assert!(times.len() > 20, "{times:?}");
    assert_eq!(times.windows(2).filter(|pair| pair[1] < pair[0]).count(), 1, "once past midnight: {times:?}");
    assert_eq!(clock(&harness), NaiveTime::from_hms_opt(13, 0, 0).unwrap());
    assert_eq!(date(&harness), NaiveDate::from_ymd_opt(2026, 3, 21).unwrap());
    // a second press stops it
    click(&mut harness, "Play the day");
    assert!(plays(&harness, "Play the day"));
    harness.key_press(Key::Space);
    harness.step();
    harness.step();
    assert!(!plays(&harness, "Play the day"));
    let stopped = clock(&harness);
    harness.run_steps(3);
    assert_eq!(clock(&harness), stopped);
}

/// On 29 March clocks in Vienna skip the hour from two to three; the days after it have it.
#[test]
fn year_plays_at_one_hour() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    write(&mut harness, "Clock", "2:30");
    settle(&mut harness);
    click(&mut harness, "Play the year at this hour");
    let said = played(&mut harness, "Play the year at this hour", |harness| (date(harness), clock(harness)));
    assert!(said.len() > 60, "{} days", said.len());
    let spring = NaiveDate::from_ymd_opt(2026, 3, 29).unwrap();
    for (date, clock) in said {
        let hour = if date == spring { 3 } else { 2 };
        assert_eq!(clock, NaiveTime::from_hms_opt(hour, 30, 0).unwrap(), "{date}");
    }
    assert_eq!(date(&harness), NaiveDate::from_ymd_opt(2026, 3, 21).unwrap());
    // the day that skips the hour, by a key a day at a time: the day after has it again
    for (day, said) in [(28, "02:30"), (29, "03:30"), (30, "02:30")] {
        while date(&harness) < NaiveDate::from_ymd_opt(2026, 3, day).unwrap() {
            harness.key_press(Key::ArrowUp);
            harness.step();
            harness.step();
        }
        assert_eq!(value(&harness, "Clock"), said, "{day} March");
    }
}
