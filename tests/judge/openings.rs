//! Points inside a wall, which see the sun through their opening.

use super::{endless_wall, judged, nothing, secs, site, value_secs, window};
use crate::shared::dense::cuboid;
use glam::{DVec3, dvec3};
use gnomon::judgement::SpellBound;
use gnomon::rules::Verdict;
use gnomon::site::{JudgedSite, JudgedWindow};
use gnomon::sun::Place;

const EN: &str = "eu-en-17037-sunlight";
const DAY: [(&str, &str); 2] = [("above", "DE"), ("date", "03-21")];

fn frankfurt() -> Place {
    Place::new("", 50.11, 8.68, 0.0, Some("Europe/Berlin")).expect("a place")
}

/// A window in a wall of 0.5 m, whose glass lies 0.1 m behind the outer plane at y = 0.
fn deep(name: &str, room: &str) -> JudgedWindow {
    let mut own = window(name, dvec3(0.0, 0.1, 1.0), DVec3::NEG_Y);
    (own.reveal_m, own.inner_m, own.floor) = (0.1, Some(0.4), Some(0.2));
    (own.room, own.dwelling) = (Some(room.into()), Some("1".into()));
    own
}

fn house(parts: Vec<gnomon::mesh::Part>) -> JudgedSite {
    let mut asked = site(frankfurt(), parts, None);
    asked.windows = vec![deep("south", "living")];
    asked
}

/// Whether the sun reaches the point, 1.4 m high and 0.5 m behind the outer plane, through a hole 2 m wide from 1 to 2.5 m.
fn through(sun: DVec3) -> bool {
    if sun.y >= 0.0 || sun.z <= 11f64.to_radians().sin() {
        return false;
    }
    let at = dvec3(0.0, 0.5, 1.4) + sun * (0.5 / -sun.y);
    at.x.abs() <= 1.0 && (1.0..=2.5).contains(&at.z)
}

#[test]
fn a_reveal_takes_the_sun_from_the_side() {
    // the model's own wall, a closed block without an opening, and a model without any wall
    let block = cuboid("house", dvec3(-10.0, 0.0, 0.0), dvec3(10.0, 8.0, 6.0));
    for parts in [vec![block], vec![nothing()]] {
        let asked = house(parts);
        let found = judged(&asked, EN, &DAY);
        let receiver = &found.receivers[0];
        assert!(receiver.points[0].distance(dvec3(0.0, 0.5, 1.4)) < 1e-9, "{:?}", receiver.points);
        let expected = secs(&asked.place, &found.days[0], through);
        let value = value_secs(receiver);
        assert!((value - expected).abs() <= 2, "{value} {expected}");
        let spell = receiver.spells[0].now[0];
        assert_eq!([spell.before, spell.after], [SpellBound::Reveal; 2]);
        assert!(found.notes.iter().any(|note| note.to_string().contains("outer plane")));
    }
}

/// What stands before the wall casts, as it does everywhere.
#[test]
fn what_stands_before_the_wall_casts() {
    let asked = house(vec![endless_wall("wall", -10.0, 9.0)]);
    let found = judged(&asked, EN, &DAY);
    let is_lit = |sun: DVec3| through(sun) && super::over_wall(sun, 10.5, 9.0 - 1.4);
    let expected = secs(&asked.place, &found.days[0], is_lit);
    assert!((value_secs(&found.receivers[0]) - expected).abs() <= 2);
    let block = cuboid("own house", dvec3(-10.0, 0.0, 0.0), dvec3(10.0, 8.0, 6.0));
    let with = judged(&house(vec![endless_wall("wall", -10.0, 9.0), block]), EN, &DAY);
    assert_eq!(value_secs(&with.receivers[0]), value_secs(&found.receivers[0]));
}

/// Two windows of a room are added up where the sun is not in both at once; the day with the most sun is taken.
#[test]
fn a_rooms_windows_are_one() {
    let mut asked = house(vec![nothing()]);
    let mut west = deep("west", "living");
    let turned = |at: DVec3| dvec3(at.y, at.x, at.z) * dvec3(1.0, 1.0, 1.0);
    west.outward = DVec3::NEG_X;
    west.corners = window("west", dvec3(0.1, 0.0, 1.0), DVec3::NEG_X).corners;
    assert!(turned(dvec3(0.0, 0.1, 1.0)).distance(dvec3(0.1, 0.0, 1.0)) < 1e-9);
    asked.windows.push(west);
    let found = judged(&asked, EN, &DAY);
    let room = &found.groups[0];
    let of_west = |sun: DVec3| {
        let turned = dvec3(sun.y, sun.x, sun.z);
        through(turned)
    };
    let both = secs(&asked.place, &found.days[0], |sun| through(sun) || of_west(sun));
    let value = room.ruling.as_ref().and_then(|ruling| ruling.deciding.map(|at| ruling.findings[at].value));
    assert!(
        matches!(value, Some(gnomon::rules::Quantity::Secs(value)) if (value - both).abs() <= 3),
        "{value:?} {both}"
    );
    assert_eq!((room.of.len(), found.groups[1].verdict), (2, Verdict::Pass));
    let free = judged(&asked, EN, &[("above", "DE")]);
    assert_eq!((free.days.len(), free.verdict), (49, Verdict::Pass));
    assert!(free.grade.is_some() && free.receivers[0].spells.len() == 1);
}

#[test]
fn a_point_above_its_opening_sees_nothing() {
    let mut asked = house(vec![nothing()]);
    asked.windows[0].floor = Some(2.0);
    let found = judged(&asked, EN, &DAY);
    assert_eq!((value_secs(&found.receivers[0]), found.verdict), (0, Verdict::Fail));
}
