//! Parts of areas whose borders are known: how far what is measured is off, and what is said of that.

use super::{corner, london};
use chrono::TimeZone;
use glam::{DVec2, DVec3};
use gnomon::judgement::{PartTriangle, triangles};
use gnomon::study::judge::{MeasuredPart, measured_part};

/// The side of the square that is measured, metres.
const SIDE: f64 = 20.0;

fn square() -> Vec<PartTriangle> {
    triangles(&[vec![corner(0.0, 0.0), corner(SIDE, 0.0), corner(SIDE, SIDE), corner(0.0, SIDE)]])
}

fn measured(number: impl Fn(DVec3) -> f64 + Sync) -> MeasuredPart {
    let at = london().time_zone.from_utc_datetime(&chrono::DateTime::UNIX_EPOCH.naive_utc());
    measured_part(&square(), (SIDE / 16.0, 0.001 * SIDE * SIDE), at, number).expect("a part")
}

/// The part of the square on one side of a line.
fn beside(normal: DVec2, along: f64) -> f64 {
    let mut ring = vec![corner(0.0, 0.0), corner(SIDE, 0.0), corner(SIDE, SIDE), corner(0.0, SIDE)];
    let away = |at: &DVec2| normal.dot(*at) - along;
    let mut kept = Vec::new();
    for at in 0..ring.len() {
        let (from, to) = (ring[at], ring[(at + 1) % ring.len()]);
        if away(&from) >= 0.0 {
            kept.push(from);
        }
        if away(&from) * away(&to) < 0.0 {
            kept.push(from.lerp(to, away(&from) / (away(&from) - away(&to))));
        }
    }
    ring = kept;
    (0..ring.len()).map(|at| ring[at].perp_dot(ring[(at + 1) % ring.len()])).sum::<f64>() / 2.0
}

/// How far measurements are off, as parts of the errors that are said of them.
fn ratios() -> Vec<f64> {
    let mut ratios = Vec::new();
    let mut check = |found: MeasuredPart, exact: f64, what: &str| {
        assert!(found.error_m2 <= 0.001 * SIDE * SIDE, "{what}: {found:?}");
        assert!(found.points < 6000, "{what}: {found:?}");
        ratios.push((found.m2 - exact).abs() / found.error_m2);
    };
    // jumps of a time in the sun, which say nothing of where between two points they are
    for number in 0..150 {
        let (sin, cos) = (f64::from(number) * 2.399_963).sin_cos();
        let normal = DVec2::new(cos, sin);
        let along = normal.dot(DVec2::splat(SIDE / 2.0)) + SIDE * 0.3 * (f64::from(number) * 0.618_034).fract();
        let found = measured(|at| if normal.dot(at.truncate()) >= along { 500.0 } else { -3000.0 });
        check(found, beside(normal, along), "a line");
    }
    for number in 0..150 {
        let middle = DVec2::new(8.0 + 4.0 * (f64::from(number) * 0.618_034).fract(), 9.0 + f64::from(number % 7) / 3.0);
        let radius = 4.0 + 3.0 * (f64::from(number) * 0.754_878).fract();
        let found = measured(|at| if at.truncate().distance(middle) <= radius { 1.0 } else { -1.0 });
        check(found, std::f64::consts::PI * radius * radius, "a disc");
    }
    ratios
}

/// No error exceeds what is said of it, and some are so large that no small part of that would do.
#[test]
fn parts_are_as_exact_as_is_said() {
    let ratios = ratios();
    let worst = ratios.iter().copied().fold(0.0, f64::max);
    assert!(worst <= 1.0, "{worst}");
    let beyond = |part: f64| ratios.iter().filter(|ratio| **ratio > part).count();
    assert!(beyond(0.25) > 0 && beyond(0.1) > 20, "{worst} {} {}", beyond(0.25), beyond(0.1));
    // a random sum is off to both sides
    assert!(beyond(0.01) > 200, "{}", beyond(0.01));
}

/// Every run has the same points.
#[test]
fn parts_are_the_same_every_time() {
    let number = |at: DVec3| 7.3 - at.x - 0.37 * at.y;
    let [one, other] = [measured(number), measured(number)];
    assert_eq!((one.m2, one.error_m2, one.points), (other.m2, other.error_m2, other.points));
}

/// Along a row of corners the border is known from both sides.
#[test]
fn what_has_no_border_has_no_error() {
    let whole = measured(|_| 1.0);
    assert_eq!((whole.m2, whole.error_m2), (SIDE * SIDE, 0.0));
    assert_eq!(measured(|_| -1.0).m2, 0.0);
}
