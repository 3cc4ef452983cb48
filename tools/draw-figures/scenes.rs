//! Small scenes that show one thing each.

use crate::dense::{cuboid, prism};
use glam::{DVec3, dvec3};
use gnomon::mesh::Part;

/// A house of 12 × 8 m with a balcony, a gate of bars, a fence and a column in its yard, which lies to the south.
pub(crate) fn house() -> Vec<Part> {
    let mut parts = vec![
        cuboid("house", dvec3(-6.0, 0.0, 0.0), dvec3(6.0, 8.0, 6.2)),
        cuboid("roof", dvec3(-6.4, -0.4, 6.2), dvec3(6.4, 8.4, 6.5)),
        cuboid("chimney", dvec3(5.0, 0.5, 6.5), dvec3(5.8, 1.3, 10.5)),
        cuboid("balcony", dvec3(-4.5, -1.7, 2.8), dvec3(1.5, 0.0, 3.0)),
    ];
    let mut railing = Part { name: "railing".into(), ..Part::default() };
    let mut bar = |from: DVec3, to: DVec3, radius: f64| prism(&mut railing, [from, to], 4, [radius; 2]);
    for index in 0..=40 {
        let x = -4.45 + 5.9 * f64::from(index) / 40.0;
        bar(dvec3(x, -1.65, 3.0), dvec3(x, -1.65, 3.95), 0.02);
    }
    for index in 1..=10 {
        let y = -1.65 + 1.6 * f64::from(index) / 10.0;
        bar(dvec3(1.45, y, 3.0), dvec3(1.45, y, 3.95), 0.02);
    }
    bar(dvec3(-4.5, -1.65, 3.97), dvec3(1.5, -1.65, 3.97), 0.04);
    bar(dvec3(1.45, -1.65, 3.97), dvec3(1.45, 0.0, 3.97), 0.04);
    parts.push(railing);
    parts.push(fence(dvec3(-9.0, -8.0, 0.0), dvec3(9.0, -8.0, 0.0)));
    let mut column = Part { name: "column".into(), ..Part::default() };
    prism(&mut column, [dvec3(6.6, -4.6, 0.0), dvec3(6.6, -4.6, 3.2)], 32, [0.45, 0.45]);
    parts.push(column);
    parts
}

/// Pickets 1.3 m high, a hand's breadth wide and apart.
fn fence(from: DVec3, to: DVec3) -> Part {
    let mut fence = Part { name: "fence".into(), ..Part::default() };
    let count = ((to - from).length() / 0.22) as u32;
    for index in 0..=count {
        let foot = from.lerp(to, f64::from(index) / f64::from(count));
        prism(&mut fence, [foot, foot + DVec3::Z * 1.3], 4, [0.07, 0.07]);
    }
    for z in [0.35, 1.0] {
        prism(&mut fence, [from + DVec3::Z * z, to + DVec3::Z * z], 4, [0.04, 0.04]);
    }
    fence
}

/// A plate 6 m above the ground, and a lower one that catches part of its shadow's edge.
pub(crate) fn two_plates() -> Vec<Part> {
    vec![
        cuboid("upper", dvec3(-1.0, -9.0, 6.0), dvec3(2.0, 3.0, 6.2)),
        cuboid("lower", dvec3(-1.85, 0.0, 4.2), dvec3(2.6, 2.4, 4.4)),
    ]
}

/// A slit between two plates 9 m above the ground, and two poles below it.
pub(crate) fn crossing() -> Vec<Part> {
    let mut parts = vec![
        cuboid("west", dvec3(-3.0, -1.5, 9.0), dvec3(-0.06, 1.2, 9.2)),
        cuboid("east", dvec3(0.06, -1.5, 9.0), dvec3(3.0, 1.2, 9.2)),
    ];
    for (from, to) in [(dvec3(-3.0, 2.9, 5.0), dvec3(3.0, 6.4, 5.0)), (dvec3(-2.6, 7.1, 7.0), dvec3(2.2, -0.9, 7.0))] {
        let mut pole = Part { name: "pole".into(), ..Part::default() };
        prism(&mut pole, [from, to], 8, [0.07, 0.07]);
        parts.push(pole);
    }
    parts
}
