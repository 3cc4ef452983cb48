//! An open lattice tower, 300 m high: four legs on masonry that curve together, arches between them, three platforms.
//!
//! A leg, an arch with its girder, and a side of the shaft are each drawn once and used four times.

use super::glb::{Material, Model, Node};
use super::shapes::{circle, lathe, lathe_hoop, on_circle, prism, rectangle, ring_wall, square, strut};
use super::solids::{Solid, loft};
use glam::{DVec2, DVec3, dvec2, dvec3};

const FIRST_PLATFORM: f64 = 57.5;
const SECOND_PLATFORM: f64 = 115.5;
/// Where the four legs have become one shaft.
const JOINT: f64 = 186.0;
const THIRD_PLATFORM: f64 = 275.0;

/// Half the tower's width at a height: a hyperbola through 62 m on the ground, 19.6 m at the second platform and 5 m at
/// the third, so that it needs no exponential.
fn outer(z: f64) -> f64 {
    6923.0 / (z + 91.27) - 13.85
}

/// From the axis to the inner face of a leg: 37 m on the ground, 0.7 m at the joint, where the chords still have room.
fn inner(z: f64) -> f64 {
    6546.0 / (z + 111.5) - 21.3
}

pub(super) fn model() -> Model {
    let mut model = Model::new();
    let iron = model.material("iron", [0.36, 0.25, 0.17, 1.0]);
    let masonry = model.material("masonry", [0.62, 0.56, 0.46, 1.0]);
    let deck = model.material("deck", [0.42, 0.33, 0.25, 1.0]);
    let lawn = model.material("lawn", [0.33, 0.44, 0.2, 1.0]);
    let path = model.material("path", [0.7, 0.65, 0.55, 1.0]);

    let leg = model.mesh("leg", vec![(iron, leg()), (masonry, pedestal())]);
    let arch = model.mesh("arch", vec![(iron, arch())]);
    let shaft = model.mesh("shaft", vec![(iron, shaft())]);
    let platforms = model.mesh("platforms", vec![(deck, decks()), (iron, railings())]);
    let summit = model.mesh("summit", vec![(deck, cabin()), (iron, lantern())]);
    let ground = model.mesh("ground", ground(lawn, path));

    let around = |name: &str, mesh| {
        let sides = ["south", "east", "north", "west"];
        let side = |(turns, side): (usize, &&str)| Node::showing(&format!("{name}-{side}"), mesh).turned(turns as u32);
        Node::group(&format!("{name}s"), sides.iter().enumerate().map(side).collect())
    };
    let legs = vec![
        Node::showing("leg-north-east", leg),
        Node::showing("leg-north-west", leg).mirrored(),
        Node::showing("leg-south-west", leg).turned(2),
        Node::showing("leg-south-east", leg).turned(3),
    ];
    model.nodes = vec![
        Node::group(
            "tower",
            vec![
                Node::group("legs", legs),
                around("arch", arch),
                around("shaft", shaft),
                Node::showing("platforms", platforms),
                Node::showing("summit", summit).at(0.0, 0.0, THIRD_PLATFORM),
            ],
        ),
        Node::showing("ground", ground),
    ];
    model
}

/// A post that follows `at` through the heights, its square section growing thinner.
fn chord(heights: &[f64], at: impl Fn(f64) -> DVec2, thickness: impl Fn(f64) -> f64) -> Solid {
    let section = |&z: &f64| rectangle(at(z).extend(z), DVec2::splat(thickness(z) / 2.0));
    loft(&heights.iter().map(section).collect::<Vec<_>>())
}

/// The bracing between two chords: in each bay a cross, and a bar along its top.
fn lattice(heights: &[f64], a: impl Fn(f64) -> DVec2, b: impl Fn(f64) -> DVec2, thickness: f64) -> Vec<Solid> {
    let bay = |ends: &[f64]| {
        let [low, high] = [ends[0], ends[1]];
        let bar = |from: DVec3, to: DVec3| strut(from, to, thickness, thickness);
        [
            bar(a(low).extend(low), b(high).extend(high)),
            bar(b(low).extend(low), a(high).extend(high)),
            bar(a(high).extend(high), b(high).extend(high)),
        ]
    };
    heights.windows(2).flat_map(bay).collect()
}

/// Equal bays between two heights.
fn bays(from: f64, to: f64, count: u32) -> Vec<f64> {
    (0..=count).map(|bay| from + (to - from) * f64::from(bay) / f64::from(count)).collect()
}

/// The leg in the north-east.
fn leg() -> Vec<Solid> {
    let corners: [fn(f64) -> DVec2; 4] = [
        |z| dvec2(inner(z), inner(z)),
        |z| dvec2(outer(z), inner(z)),
        |z| dvec2(outer(z), outer(z)),
        |z| dvec2(inner(z), outer(z)),
    ];
    let lower = bays(4.0, FIRST_PLATFORM, 4);
    let middle = bays(FIRST_PLATFORM, SECOND_PLATFORM, 3);
    let upper = bays(SECOND_PLATFORM, JOINT, 4);
    let heights: Vec<f64> = lower.iter().chain(&middle[1..]).chain(&upper[1..]).copied().collect();

    let mut solids = Vec::new();
    for side in 0..4 {
        let (a, b) = (corners[side], corners[(side + 1) % 4]);
        // Above the second platform the innermost chord would run in the lift's way.
        let is_innermost = side == 0;
        let end = if is_innermost { heights.len() - upper.len() + 1 } else { heights.len() };
        // The outermost chord goes on in the shaft; the others have done their work at the joint.
        let thinning = if side == 2 { 1.0 / 200.0 } else { 1.0 / 118.0 };
        solids.push(chord(&heights[..end], a, |z| 2.2 - z * thinning));
        solids.extend(lattice(&lower, a, b, 1.0));
        solids.extend(lattice(&middle, a, b, 0.8));
        let is_outside = side == 1 || side == 2;
        if is_outside {
            solids.extend(lattice(&upper, a, b, 0.6));
        }
    }
    solids
}

/// Under each chord of a leg a pier, all on one stepped plinth.
fn pedestal() -> Vec<Solid> {
    let (near, far) = (inner(0.0), outer(0.0));
    let middle = DVec2::splat((near + far) / 2.0);
    let half = (far - near) / 2.0;
    let step = |top: f64, margin: f64| rectangle(middle.extend(top), DVec2::splat(half + margin));
    let mut solids = vec![loft(&[step(0.0, 4.5), step(1.2, 4.2), step(1.2, 3.6), step(2.2, 3.4)])];
    for (x, y) in [(near, near), (far, near), (far, far), (near, far)] {
        // The chords lean towards the axis, and so do the piers.
        let lean = outer(5.0) - outer(0.0);
        let pier = |z: f64, half: f64, lean: f64| rectangle(dvec3(x + lean, y + lean, z), DVec2::splat(half));
        solids.push(loft(&[pier(1.0, 3.2, 0.0), pier(5.0, 2.4, lean)]));
    }
    solids
}

/// The south side's arch under the first platform, and the girder above it.
fn arch() -> Vec<Solid> {
    const PIECES: u32 = 12;
    const FOOT: f64 = 9.0;
    // The ribs lie in the outer face of the legs, which leans back.
    let on_face = |x: f64, z: f64| dvec3(x, -outer(z), z);
    let rib_point = |piece: u32, span: f64, rise: f64| {
        let around = on_circle(0.5 * f64::from(piece) / f64::from(PIECES));
        on_face(span * around.x, FOOT + rise * around.y)
    };
    let lower = |piece| rib_point(piece, 34.0, 36.0);
    let upper = |piece| rib_point(piece, 37.5, 39.5);
    let rib = |at: &dyn Fn(u32) -> DVec3, size: f64| {
        let section = |piece: u32| {
            let radial = on_circle(0.5 * f64::from(piece) / f64::from(PIECES));
            let out = dvec3(radial.x, 0.0, radial.y) * (size / 2.0);
            let across = DVec3::Y * (size * 0.6);
            let centre = at(piece);
            vec![centre - out - across, centre + out - across, centre + out + across, centre - out + across]
        };
        loft(&(0..=PIECES).map(section).collect::<Vec<_>>())
    };
    let mut solids = vec![rib(&lower, 1.0), rib(&upper, 1.0)];
    for piece in 0..PIECES {
        let (from, to) =
            if piece % 2 == 0 { (lower(piece), upper(piece + 1)) } else { (upper(piece), lower(piece + 1)) };
        solids.push(strut(from, to, 0.5, 0.5));
    }

    // The girder carries the platform from leg to leg.
    const PANELS: u32 = 6;
    let (bottom, top) = (FIRST_PLATFORM - 7.0, FIRST_PLATFORM - 1.5);
    let half = inner(bottom) + 2.0;
    let node = |panel: u32, z: f64| on_face(half * (2.0 * f64::from(panel) / f64::from(PANELS) - 1.0), z);
    solids.push(strut(node(0, bottom), node(PANELS, bottom), 1.0, 1.0));
    solids.push(strut(node(0, top), node(PANELS, top), 1.0, 1.0));
    for panel in 0..PANELS {
        solids.push(strut(node(panel, bottom), node(panel + 1, top), 0.5, 0.5));
        solids.push(strut(node(panel, top), node(panel + 1, bottom), 0.5, 0.5));
    }
    solids
}

/// The south side of the shaft above the joint, with the chord at its eastern end.
fn shaft() -> Vec<Solid> {
    let heights = bays(JOINT, THIRD_PLATFORM, 6);
    let east = |z: f64| dvec2(outer(z), -outer(z));
    let west = |z: f64| dvec2(-outer(z), -outer(z));
    let mut solids = vec![chord(&heights, east, |z| 2.2 - z / 200.0)];
    solids.extend(lattice(&heights, west, east, 0.5));
    // Between the legs, from the second platform to the joint, bars tie the two halves of the face.
    for z in &bays(SECOND_PLATFORM, JOINT, 4)[1..4] {
        solids.push(strut(dvec3(-inner(*z), -outer(*z), *z), dvec3(inner(*z), -outer(*z), *z), 0.6, 0.6));
    }
    solids
}

/// The first and second platform: rings around an open middle, with their halls.
fn decks() -> Vec<Solid> {
    let first = outer(FIRST_PLATFORM);
    let second = outer(SECOND_PLATFORM);
    let (low, high) = (FIRST_PLATFORM, SECOND_PLATFORM);
    let mut solids = vec![
        ring_wall(&square(first + 3.5), &square(13.0), low - 1.5, low),
        ring_wall(&square(first + 2.0), &square(first + 1.4), low - 4.0, low - 1.25),
        ring_wall(&square(second + 2.5), &square(4.0), high - 1.2, high),
        ring_wall(&square(second + 1.4), &square(second + 0.9), high - 3.5, high - 1.0),
        // The upper storey of the second platform stands back.
        ring_wall(&square(second - 1.0), &square(5.0), high + 3.6, high + 4.2),
    ];
    for turns in 0..4 {
        let side = on_circle(f64::from(turns) / 4.0);
        let along = side.perp();
        let hall = |from: f64, to: f64, half: f64| -> Vec<DVec2> {
            [(from, -half), (to, -half), (to, half), (from, half)].map(|(x, y)| x * side + y * along).to_vec()
        };
        let of_first = hall(inner(low) + 2.0, first - 3.0, 11.0);
        solids.push(prism(&of_first, low - 0.25, low + 5.5));
        solids.push(prism(&hall(5.5, second - 4.5, 4.5), high - 0.25, high + 3.0));
    }
    solids
}

/// Parapets of the platforms: posts and a rail.
fn railings() -> Vec<Solid> {
    let mut solids = Vec::new();
    let places = [(outer(FIRST_PLATFORM) + 3.2, FIRST_PLATFORM, 5), (outer(SECOND_PLATFORM) + 2.2, SECOND_PLATFORM, 3)];
    for (half, floor, posts) in places {
        solids.push(ring_wall(&square(half + 0.1), &square(half - 0.1), floor + 1.1, floor + 1.3));
        for turns in 0..4 {
            let side = on_circle(f64::from(turns) / 4.0);
            for post in 0..posts {
                let along = half * (2.0 * f64::from(post) / f64::from(posts) - 1.0);
                let foot = (half * side + along * side.perp()).extend(floor - 0.1);
                solids.push(strut(foot, foot + 1.3 * DVec3::Z, 0.15, 0.15));
            }
        }
    }
    solids
}

/// The third platform, around its own floor: a cabin that widens, and its gallery.
fn cabin() -> Vec<Solid> {
    let ring = |half: f64, z: f64| rectangle(DVec3::Z * z, DVec2::splat(half));
    vec![
        loft(&[ring(5.2, -3.0), ring(8.2, -0.5), ring(8.2, 0.6)]),
        loft(&[ring(6.6, 0.5), ring(6.6, 4.0)]),
        loft(&[ring(7.6, 3.9), ring(7.4, 4.6), ring(4.4, 6.6)]),
    ]
}

/// What crowns the cabin: a rail, a drum with a dome, and the mast up to 300 m.
fn lantern() -> Vec<Solid> {
    let foot = DVec3::ZERO;
    let mut solids = vec![
        ring_wall(&square(8.0), &square(7.8), 1.6, 1.8),
        lathe(foot, &[(3.0, 6.2), (3.0, 11.0), (2.6, 12.8), (1.5, 14.2), (0.6, 14.8)], 12),
        lathe(foot, &[(0.55, 14.5), (0.4, 20.0), (0.12, 300.0 - THIRD_PLATFORM)], 8),
        lathe_hoop(foot, &[(1.4, 16.8), (1.4, 17.1), (0.3, 17.1), (0.3, 16.8)], 12),
    ];
    for corner in circle(foot, 5.2, 4) {
        solids.push(strut(corner + 5.0 * DVec3::Z, corner * 0.5 + 10.5 * DVec3::Z, 0.3, 0.3));
    }
    solids
}

/// Lawns and paths around the tower, a hand above the ground so that no two faces lie in one plane.
fn ground(lawn: Material, path: Material) -> Vec<(Material, Vec<Solid>)> {
    const LAWN_TOP: f64 = 0.15;
    let mut lawns = Vec::new();
    // Two lawns beside each axis; the shadow of the morning runs over those in the west, at noon over the northern.
    for (turns, length) in [(0.0, 70.0), (0.25, 190.0), (0.5, 230.0), (0.75, 100.0)] {
        let along = on_circle(turns);
        for side in [-1.0, 1.0] {
            let corner = |forth: f64, beside: f64| forth * along + side * beside * along.perp();
            let (near, far) = (80.0, 80.0 + length);
            let strip = [corner(near, 12.0), corner(far, 12.0), corner(far, 46.0), corner(near, 46.0)];
            lawns.push(prism(&strip, 0.0, LAWN_TOP));
        }
    }
    let basin = circle(dvec3(-340.0, 0.0, 0.0), 22.0, 16);
    let rim: Vec<DVec2> = basin.iter().map(|point| point.truncate()).collect();
    let esplanade = ring_wall(&square(30.0), &square(18.0), 0.0, 0.1);
    vec![(lawn, lawns), (path, vec![esplanade, prism(&rim, 0.0, 0.3)])]
}
