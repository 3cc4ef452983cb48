//! The works' plant: flues and chimneys, tanks, silos with their conveyor, cooling cells, the pipe bridge.

use super::shapes::{block, circle, extrude, lathe, lathe_hoop, on_circle, on_foot, pipe, row, strut};
use super::solids::Solid;
use glam::{DVec3, dvec2, dvec3};

/// From the boilers to the chimneys.
pub(super) fn flues() -> Vec<Solid> {
    let from_boiler = |x: f64| pipe(&[dvec3(x, -18.0, 11.5), dvec3(x, -18.0, 16.5), dvec3(x, -26.0, 16.5)], 1.5, 12);
    let header = pipe(&[dvec3(-18.0, -13.2, 18.0), dvec3(18.0, -13.2, 18.0)], 1.1, 12);
    vec![from_boiler(-12.0), from_boiler(12.0), header]
}

/// A brick chimney, 70 m high, on an octagonal foot.
pub(super) fn chimney() -> Vec<Solid> {
    let shaft = [
        (3.2, 6.0),
        (2.75, 28.0),
        (2.3, 50.0),
        (2.1, 66.0),
        (2.5, 67.0),
        (2.5, 69.0),
        (2.2, 70.0),
        (1.5, 70.0),
        (1.5, 6.0),
    ];
    vec![lathe(DVec3::ZERO, &[(4.6, 0.0), (4.6, 5.0), (3.8, 6.5)], 8), lathe_hoop(DVec3::ZERO, &shaft, 16)]
}

/// Two platforms with rails, and the ladder.
pub(super) fn chimney_steel() -> Vec<Solid> {
    let mut solids = Vec::new();
    for (z, radius) in [(34.0, 2.55), (62.0, 2.1)] {
        solids.push(lathe_hoop(
            DVec3::Z * z,
            &[(radius, 0.0), (radius + 1.2, 0.0), (radius + 1.2, 0.2), (radius, 0.2)],
            12,
        ));
        solids.push(lathe_hoop(
            DVec3::Z * z,
            &[(radius + 1.1, 1.2), (radius + 1.2, 1.2), (radius + 1.2, 1.3), (radius + 1.1, 1.3)],
            12,
        ));
        for post in circle(DVec3::Z * (z + 0.1), radius + 1.15, 6) {
            solids.push(strut(post, post + 1.15 * DVec3::Z, 0.08, 0.08));
        }
    }
    for side in [-0.3, 0.3] {
        solids.push(strut(dvec3(side, -3.7, 3.0), dvec3(side, -2.35, 66.0), 0.12, 0.12));
    }
    solids
}

const TANK_RADIUS: f64 = 12.0;
const TANK_HEIGHT: f64 = 13.0;

/// A shell on a low ring of concrete, with a shallow cone for its roof.
pub(super) fn tank() -> Vec<Solid> {
    let shell = [(TANK_RADIUS, 0.2), (TANK_RADIUS, TANK_HEIGHT), (4.0, TANK_HEIGHT + 1.2), (0.0, TANK_HEIGHT + 1.6)];
    vec![
        lathe(DVec3::ZERO, &shell, 24),
        lathe(DVec3::ZERO, &[(TANK_RADIUS + 0.6, 0.0), (TANK_RADIUS + 0.6, 0.4)], 24),
        lathe(dvec3(3.0, 0.0, TANK_HEIGHT), &[(0.5, 0.8), (0.5, 2.4), (0.8, 2.5), (0.0, 2.9)], 8),
    ]
}

/// The rail along the roof's edge, and the stair that winds up the shell.
pub(super) fn tank_steel() -> Vec<Solid> {
    let radius = TANK_RADIUS - 0.3;
    let rail = [(radius, 1.1), (radius + 0.12, 1.1), (radius + 0.12, 1.22), (radius, 1.22)];
    let mut solids = vec![lathe_hoop(DVec3::Z * TANK_HEIGHT, &rail, 24)];
    for post in circle(DVec3::Z * (TANK_HEIGHT - 0.2), radius + 0.06, 12) {
        solids.push(strut(post, post + 1.35 * DVec3::Z, 0.08, 0.08));
    }
    const STEPS: u32 = 16;
    for step in 0..STEPS {
        let share = f64::from(step + 1) / f64::from(STEPS);
        let out = on_circle(0.3 * share).extend(0.0);
        let foot = out * (TANK_RADIUS - 0.1) + DVec3::Z * (0.4 + (TANK_HEIGHT - 0.4) * share);
        solids.push(strut(foot, foot + out * 1.0, 0.7, 0.1));
        if step % 4 == 0 {
            solids.push(strut(foot + out * 0.95, foot + out * 0.95 + 1.1 * DVec3::Z, 0.08, 0.08));
        }
    }
    solids
}

/// Two rows of four silos with a house along their tops.
pub(super) fn silos() -> Vec<Solid> {
    let mut solids = Vec::new();
    for y in [0.0, 9.4] {
        for foot in row(4, dvec3(0.0, y, 0.0), 9.4 * DVec3::X) {
            solids.push(lathe(foot, &[(4.6, 0.0), (4.6, 24.0), (1.2, 26.0)], 16));
        }
    }
    solids.push(extrude(
        &[(-2.5, 25.5), (2.5, 25.5), (2.5, 29.0), (0.0, 30.2), (-2.5, 29.0)].map(|(y, z)| dvec2(y, z)),
        dvec3(-5.0, 4.7, 0.0),
        dvec3(33.5, 4.7, 0.0),
        DVec3::Y,
    ));
    solids.push(block([32.5, 0.5, 0.0], [39.5, 9.0, 34.0]));
    solids.push(block([32.1, 0.1, 34.0], [39.9, 9.4, 34.5]));
    solids
}

/// The covered belt that climbs to the silos' house from a pit in the east, on its trestles.
pub(super) fn conveyor() -> Vec<Solid> {
    let (pit, head) = (dvec3(98.0, 4.7, 2.0), dvec3(36.0, 4.7, 31.0));
    let mut solids = vec![strut(pit, head, 3.0, 2.6), block([94.0, 1.2, 0.0], [102.0, 8.2, 5.0])];
    for share in [0.25, 0.5, 0.75] {
        let top = pit + (head - pit) * share - 1.2 * DVec3::Z;
        // Not quite at the ground, as a leaning post's end reaches below its middle.
        let foot = |side: f64| dvec3(top.x, top.y + side * 2.4, 0.1);
        let shoulder = |side: f64| top + side * 1.2 * DVec3::Y;
        let at = |side: f64, height: f64| foot(side).lerp(shoulder(side), height);
        for side in [-1.0, 1.0] {
            solids.push(strut(foot(side), shoulder(side), 0.4, 0.4));
            solids.push(strut(at(side, 0.0), at(-side, 0.5), 0.2, 0.2));
            solids.push(strut(at(side, 0.5), at(-side, 1.0), 0.2, 0.2));
        }
        solids.push(strut(at(-1.0, 0.5), at(1.0, 0.5), 0.25, 0.25));
    }
    solids
}

/// One cell: a box on legs that lets air in below, and a fan's cylinder above.
pub(super) fn cooling_cell() -> Vec<Solid> {
    let stack = [(4.6, 9.8), (4.1, 11.0), (4.4, 13.5), (4.15, 13.5), (3.9, 11.0), (4.4, 9.8)];
    let mut solids = vec![
        on_foot(DVec3::ZERO, 6.4, 7.0, 0.9),
        block([-6.3, -6.8, 3.4], [6.3, 6.8, 10.0]),
        lathe_hoop(DVec3::ZERO, &stack, 24),
        strut(dvec3(-4.0, 0.0, 12.0), dvec3(4.0, 0.0, 12.0), 0.4, 0.2),
        strut(dvec3(0.0, -4.0, 12.1), dvec3(0.0, 4.0, 12.1), 0.4, 0.2),
    ];
    for y in [-6.4, 6.4] {
        solids.extend(row(3, dvec3(-5.8, y, 0.6), 5.8 * DVec3::X).map(|foot| on_foot(foot, 0.3, 0.3, 3.0)));
        solids.extend(row(2, dvec3(0.0, y * 1.08, 4.4), 2.6 * DVec3::Z).map(|foot| on_foot(foot, 6.0, 0.12, 0.5)));
    }
    solids
}

/// The line of the main bridge: from the boilers north, then east along the halls to the tanks.
const BRIDGE: [DVec3; 3] = [dvec3(-12.0, -37.0, 8.0), dvec3(-12.0, -6.0, 8.0), dvec3(104.0, -6.0, 8.0)];

/// Portals every 12 m, crossed below, with stringers from one to the next.
pub(super) fn trestles() -> Vec<Solid> {
    let mut solids = Vec::new();
    for leg in BRIDGE.windows(2) {
        let length = (leg[1] - leg[0]).length();
        let along = (leg[1] - leg[0]) / length;
        let across = DVec3::Z.cross(along);
        let count = (length / 12.0).floor() as u32;
        let step = length / f64::from(count);
        for index in 0..count {
            // Half a step in, so that the two legs leave their corner free.
            let middle = (leg[0] + (f64::from(index) + 0.5) * step * along).with_z(0.0);
            let at = |side: f64, z: f64| middle + side * 2.0 * across + z * DVec3::Z;
            for side in [-1.0, 1.0] {
                solids.push(strut(at(side, 0.0), at(side, 9.4), 0.35, 0.35));
                solids.push(strut(at(side, 0.4), at(-side, 5.0), 0.18, 0.18));
            }
            for z in [7.3, 9.2] {
                solids.push(strut(at(-1.2, z), at(1.2, z), 0.3, 0.35));
            }
        }
        for side in [-2.0, 2.0] {
            let shift = side * across;
            solids.push(strut(leg[0] + shift - 0.9 * DVec3::Z, leg[1] + shift - 0.9 * DVec3::Z, 0.25, 0.3));
        }
    }
    solids
}

/// Pipes on the two decks of the bridge, their ends in the ground, and branches to the halls.
pub(super) fn pipes() -> Vec<Solid> {
    let mut solids = Vec::new();
    for (offset, z, radius) in
        [(-1.3, 8.0, 0.45), (0.0, 7.9, 0.35), (1.2, 8.05, 0.5), (-0.8, 9.75, 0.3), (0.7, 9.85, 0.4)]
    {
        let [start, corner, end] = BRIDGE;
        let line = [
            dvec3(start.x - offset, start.y - 2.0, z),
            dvec3(corner.x - offset, corner.y + offset, z),
            dvec3(end.x + 4.0 + offset, end.y + offset, z),
            dvec3(end.x + 4.0 + offset, end.y + offset, 1.0),
            dvec3(end.x + 4.0 + offset, 18.0, 1.0),
        ];
        solids.push(pipe(&line, radius, 8));
    }
    for x in [14.0, 62.0] {
        let line =
            [dvec3(x, -6.5, 8.3), dvec3(x, -6.5, 11.2), dvec3(x, 1.0, 11.2), dvec3(x, 1.0, 5.5), dvec3(x, 10.0, 5.5)];
        solids.push(pipe(&line, 0.4, 8));
    }
    solids
}
