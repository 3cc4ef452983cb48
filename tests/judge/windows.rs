//! Windows and façades behind an endless wall.

use super::{beijing, endless_wall, judged, london, nothing, over_wall, secs, site, value_secs, window};
use glam::{DVec3, dvec3};
use gnomon::judgement::{JudgedThing, SpellBound};
use gnomon::rules::Verdict;
use gnomon::site::{JudgedFacade, JudgedSite};

const CHINA: &str = "cn-gb-50180-dwelling";

/// A window that looks south at a wall so many times as far away as it is high above the sill.
fn before_wall(ratio: f64) -> JudgedSite {
    let mut asked = site(beijing(), vec![endless_wall("block", -10.0 * ratio, 11.0)], None);
    let mut own = window("south", dvec3(0.0, 0.0, 1.0), DVec3::NEG_Y);
    (own.floor, own.room, own.dwelling) = (Some(0.1), Some("living".into()), Some("1".into()));
    asked.windows = vec![own];
    asked
}

fn china(hours: &str) -> [(&str, &str); 2] {
    [("day", "great-cold"), ("hours", hours)]
}

/// Great Cold in Beijing: at 1.8 heights 2.511 h, at 2.0 4.435 h, at 1.7 and less nothing (a closed form with a declination of
/// −20.01°).
#[test]
fn great_cold_before_an_endless_wall() {
    for (ratio, hours) in [(1.8, 2.511), (2.0, 4.435), (1.7, 0.0)] {
        let asked = before_wall(ratio);
        let found = judged(&asked, CHINA, &china("2h"));
        let value = value_secs(&found.receivers[0]);
        assert!((value as f64 / 3600.0 - hours).abs() < 0.15, "{ratio}: {value}");
        // of the sill's ends the higher millimetre is judged, and a millimetre before the wall
        let expected =
            secs(&asked.place, &found.days[0], |sun| sun.y < 0.0 && over_wall(sun, 10.0 * ratio - 0.001, 9.999));
        assert!((value - expected).abs() <= 2, "{ratio}: {value} {expected}");
    }
}

#[test]
fn two_hours_pass_and_three_fail() {
    let verdict = |ratio: f64, hours: &str| judged(&before_wall(ratio), CHINA, &china(hours)).verdict;
    assert_eq!([verdict(1.8, "2h"), verdict(1.8, "3h")], [Verdict::Pass, Verdict::Fail]);
    assert_eq!([verdict(1.7, "1h"), verdict(2.0, "3h")], [Verdict::Fail, Verdict::Pass]);
}

#[test]
fn spells_say_what_bounds_them() {
    let asked = before_wall(1.8);
    let found = judged(&asked, CHINA, &china("3h"));
    let [receiver] = found.receivers.as_slice() else { panic!("one window") };
    assert_eq!((receiver.kind, receiver.points.len()), (JudgedThing::Window, 2));
    let [told] = receiver.spells.as_slice() else { panic!("one day") };
    // around noon alone the sun stands high enough
    let [spell] = told.now.as_slice() else { panic!("{told:?}") };
    let block = SpellBound::Component(0);
    assert_eq!([spell.before, spell.after], [block, block]);
    assert_eq!(spell.spell.secs(), value_secs(receiver));
    assert_eq!(told.before, None);
    // the wall takes all the rest of the window
    let [taker] = receiver.takers.as_slice() else { panic!("{:?}", receiver.takers) };
    let open = gnomon::rules::total_secs(&told.open);
    assert_eq!((taker.component, taker.with_others_secs), (0, 0.0));
    assert!((taker.alone_secs - (open - value_secs(receiver)) as f64).abs() <= 1.0, "{taker:?} {open}");
    assert_eq!(found.groups.len(), 2, "a room and a dwelling");
}

/// A sweep angle cuts the morning and the evening of a window that looks south by nothing, and of one that looks east.
#[test]
fn grazing_sun_is_cut() {
    let mut asked = before_wall(50.0);
    asked.windows[0].outward = DVec3::X;
    asked.windows[0].corners = window("east", dvec3(0.0, 0.0, 1.0), DVec3::X).corners;
    let options = |sweep: &'static str| [("day", "great-cold"), ("hours", "1h"), ("sweep", sweep)];
    let free = judged(&asked, CHINA, &options("0"));
    let cut = judged(&asked, CHINA, &options("15"));
    let of = |deg: f64| {
        secs(&asked.place, &free.days[0], |sun| {
            let flat = sun.with_z(0.0).normalize();
            flat.x > 0.0 && flat.x.asin().to_degrees() >= deg
        })
    };
    assert!((value_secs(&free.receivers[0]) - of(0.0)).abs() <= 2);
    assert!((value_secs(&cut.receivers[0]) - of(15.0)).abs() <= 2);
    let last = cut.receivers[0].spells[0].now.last().expect("a spell");
    assert_eq!(last.after, SpellBound::Cut);
}

/// All points of a façade must keep the rule, each on its worst day.
#[test]
fn a_facade_is_as_good_as_its_worst_point() {
    let hague = gnomon::sun::Place::new("", 52.08, 4.31, 0.0, Some("Europe/Amsterdam")).expect("a place");
    let mut asked = site(hague, vec![endless_wall("wall", -20.0, 11.0)], None);
    let point = |z: f64| [dvec3(0.0, 0.0, z), DVec3::NEG_Y];
    let facade = |name: &str, heights: &[f64]| JudgedFacade {
        name: name.into(),
        points: heights.iter().map(|z| point(*z)).collect(),
        doubtful: Vec::new(),
    };
    asked.facades = vec![facade("both", &[9.0, 1.0]), facade("upper", &[9.0])];
    let found = judged(&asked, "nl-the-hague", &[]);
    let [both, upper] = found.receivers.as_slice() else { panic!("two façades") };
    assert_eq!([both.ruling.verdict, upper.ruling.verdict], [Verdict::Fail, Verdict::Pass]);
    assert_eq!(both.points, [dvec3(0.0, 0.0, 1.0)]);
    // February is worse than any other month
    let date = both.ruling.deciding.and_then(|at| both.ruling.findings[at].date).expect("a day");
    let at = found.days.iter().position(|day| day.date == date).expect("of the calendar");
    let expected = secs(&asked.place, &found.days[at], |sun| {
        sun.y < 0.0 && sun.z > 10f64.to_radians().sin() && over_wall(sun, 19.999, 10.0)
    });
    assert!((value_secs(both) - expected).abs() <= 2, "{} {expected} on {date}", value_secs(both));
    assert!(found.days.iter().zip(&both.counts).all(|(_, count)| count.now_secs >= both.counts[at].now_secs));
}

/// A state before is told beside the one that is judged, though the rule does not compare.
#[test]
fn before_and_after_are_told() {
    let mut asked = before_wall(1.8);
    asked.before = Some(super::state(vec![nothing()]));
    let found = judged(&asked, CHINA, &china("3h"));
    let count = found.receivers[0].counts[0];
    let open = secs(&asked.place, &found.days[0], |sun| sun.y < 0.0);
    assert!(count.before_secs.is_some_and(|before| (before - open).abs() <= 2), "{count:?} {open}");
    assert_eq!(count.now_secs, value_secs(&found.receivers[0]));
}

/// Numbers that are equal, but not alike: 0 and −0.
#[test]
fn walls_that_differ_by_the_sign_of_a_zero() {
    let mut asked = site(london(), vec![nothing()], None);
    asked.windows = vec![
        window("one", dvec3(0.0, 0.0, 1.0), dvec3(0.0, -1.0, 0.0)),
        window("other", dvec3(9.0, 0.0, 1.0), dvec3(-0.0, -1.0, -0.0)),
    ];
    let found = judged(&asked, "nl-tno-light", &[]);
    let secs: Vec<i64> = found.receivers.iter().map(value_secs).collect();
    assert_eq!(secs[0], secs[1]);
}
