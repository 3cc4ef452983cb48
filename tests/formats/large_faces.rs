//! Faces with too many corners for ear clipping: lakes, spirals and spikes.

use super::building::{left_out, read_bytes, triangles};
use gnomon::formats::Model;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::time::{Duration, Instant};

/// A face of this ring, in the plane of the ground, seen from above.
fn face(ring: &[[f64; 2]]) -> Model {
    let mut text = String::from("o lake\n");
    ring.iter().for_each(|[x, y]| writeln!(text, "v {x} 0 {}", -y).unwrap());
    // beside it a face that is small, so that the file has one in any case
    text.push_str("v 0 -9 0\nv 1 -9 0\nv 0 -9 1\n");
    let corners: Vec<String> = (1..=ring.len()).map(|corner| corner.to_string()).collect();
    let small = ring.len();
    write!(text, "f {}\nf {} {} {}\n", corners.join(" "), small + 1, small + 3, small + 2).unwrap();
    let started = Instant::now();
    let model = read_bytes("lake.obj", text.as_bytes());
    assert!(started.elapsed() < Duration::from_secs(10), "it takes the square of its corners");
    model
}

/// What a ring encloses, counter-clockwise.
fn area(ring: &[[f64; 2]]) -> f64 {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|([ax, ay], [bx, by])| (ax * by - ay * bx) / 2.0).sum()
}

/// The area of the triangles of the large face, each of which must look up.
fn covered(model: &Model) -> f64 {
    let large = triangles(model).filter(|[a, ..]| a.z > -1.0);
    let areas = large.map(|[a, b, c]| (b - a).cross(c - a).z / 2.0);
    areas.inspect(|area| assert!(*area >= 0.0, "a triangle looks down")).sum()
}

/// Spikes of many lengths around a middle.
fn spikes(count: usize) -> Vec<[f64; 2]> {
    let spike = |at: usize| {
        let (sin, cos) = (TAU * at as f64 / count as f64).sin_cos();
        let reach = 100.0 + 90.0 * ((at * at) as f64 * 0.7).sin();
        [reach * cos, reach * sin]
    };
    (0..count).map(spike).collect()
}

/// A strip that winds around a middle.
fn spiral(count: usize) -> Vec<[f64; 2]> {
    let at = |step: usize, inward: f64| {
        let turn = step as f64 * 0.02;
        [(10.0 + turn - inward) * turn.cos(), (10.0 + turn - inward) * turn.sin()]
    };
    (0..count / 2).map(|step| at(step, 0.0)).chain((0..count / 2).rev().map(|step| at(step, 3.0))).collect()
}

#[test]
fn large_faces_are_covered_whatever_their_form() {
    for ring in [spikes(60_000), spiral(60_000)] {
        let model = face(&ring);
        let (covered, encloses) = (covered(&model), area(&ring));
        assert!((covered / encloses - 1.0).abs() < 1e-6, "{covered} of {encloses}");
        assert_eq!((triangles(&model).count(), model.left_out.len()), (ring.len() - 2 + 1, 0));
    }
}

#[test]
fn large_faces_that_cross_themselves_are_told() {
    let mut ring = spikes(30_000);
    ring.swap(100, 15_000);
    let model = face(&ring);
    assert_eq!(left_out(&model), ["1 faces"]);
    assert!(model.left_out[0].why.contains("rings that cross or touch"), "{:?}", model.left_out);
}
