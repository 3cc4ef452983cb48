//! Scenes for the techniques: two with thin casters, where a hundred volumes overlap, and a smooth body with a very
//! short silhouette.

use glam::{DVec2, DVec3, dvec3};
use gnomon::mesh::Part;
use gnomon::view::Camera;
use std::f64::consts::{PI, TAU};

/// A scene with its camera and its sun; the ground lies at 0.
pub(crate) struct Dense {
    /// The mesh; everything casts and receives.
    pub(crate) parts: Vec<Part>,
    pub(crate) camera: Camera,
    pub(crate) to_sun: DVec3,
}

/// A room of 8 × 7 × 4 m without a roof: two walls, and bars in front of its open sides and above it. Their distance in
/// metres is given: 0.4 for an overdraw of 109, 0.85 for one of 52. The camera is in the room, and so in the volumes.
pub(crate) fn cage(pitch: f64) -> Dense {
    let (low, high) = (dvec3(-4.0, -3.5, 0.0), dvec3(4.0, 3.5, 4.0));
    let floor = cuboid("floor", low, dvec3(high.x, high.y, 0.05));
    let north = cuboid("north wall", dvec3(low.x, high.y, 0.0), dvec3(high.x, high.y + 0.2, high.z));
    let east = cuboid("east wall", dvec3(high.x, low.y, 0.0), dvec3(high.x + 0.2, high.y + 0.2, high.z));
    let mut bars = Part { name: "bars".into(), ..Part::default() };
    let mut bar = |from: DVec3, to: DVec3| prism(&mut bars, [from, to], 4, [0.02, 0.02]);
    let (across, along, up) = (high.x - low.x, high.y - low.y, high.z - low.z);
    let places = |length: f64, pitch: f64| {
        let count = (length / pitch) as u32;
        (1..=count).map(move |index| length * (f64::from(index) - 0.47) / f64::from(count))
    };
    for x in places(across, pitch).map(|x| low.x + x) {
        bar(dvec3(x, low.y, high.z), dvec3(x, high.y, high.z));
        bar(dvec3(x, low.y, 0.1), dvec3(x, low.y, high.z));
    }
    for y in places(along, pitch).map(|y| low.y + y) {
        bar(dvec3(low.x, y, high.z + 0.05), dvec3(high.x, y, high.z + 0.05));
        bar(dvec3(low.x, y, 0.1), dvec3(low.x, y, high.z));
    }
    for z in places(up, pitch).map(|z| low.z + z) {
        bar(dvec3(low.x, low.y - 0.05, z), dvec3(high.x, low.y - 0.05, z));
        bar(dvec3(low.x - 0.05, low.y, z), dvec3(low.x - 0.05, high.y, z));
    }
    let camera = camera(dvec3(-3.2, -2.9, 1.7), dvec3(1.6, 1.7, 1.25), 65.0);
    Dense { parts: vec![floor, north, east, bars], camera, to_sun: to_sun(222.0, 41.0) }
}

/// A tree without leaves, 13 m high: a trunk and four orders of branches, each a thin closed prism, turned from its
/// neighbour by the golden angle.
pub(crate) fn tree() -> Dense {
    /// Branches on each branch of an order, and how long they are, of that branch.
    const ORDERS: [(u32, f64); 4] = [(11, 0.62), (8, 0.52), (6, 0.5), (5, 0.5)];
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let mut tree = Part { name: "tree".into(), ..Part::default() };
    let mut branches = vec![([dvec3(0.0, 0.0, 0.0), dvec3(0.2, 0.1, 8.5)], 0.22)];
    prism(&mut tree, branches[0].0, 4, [0.22, 0.07]);
    for (order, (count, share)) in ORDERS.into_iter().enumerate() {
        let mut next = Vec::new();
        for (number, &([from, to], radius)) in branches.iter().enumerate() {
            let (right, up) = (to - from).normalize().any_orthonormal_pair();
            for index in 0..count {
                let at = 0.32 + 0.66 * (f64::from(index) + 0.5) / f64::from(count);
                let turn = golden * (f64::from(index) + number as f64 * 1.7 + order as f64);
                let aside = right * turn.cos() + up * turn.sin();
                let grows = ((to - from).normalize() * 0.75 + aside + DVec3::Z * 0.25).normalize();
                let length = (to - from).length() * share * (1.15 - 0.6 * at);
                let start = from.lerp(to, at);
                let thin = radius * (0.5 - 0.2 * at);
                prism(&mut tree, [start, start + grows * length], 4, [thin, thin * 0.4]);
                next.push(([start, start + grows * length], thin));
            }
        }
        branches = next;
    }
    let camera = camera(dvec3(9.0, -11.5, 6.5), dvec3(-2.0, 0.9, 4.3), 46.0);
    Dense { parts: vec![tree], camera, to_sun: to_sun(118.0, 38.0) }
}

/// A ring of 40,000 triangles, 9 m across, that leans with its foot in the ground; rows lie staggered so that no four
/// corners make a flat.
pub(crate) fn curved() -> Dense {
    const AROUND: u32 = 250;
    const ROWS: u32 = 80;
    let mut ring = Part { name: "ring".into(), ..Part::default() };
    let lean = glam::DQuat::from_rotation_z(0.6) * glam::DQuat::from_rotation_x(1.15);
    for row in 0..ROWS {
        let out = DVec2::from_angle(TAU * f64::from(row) / f64::from(ROWS));
        for column in 0..AROUND {
            let turn = TAU * (f64::from(column) + 0.5 * f64::from(row % 2)) / f64::from(AROUND);
            let radius = 3.6 + 0.9 * out.x;
            ring.positions.push(lean * dvec3(radius * turn.cos(), radius * turn.sin(), 0.9 * out.y) + DVec3::Z * 3.9);
            let [here, next] = [column, (column + 1) % AROUND].map(|column| row * AROUND + column);
            let above = (row + 1) % ROWS * AROUND;
            let [over, over_next] = [above + column, above + (column + 1) % AROUND];
            // an odd row lies half a step on
            ring.triangles.extend(match row % 2 {
                0 => [[here, next, over], [next, over_next, over]],
                _ => [[here, next, over_next], [here, over_next, over]],
            });
        }
    }
    let camera = camera(dvec3(9.0, -14.0, 8.5), dvec3(-1.0, 1.0, 2.2), 42.0);
    Dense { parts: vec![ring], camera, to_sun: to_sun(205.0, 36.0) }
}

fn camera(eye: DVec3, target: DVec3, fov_deg: f64) -> Camera {
    Camera { eye, target, up: DVec3::Z, fov_rad: fov_deg.to_radians(), width: 1280, height: 800 }
}

/// The direction to a sun, from degrees.
pub(crate) fn to_sun(azimuth_deg: f64, altitude_deg: f64) -> DVec3 {
    let (azimuth, altitude) = (azimuth_deg.to_radians(), altitude_deg.to_radians());
    dvec3(azimuth.sin() * altitude.cos(), azimuth.cos() * altitude.cos(), altitude.sin())
}

/// Adds a closed prism between two points, as thick as the radii say at either end.
pub(crate) fn prism(whole: &mut Part, ends: [DVec3; 2], sides: u32, radii: [f64; 2]) {
    let base = whole.positions.len() as u32;
    let (right, up) = (ends[1] - ends[0]).normalize().any_orthonormal_pair();
    // right × up must point along the prism
    let up = if right.cross(up).dot(ends[1] - ends[0]) < 0.0 { -up } else { up };
    for (end, radius) in ends.into_iter().zip(radii) {
        for side in 0..sides {
            let turn = TAU * (f64::from(side) + 0.5) / f64::from(sides);
            whole.positions.push(end + (right * turn.cos() + up * turn.sin()) * radius);
        }
    }
    for side in 0..sides {
        let [here, next] = [side, (side + 1) % sides].map(|side| base + side);
        whole.triangles.extend([[here, next, next + sides], [here, next + sides, here + sides]]);
    }
    for side in 1..sides - 1 {
        let [first, here, next] = [0, side, side + 1].map(|side| base + side);
        whole.triangles.extend([[first, next, here], [first + sides, here + sides, next + sides]]);
    }
}

/// A closed box.
pub(crate) fn cuboid(name: &str, low: DVec3, high: DVec3) -> Part {
    let corner =
        |index: u32| DVec3::select(glam::BVec3::new(index & 1 == 0, index & 2 == 0, index & 4 == 0), low, high);
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Part {
        name: name.into(),
        positions: (0..8).map(corner).collect(),
        triangles: quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
        ..Part::default()
    }
}
