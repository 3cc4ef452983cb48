//! A works: saw-tooth and pitched halls, a boiler house with chimneys, tanks, silos, cooling cells, pipe bridges.
//!
//! Streets run north–south and east–west; the tall parts stand in the south, so that their shadows cross the halls.

use super::glb::{Model, Node};
use super::solids::{
    Solid, block, circle, extrude, lathe, lathe_hoop, loft, on_circle, pipe, prism, rect, rectangle, ring_wall, strut,
};
use glam::{DVec2, DVec3, dvec2, dvec3};

pub(super) fn model() -> Model {
    let mut model = Model::new();
    let wall = model.material("wall", [0.62, 0.5, 0.42, 1.0]);
    let roof = model.material("roof", [0.45, 0.46, 0.48, 1.0]);
    let steel = model.material("steel", [0.72, 0.74, 0.75, 1.0]);
    let frame = model.material("frame", [0.3, 0.38, 0.45, 1.0]);
    let brick = model.material("brick", [0.55, 0.26, 0.18, 1.0]);
    let paving = model.material("paving", [0.6, 0.6, 0.58, 1.0]);

    let works = model.mesh("saw-tooth-hall", vec![(wall, saw_tooth_walls()), (roof, saw_tooth_roof())]);
    let store = model.mesh("pitched-hall", vec![(wall, pitched_walls()), (roof, pitched_roof())]);
    let boilers = model.mesh("boiler-house", vec![(wall, boiler_house()), (steel, flues())]);
    let chimney = model.mesh("chimney", vec![(brick, chimney()), (frame, chimney_steel())]);
    let tank = model.mesh("tank", vec![(steel, tank()), (frame, tank_steel())]);
    let silos = model.mesh("silos", vec![(steel, silos()), (frame, conveyor())]);
    let cell = model.mesh("cooling-cell", vec![(frame, cooling_cell())]);
    let bridge = model.mesh("pipe-bridge", vec![(frame, trestles()), (steel, pipes())]);
    let office = model.mesh("office", vec![(wall, office()), (roof, office_roof())]);
    let yard = model.mesh("yard", vec![(paving, yard())]);

    let tanks = [(0.0, 0.0), (32.0, 0.0), (0.0, 32.0), (32.0, 32.0)];
    let tank_farm = tanks.iter().enumerate().map(|(index, &(x, y))| {
        // Each turned otherwise, as stairs are where the paths are.
        Node::showing(&format!("tank-{}", index + 1), tank).at(x, y, 0.0).turned(index as u32)
    });
    let cells = (0..3).map(|index| {
        Node::showing(&format!("cooling-cell-{}", index + 1), cell).at(13.0 * f64::from(index), 0.0, 0.0)
    });
    model.nodes = vec![
        Node::group(
            "works",
            vec![
                Node::showing("hall-west", works).at(-62.0, 42.0, 0.0),
                Node::showing("hall-east", works).at(38.0, 42.0, 0.0).mirrored(),
                Node::showing("store", store).at(-88.0, -50.0, 0.0),
                Node::group(
                    "power-house",
                    vec![
                        Node::showing("boiler-house", boilers),
                        Node::showing("chimney-west", chimney).at(-12.0, -26.0, 0.0),
                        Node::showing("chimney-east", chimney).at(12.0, -26.0, 0.0).turned(2),
                    ],
                )
                .at(-12.0, -52.0, 0.0),
                Node::group("tank-farm", tank_farm.collect()).at(108.0, 30.0, 0.0),
                Node::showing("silos", silos).at(42.0, -62.0, 0.0),
                Node::group("cooling", cells.collect()).at(104.0, 92.0, 0.0),
                Node::showing("pipe-bridge", bridge),
                Node::showing("office", office).at(-126.0, 42.0, 0.0).turned(1),
            ],
        ),
        Node::showing("yard", yard),
    ];
    model
}

/// A row of equal things.
fn row(count: u32, from: DVec3, step: DVec3) -> impl Iterator<Item = DVec3> {
    (0..count).map(move |index| from + f64::from(index) * step)
}

/// A box on its foot: half its size in plan, and its height.
fn on_foot(foot: DVec3, half_x: f64, half_y: f64, height: f64) -> Solid {
    loft(&[0.0, height].map(|z| rectangle(foot + z * DVec3::Z, dvec2(half_x, half_y))))
}

const TEETH: u32 = 6;
const TOOTH: f64 = 11.0;
const HALL_HALF: f64 = 36.0;

/// Walls of 72 m by 66 m, with piers outside, gates in the south and an annex in the west.
fn saw_tooth_walls() -> Vec<Solid> {
    let half_depth = f64::from(TEETH) * TOOTH / 2.0;
    let mut solids = vec![
        block([-HALL_HALF, -half_depth, 0.0], [HALL_HALF, half_depth, 8.0]),
        block([-HALL_HALF - 9.0, -18.0, 0.0], [-HALL_HALF + 0.5, 14.0, 5.0]),
        block([-HALL_HALF - 6.0, 14.5, 0.0], [-HALL_HALF + 0.5, 24.0, 3.5]),
    ];
    for side in [-1.0, 1.0] {
        let first = dvec3(side * HALL_HALF, -half_depth + TOOTH / 2.0, 0.0);
        solids.extend(row(TEETH, first, TOOTH * DVec3::Y).map(|foot| on_foot(foot, 0.4, 0.5, 7.8)));
        let first = dvec3(-30.0, side * half_depth, 0.0);
        solids.extend(row(6, first, 12.0 * DVec3::X).map(|foot| on_foot(foot, 0.5, 0.4, 7.6)));
    }
    // Canopies over the gates.
    solids.extend(row(3, dvec3(-18.0, -half_depth - 1.5, 4.6), 18.0 * DVec3::X).map(|foot| on_foot(foot, 3.2, 2.0, 0.4)));
    solids
}

/// Teeth whose glass looks north, away from the sun, with bars on the glass and a vent on every second slope.
fn saw_tooth_roof() -> Vec<Solid> {
    let half_depth = f64::from(TEETH) * TOOTH / 2.0;
    let mut solids = Vec::new();
    for tooth in 0..TEETH {
        let south = -half_depth + f64::from(tooth) * TOOTH;
        let (low, high) = (7.75, 13.0);
        // The eaves stand out a little, and the teeth overlap in the gutter between them.
        let profile = [(-0.2, low), (TOOTH - 0.1, low), (TOOTH - 0.1, 8.6), (TOOTH - 0.9, high), (TOOTH - 1.4, high), (-0.2, 8.2)]
            .map(|(y, z)| dvec2(y, z));
        let end = |x: f64| dvec3(x, south, 0.0);
        solids.push(extrude(&profile, end(-HALL_HALF - 0.4), end(HALL_HALF + 0.4), DVec3::Y));
        let (sill, head) = (dvec3(-33.0, south + TOOTH - 0.15, 8.5), dvec3(-33.0, south + TOOTH - 0.85, 12.9));
        solids.extend((0..8).map(|bar| {
            let across = f64::from(bar) * 9.4 * DVec3::X;
            strut(sill + across, head + across, 0.25, 0.3)
        }));
        let ridge_vent = dvec3(-24.0, south + 6.5, 10.0);
        if tooth % 2 == 0 {
            for foot in row(4, ridge_vent, 16.0 * DVec3::X) {
                solids.push(lathe(foot, &[(0.7, 0.0), (0.7, 2.4), (1.2, 2.6), (0.0, 3.3)], 6));
            }
        }
    }
    solids
}

const BAYS: u32 = 3;
const BAY: f64 = 16.0;

/// Three bays of 16 m by 60 m under one row of gables, with buttresses and a loading dock.
fn pitched_walls() -> Vec<Solid> {
    let half_width = f64::from(BAYS) * BAY / 2.0;
    let mut gables = vec![dvec2(-half_width, 0.0), dvec2(half_width, 0.0)];
    for bay in (0..BAYS).rev() {
        let west = -half_width + f64::from(bay) * BAY;
        gables.extend([dvec2(west + BAY, 7.0), dvec2(west + BAY / 2.0, 12.0)]);
    }
    gables.push(dvec2(-half_width, 7.0));
    let mut solids = vec![
        extrude(&gables, dvec3(0.0, -30.0, 0.0), dvec3(0.0, 30.0, 0.0), DVec3::X),
        block([-18.0, 29.5, 0.0], [18.0, 33.5, 1.2]),
        block([-18.0, 29.5, 4.8], [18.0, 34.5, 5.2]),
    ];
    for side in [-1.0, 1.0] {
        solids.extend(row(9, dvec3(side * half_width, -26.0, 0.0), 6.5 * DVec3::Y).map(|foot| on_foot(foot, 0.5, 0.4, 6.6)));
    }
    solids
}

/// Roof sheets over each bay, a lantern along each ridge, and the lanterns' posts.
fn pitched_roof() -> Vec<Solid> {
    let half_width = f64::from(BAYS) * BAY / 2.0;
    let mut solids = Vec::new();
    for bay in 0..BAYS {
        let middle = -half_width + (f64::from(bay) + 0.5) * BAY;
        let sheet = [(-8.4, 6.9), (0.0, 12.15), (8.4, 6.9), (8.4, 7.2), (0.0, 12.5), (-8.4, 7.2)].map(|(x, z)| dvec2(x, z));
        let lantern = [(-1.7, 13.2), (1.7, 13.2), (1.7, 13.5), (0.0, 14.5), (-1.7, 13.5)].map(|(x, z)| dvec2(x, z));
        let end = |y: f64| dvec3(middle, y, 0.0);
        solids.push(extrude(&sheet, end(-30.6 - 0.1 * f64::from(bay)), end(30.6 + 0.1 * f64::from(bay)), DVec3::X));
        solids.push(extrude(&lantern, end(-24.0), end(24.0), DVec3::X));
        for side in [-1.3, 1.3] {
            solids.extend(row(5, dvec3(middle + side, -23.0, 11.0), 11.5 * DVec3::Y).map(|foot| on_foot(foot, 0.15, 0.15, 2.3)));
        }
    }
    solids
}

/// A tall block, stepped towards the chimneys, with ribs and a stair tower.
fn boiler_house() -> Vec<Solid> {
    let mut solids = vec![
        block([-22.0, -12.0, 0.0], [22.0, 14.0, 24.0]),
        block([-22.5, -4.0, 23.5], [18.0, 12.0, 31.0]),
        block([-16.0, -20.0, 0.0], [16.0, -11.5, 13.0]),
        block([18.5, 4.0, 0.0], [25.0, 11.0, 34.0]),
        // The parapet.
        ring_wall(&rect([-22.2, -12.2], [22.2, 14.2]), &rect([-21.6, -11.6], [21.6, 13.6]), 23.8, 25.0),
    ];
    for side in [-12.0, 14.0] {
        solids.extend(row(7, dvec3(-19.5, side, 0.0), 6.0 * DVec3::X).map(|foot| on_foot(foot, 0.4, 0.5, 23.4)));
    }
    for foot in row(4, dvec3(-17.0, 4.0, 30.75), 10.0 * DVec3::X) {
        solids.push(lathe(foot, &[(1.3, 0.0), (1.3, 2.2), (2.0, 2.4), (2.0, 3.2), (0.0, 4.0)], 12));
    }
    solids
}

/// From the boilers to the chimneys.
fn flues() -> Vec<Solid> {
    let from_boiler = |x: f64| pipe(&[dvec3(x, -18.0, 11.5), dvec3(x, -18.0, 16.5), dvec3(x, -26.0, 16.5)], 1.5, 12);
    let header = pipe(&[dvec3(-18.0, -13.2, 18.0), dvec3(18.0, -13.2, 18.0)], 1.1, 12);
    vec![from_boiler(-12.0), from_boiler(12.0), header]
}

/// A brick chimney, 70 m high, on an octagonal foot.
fn chimney() -> Vec<Solid> {
    let shaft = [(3.2, 6.0), (2.75, 28.0), (2.3, 50.0), (2.1, 66.0), (2.5, 67.0), (2.5, 69.0), (2.2, 70.0), (1.5, 70.0), (1.5, 6.0)];
    vec![
        lathe(DVec3::ZERO, &[(4.6, 0.0), (4.6, 5.0), (3.8, 6.5)], 8),
        lathe_hoop(DVec3::ZERO, &shaft, 16),
    ]
}

/// Two platforms with rails, and the ladder.
fn chimney_steel() -> Vec<Solid> {
    let mut solids = Vec::new();
    for (z, radius) in [(34.0, 2.55), (62.0, 2.1)] {
        solids.push(lathe_hoop(DVec3::Z * z, &[(radius, 0.0), (radius + 1.2, 0.0), (radius + 1.2, 0.2), (radius, 0.2)], 12));
        solids.push(lathe_hoop(DVec3::Z * z, &[(radius + 1.1, 1.2), (radius + 1.2, 1.2), (radius + 1.2, 1.3), (radius + 1.1, 1.3)], 12));
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
fn tank() -> Vec<Solid> {
    let shell = [(TANK_RADIUS, 0.2), (TANK_RADIUS, TANK_HEIGHT), (4.0, TANK_HEIGHT + 1.2), (0.0, TANK_HEIGHT + 1.6)];
    vec![
        lathe(DVec3::ZERO, &shell, 24),
        lathe(DVec3::ZERO, &[(TANK_RADIUS + 0.6, 0.0), (TANK_RADIUS + 0.6, 0.4)], 24),
        lathe(dvec3(3.0, 0.0, TANK_HEIGHT), &[(0.5, 0.8), (0.5, 2.4), (0.8, 2.5), (0.0, 2.9)], 8),
    ]
}

/// The rail along the roof's edge, and the stair that winds up the shell.
fn tank_steel() -> Vec<Solid> {
    let radius = TANK_RADIUS - 0.3;
    let rail = [(radius, 1.1), (radius + 0.12, 1.1), (radius + 0.12, 1.22), (radius, 1.22)];
    let mut solids = vec![lathe_hoop(DVec3::Z * TANK_HEIGHT, &rail, 24)];
    for post in circle(DVec3::Z * (TANK_HEIGHT - 0.2), radius + 0.06, 12) {
        solids.push(strut(post, post + 1.35 * DVec3::Z, 0.08, 0.08));
    }
    const STEPS: u32 = 20;
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
fn silos() -> Vec<Solid> {
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
fn conveyor() -> Vec<Solid> {
    let (pit, head) = (dvec3(98.0, 4.7, 2.0), dvec3(36.0, 4.7, 31.0));
    let mut solids = vec![strut(pit, head, 3.0, 2.6), block([94.0, 1.2, 0.0], [102.0, 8.2, 5.0])];
    for share in [0.25, 0.5, 0.75] {
        let top = pit + (head - pit) * share - 1.2 * DVec3::Z;
        let foot = |side: f64| dvec3(top.x, top.y + side * 2.4, 0.0);
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
fn cooling_cell() -> Vec<Solid> {
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
fn trestles() -> Vec<Solid> {
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
fn pipes() -> Vec<Solid> {
    let mut solids = Vec::new();
    for (offset, z, radius) in [(-1.3, 8.0, 0.45), (0.0, 7.9, 0.35), (1.2, 8.05, 0.5), (-0.8, 9.75, 0.3), (0.7, 9.85, 0.4)] {
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
        let line = [dvec3(x, -6.5, 8.3), dvec3(x, -6.5, 11.2), dvec3(x, 1.0, 11.2), dvec3(x, 1.0, 5.5), dvec3(x, 10.0, 5.5)];
        solids.push(pipe(&line, 0.4, 8));
    }
    solids
}

/// Three storeys with bands of windows between piers.
fn office() -> Vec<Solid> {
    let mut solids = vec![block([-20.0, -6.5, 0.0], [20.0, 6.5, 10.6]), block([-4.0, -9.5, 0.0], [4.0, -6.0, 4.0])];
    for side in [-6.5, 6.5] {
        solids.extend(row(11, dvec3(-19.0, side, 0.0), 3.8 * DVec3::X).map(|foot| on_foot(foot, 0.25, 0.3, 10.2)));
    }
    solids
}

fn office_roof() -> Vec<Solid> {
    vec![
        block([-20.8, -7.3, 10.6], [20.8, 7.3, 11.0]),
        block([-4.5, -10.0, 3.9], [4.5, -6.2, 4.2]),
        block([-6.0, -2.5, 10.9], [2.0, 2.5, 13.4]),
        block([8.0, -2.0, 10.9], [12.0, 2.0, 12.4]),
    ]
}

/// The works street and the yard by the gate, just above the ground, and a kerb's triangle that parts its lanes.
fn yard() -> Vec<Solid> {
    let lane = [(-160.0, -14.0), (100.0, -14.0), (100.0, 2.0), (-112.0, 2.0), (-112.0, 100.0), (-160.0, 100.0)];
    let island = [(-152.0, 8.0), (-144.0, 8.0), (-152.0, 24.0)];
    let polygon = |points: &[(f64, f64)]| points.iter().map(|&(x, y)| dvec2(x, y)).collect::<Vec<_>>();
    vec![prism(&polygon(&lane), 0.0, 0.15), prism(&polygon(&island), 0.1, 0.3)]
}
