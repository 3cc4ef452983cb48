//! Who takes the sun, alone and together.

use super::{beijing, judged, over_wall, secs, site, window};
use crate::shared::dense::cuboid;
use glam::{DVec3, dvec3};
use gnomon::mesh::Part;
use gnomon::rules::Verdict;

fn half_wall(name: &str, [west, east]: [f64; 2], y: f64, z: f64) -> Part {
    cuboid(name, dvec3(west, y - 0.001, 0.0), dvec3(east, y, z))
}

/// A tower before the western half of a low wall: the wall takes more, and both take some of the same.
#[test]
fn what_each_takes_alone_and_with_others() {
    let east = half_wall("east", [0.0, 5000.0], -10.0, 21.0);
    let low = half_wall("west low", [-5000.0, 0.0], -10.0, 21.0);
    let high = half_wall("west high", [-5000.0, 0.0], -20.0, 81.0);
    let mut asked = site(beijing(), vec![low, high, east], None);
    let mut own = window("south", dvec3(0.0, 0.0, 1.0), DVec3::NEG_Y);
    own.corners = own.corners.map(|at| at * dvec3(0.01, 1.0, 1.0));
    (own.floor, own.room, own.dwelling) = (Some(0.1), Some("living".into()), Some("1".into()));
    asked.windows = vec![own];
    let found = judged(&asked, "cn-gb-50180-dwelling", &[("day", "great-cold"), ("hours", "1h")]);
    assert_eq!(found.verdict, Verdict::Fail);
    let takers = &found.receivers[0].takers;
    let of = |component: u32| takers.iter().find(|taker| taker.component == component).expect("a taker");
    let day = &found.days[0];
    let afternoon = |sun: DVec3| sun.y < 0.0 && sun.x < 0.0;
    let is_low = |sun: DVec3| !over_wall(sun, 9.999, 19.999);
    let is_high = |sun: DVec3| !over_wall(sun, 19.999, 79.999);
    let both = secs(&asked.place, day, |sun| afternoon(sun) && is_low(sun) && is_high(sun)) as f64;
    let high_alone = secs(&asked.place, day, |sun| afternoon(sun) && !is_low(sun) && is_high(sun)) as f64;
    let low_alone = secs(&asked.place, day, |sun| afternoon(sun) && is_low(sun) && !is_high(sun)) as f64;
    // the ends of the sill see the walls' ends a centimetre from each other: some seconds at noon
    for (component, alone, with) in [(0, low_alone, both), (1, high_alone, both)] {
        let taker = of(component);
        assert!((taker.alone_secs - alone).abs() <= 20.0, "{component}: {taker:?} {alone}");
        assert!((taker.with_others_secs - with).abs() <= 20.0, "{component}: {taker:?} {with}");
    }
    // in the morning the eastern wall stands alone
    let east = of(2);
    let morning = secs(&asked.place, day, |sun| sun.y < 0.0 && sun.x > 0.0 && is_low(sun)) as f64;
    assert!((east.alone_secs - morning).abs() <= 20.0, "{east:?} {morning}");
    assert!(takers.windows(2).all(|two| two[0].alone_secs >= two[1].alone_secs), "the greatest first");
}
