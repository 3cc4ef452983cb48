//! Searches that share work: two states of a site, and points inside walls; the same as searches of their own.

use super::{cuboid, day, paris, sheet};
use glam::{DVec3, dvec3};
use gnomon::mesh::{Mesh, Part};
use gnomon::sun::{Air, DayWindow};
use gnomon::sunlight::{Interval, IntervalBound, JudgedPoint, ProbeSearch, SearchedDays, WallFront};

fn street() -> Mesh {
    let leaning = [dvec3(-9.0, -9.0, 0.0), dvec3(3.0, -8.0, 0.0), dvec3(3.0, -5.0, 9.0), dvec3(-9.0, -6.0, 8.0)];
    let parts = vec![
        cuboid("stays", dvec3(-15.0, -30.0, 0.0), dvec3(-3.0, -20.0, 12.0)),
        cuboid("new", dvec3(-5.0, -26.0, 0.0), dvec3(9.0, -18.0, 21.0)),
        cuboid("gone", dvec3(4.0, -22.0, 0.0), dvec3(25.0, -13.0, 10.0)),
        Part { name: "roof".into(), ..sheet(leaning) },
        // stands in the way of points inside the wall at y = 0, behind it, in it and across it
        cuboid("wall", dvec3(-20.0, 0.0, 0.0), dvec3(20.0, 0.4, 6.0)),
        cuboid("balcony", dvec3(-2.0, -1.5, 2.8), dvec3(2.0, 0.2, 3.0)),
    ];
    Mesh::build_around(parts, DVec3::ZERO).unwrap()
}

fn points() -> Vec<JudgedPoint> {
    let normals = [None, None, Some(DVec3::NEG_Y), Some(dvec3(0.6, 0.0, 0.8))];
    let place = |number: usize| {
        let (x, y) = ((number * 7 % 23) as f64 * 1.61 - 17.0, (number * 5 % 13) as f64 * -0.93 - 0.3);
        JudgedPoint { point: dvec3(x, y, 0.2 + (number % 4) as f64), normal: normals[number % 4], below_ground_m: None }
    };
    (0..24).map(place).collect()
}

/// A few days, of which exact suns are kept, and more days, of which they are not.
fn seasons() -> [Vec<DayWindow>; 2] {
    let on = |date: &str| day(&paris(), date, None);
    let dates = (1..=18).map(|number| on(&format!("2026-04-{number:02}")));
    [["2026-03-21", "2026-12-21"].map(on).to_vec(), dates.collect()]
}

/// The intervals with the names of what bounds them.
fn named(search: &ProbeSearch, days: Vec<Vec<Interval>>) -> Vec<Vec<(Interval, [String; 2])>> {
    let names = search.components();
    let name = |bound: IntervalBound| match bound {
        IntervalBound::Component(at) => names[at].clone(),
        other => format!("{other:?}"),
    };
    let one = |of: Interval| {
        let names = [name(of.before), name(of.after)];
        (Interval { before: IntervalBound::Window, after: IntervalBound::Window, ..of }, names)
    };
    days.into_iter().map(|day| day.into_iter().map(one).collect()).collect()
}

#[test]
fn two_states_share_what_casts_in_both() {
    let (street, points) = (street(), points());
    let state = |without: &str| {
        let stands: Vec<bool> = street.components.iter().map(|component| component.name != without).collect();
        street.of_components(&stands)
    };
    for [now, before] in [["gone", "new"], ["", "new"], ["gone", ""], ["", ""]] {
        let shared = ProbeSearch::two([state(now), state(before)], &points);
        let own = [now, before].map(|without| ProbeSearch::new(state(without), &points));
        let mut differing = 0;
        for days in seasons() {
            let place = paris();
            let days = SearchedDays::new(&place, &days, Some(Air::standard(35.0))).unwrap();
            for at in &points {
                let found = ProbeSearch::intervals_in_both([&shared[0], &shared[1]], [at, at], None, &days).unwrap();
                differing += usize::from(found[0] != found[1]);
                for (search, found) in own.iter().zip(found) {
                    assert_eq!(found, search.intervals(at, &days).unwrap(), "{now} {before} {at:?}");
                }
                // points that differ, as on two terrains
                let higher = JudgedPoint { point: at.point + DVec3::Z, ..*at };
                let found =
                    ProbeSearch::intervals_in_both([&shared[0], &shared[1]], [at, &higher], None, &days).unwrap();
                assert_eq!(found[1], own[1].intervals(&higher, &days).unwrap(), "{now} {before} {at:?}");
            }
        }
        assert_eq!(differing > 0, now != before);
    }
}

#[test]
fn what_is_behind_a_wall_takes_no_sun_from_inside_it() {
    let street = street();
    let wall = WallFront { normal: DVec3::NEG_Y, along_m: 0.0 };
    let inside = |number: usize| JudgedPoint {
        point: dvec3(number as f64 * 1.9 - 17.0, 0.3, 1.2 + (number % 3) as f64),
        normal: Some(DVec3::NEG_Y),
        below_ground_m: None,
    };
    let points: Vec<JudgedPoint> = (0..18).map(inside).collect();
    let reaches = |face: u32| street.corners(face as usize).iter().any(|corner| corner.y < 0.0);
    let whole = ProbeSearch::new(street.clone(), &points);
    let cut = ProbeSearch::new(street.of_faces(reaches), &points);
    let (mut secs, mut of_whole) = (0, 0);
    for days in seasons() {
        let place = paris();
        let days = SearchedDays::new(&place, &days, None).unwrap();
        for at in &points {
            let found = whole.intervals_before(at, Some(wall), &days).unwrap();
            secs += found.iter().flatten().map(Interval::secs).sum::<i64>();
            of_whole += whole.intervals(at, &days).unwrap().iter().flatten().map(Interval::secs).sum::<i64>();
            assert_eq!(named(&whole, found), named(&cut, cut.intervals(at, &days).unwrap()), "{at:?}");
        }
    }
    // with the wall itself it is dark inside
    assert!(secs > 1_000_000 && of_whole == 0, "{secs} {of_whole}");
}
