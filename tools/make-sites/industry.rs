//! A works: saw-tooth and pitched halls, a boiler house with chimneys, tanks, silos, cooling cells, pipe bridges.
//!
//! Streets run north–south and east–west; the tall parts stand in the south, so that their shadows cross the halls.

use super::glb::{Model, Node};
use super::plant;
use super::shapes::{block, extrude, lathe, on_foot, prism, rect, ring_wall, row, strut};
use super::solids::Solid;
use glam::{DVec3, dvec2, dvec3};

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
    let boilers = model.mesh("boiler-house", vec![(wall, boiler_house()), (steel, plant::flues())]);
    let chimney = model.mesh("chimney", vec![(brick, plant::chimney()), (frame, plant::chimney_steel())]);
    let tank = model.mesh("tank", vec![(steel, plant::tank()), (frame, plant::tank_steel())]);
    let silos = model.mesh("silos", vec![(steel, plant::silos()), (frame, plant::conveyor())]);
    let cell = model.mesh("cooling-cell", vec![(frame, plant::cooling_cell())]);
    let bridge = model.mesh("pipe-bridge", vec![(frame, plant::trestles()), (steel, plant::pipes())]);
    let office = model.mesh("office", vec![(wall, office()), (roof, office_roof())]);
    let yard = model.mesh("yard", vec![(paving, yard())]);

    let tanks = [(0.0, 0.0), (32.0, 0.0), (0.0, 32.0), (32.0, 32.0)];
    let tank_farm = tanks.iter().enumerate().map(|(index, &(x, y))| {
        // Each turned otherwise, as stairs are where the paths are.
        Node::showing(&format!("tank-{}", index + 1), tank).at(x, y, 0.0).turned(index as u32)
    });
    let cells = (0..3)
        .map(|index| Node::showing(&format!("cooling-cell-{}", index + 1), cell).at(13.0 * f64::from(index), 0.0, 0.0));
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
    solids
        .extend(row(3, dvec3(-18.0, -half_depth - 1.5, 4.6), 18.0 * DVec3::X).map(|foot| on_foot(foot, 3.2, 2.0, 0.4)));
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
        let profile = [
            (-0.2, low),
            (TOOTH - 0.1, low),
            (TOOTH - 0.1, 8.6),
            (TOOTH - 0.9, high),
            (TOOTH - 1.4, high),
            (-0.2, 8.2),
        ]
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
            for foot in row(3, ridge_vent, 22.0 * DVec3::X) {
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
        solids.extend(
            row(9, dvec3(side * half_width, -26.0, 0.0), 6.5 * DVec3::Y).map(|foot| on_foot(foot, 0.5, 0.4, 6.6)),
        );
    }
    solids
}

/// Roof sheets over each bay, a lantern along each ridge, and the lanterns' posts.
fn pitched_roof() -> Vec<Solid> {
    let half_width = f64::from(BAYS) * BAY / 2.0;
    let mut solids = Vec::new();
    for bay in 0..BAYS {
        let middle = -half_width + (f64::from(bay) + 0.5) * BAY;
        let sheet =
            [(-8.4, 6.9), (0.0, 12.15), (8.4, 6.9), (8.4, 7.2), (0.0, 12.5), (-8.4, 7.2)].map(|(x, z)| dvec2(x, z));
        let lantern = [(-1.7, 13.2), (1.7, 13.2), (1.7, 13.5), (0.0, 14.5), (-1.7, 13.5)].map(|(x, z)| dvec2(x, z));
        let end = |y: f64| dvec3(middle, y, 0.0);
        solids.push(extrude(&sheet, end(-30.6 - 0.1 * f64::from(bay)), end(30.6 + 0.1 * f64::from(bay)), DVec3::X));
        solids.push(extrude(&lantern, end(-24.0), end(24.0), DVec3::X));
        for side in [-1.3, 1.3] {
            solids.extend(
                row(5, dvec3(middle + side, -23.0, 11.0), 11.5 * DVec3::Y).map(|foot| on_foot(foot, 0.15, 0.15, 2.3)),
            );
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
