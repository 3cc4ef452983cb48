//! The headquarters' neighbours: blocks of houses around courtyards, a church, bars of flats, a point block.

use super::glb::{Material, Model, Node};
use super::houses::{Buildings, perimeter_block};
use super::shapes::{block, extrude, lathe, prism, rect, rectangle, ring_wall};
use super::solids::loft;
use glam::{DVec2, DVec3, dvec2, dvec3};

/// The blocks around the plot, which measures 160 m by 142 m; streets are 18 m wide.
pub(super) fn nodes(model: &mut Model, walls: Material, tiles: Material, flat_roof: Material) -> Vec<Node> {
    let mut mesh = |name: &str, buildings: Buildings, roof: Material| {
        model.mesh(name, vec![(walls, buildings.walls), (roof, buildings.roofs)])
    };
    let wide = mesh("wide-block", perimeter_block(80.0, 62.0, 5), tiles);
    let tall = mesh("tall-block", perimeter_block(80.0, 62.0, 11), tiles);
    let narrow = mesh("narrow-block", perimeter_block(71.0, 62.0, 23), tiles);
    let church = mesh("church-square", church_square(), tiles);
    let flats = mesh("flats", flats(), flat_roof);
    let point = mesh("point-block", point_block(), flat_roof);
    vec![
        Node::showing("block-north-west", wide).at(-138.0, 126.0, 0.0),
        Node::showing("block-west", tall).at(-138.0, 46.0, 0.0),
        Node::showing("church-square", church).at(-138.0, -34.0, 0.0),
        Node::showing("block-south-west", wide).at(-138.0, -114.0, 0.0).turned(2),
        Node::showing("block-north-1", narrow).at(-44.5, 126.0, 0.0),
        Node::showing("block-north-2", narrow).at(44.5, 126.0, 0.0).mirrored(),
        Node::showing("block-south-1", narrow).at(-44.5, -114.0, 0.0).turned(2),
        Node::showing("point-block", point).at(44.5, -114.0, 0.0),
        Node::showing("block-north-east", tall).at(138.0, 126.0, 0.0).mirrored(),
        Node::showing("flats-north", flats).at(138.0, 46.0, 0.0).turned(1),
        Node::showing("block-east", wide).at(138.0, -34.0, 0.0).mirrored(),
        Node::showing("flats-south", flats).at(138.0, -114.0, 0.0).turned(3),
    ]
}

/// A church with a tower in the west and an apse in the east, on an open square with a parsonage.
fn church_square() -> Buildings {
    let mut square = Buildings::default();
    let gable = |half: f64, eaves: f64, ridge: f64| {
        [(-half, eaves - 0.3), (half, eaves - 0.3), (half, eaves), (0.0, ridge), (-half, eaves)]
            .map(|(y, z)| dvec2(y, z))
    };
    let end = |x: f64| dvec3(x, 0.0, 0.0);
    square.walls.extend([
        block([-20.0, -7.0, 0.0], [18.0, 7.0, 16.0]),
        block([-18.0, -12.0, 0.0], [14.0, 12.0, 8.0]),
        block([4.0, -14.0, 0.0], [13.0, 14.0, 14.0]),
        block([-28.0, -4.5, 0.0], [-19.0, 4.5, 32.0]),
        lathe(dvec3(18.0, 0.0, 0.0), &[(6.2, 0.0), (6.2, 14.0)], 16),
    ]);
    square.roofs.extend([
        extrude(&gable(7.6, 16.0, 24.0), end(-19.5), end(18.4), DVec3::Y),
        extrude(&gable(5.0, 14.0, 22.0), dvec3(8.5, -14.5, 0.0), dvec3(8.5, 14.5, 0.0), DVec3::X),
        lathe(dvec3(18.0, 0.0, 13.9), &[(6.6, 0.0), (6.6, 0.2), (0.0, 6.5)], 16),
        loft(
            &[(4.9, 31.8), (4.9, 32.2), (2.6, 38.0), (0.0, 56.0)]
                .map(|(half, z)| rectangle(dvec3(-23.5, 0.0, z), DVec2::splat(half))),
        ),
    ]);
    for side in [-1.0, 1.0] {
        // The aisles' roofs lean against the nave; buttresses stand between their windows.
        let aisle = [(6.5, 7.8), (12.5, 7.8), (12.5, 8.0), (6.5, 11.5)].map(|(y, z)| dvec2(side * y, z));
        square.roofs.push(extrude(&aisle, end(-18.5), end(14.5), DVec3::Y));
        for buttress in 0..6 {
            let x = -16.0 + 5.5 * f64::from(buttress);
            let profile = [(11.5, 0.0), (14.0, 0.0), (13.4, 5.0), (11.5, 7.0)].map(|(y, z)| dvec2(side * y, z));
            square.walls.push(extrude(&profile, end(x - 0.5), end(x + 0.5), DVec3::Y));
        }
    }
    // The parsonage.
    square.walls.push(block([22.0, -27.0, 0.0], [36.0, -17.0, 7.0]));
    let eaves = |half: DVec2, z: f64| rectangle(dvec3(29.0, -22.0, z), half);
    square.roofs.push(loft(&[eaves(dvec2(7.6, 5.6), 6.9), eaves(dvec2(7.6, 5.6), 7.1), eaves(dvec2(2.5, 0.0), 11.5)]));
    square
}

/// Three bars of flats with flat roofs, balconies to the west, and set-back top storeys.
fn flats() -> Buildings {
    let mut group = Buildings::default();
    for (bar, storeys) in [(-24.0, 6), (0.0, 7), (24.0, 5)] {
        let height = 1.0 + 3.0 * f64::from(storeys);
        let (south, north) = (-34.0, 34.0);
        group.walls.push(block([bar - 5.5, south, 0.0], [bar + 5.5, north, height]));
        group.walls.push(block([bar - 3.5, south + 4.0, height - 0.1], [bar + 4.5, north - 10.0, height + 3.0]));
        group.roofs.push(block([bar - 4.0, south + 3.5, height + 2.9], [bar + 5.0, north - 9.5, height + 3.25]));
        group.roofs.push(ring_wall(
            &rect([bar - 5.7, south - 0.2], [bar + 5.7, north + 0.2]),
            &rect([bar - 5.2, south + 0.3], [bar + 5.2, north - 0.3]),
            height - 0.3,
            height + 0.6,
        ));
        for storey in 1..storeys {
            for flat in 0..6 {
                let y = south + 6.0 + 11.2 * f64::from(flat);
                let z = 1.0 + 3.0 * f64::from(storey);
                group.walls.push(block([bar - 7.1, y - 2.4, z - 0.2], [bar - 5.3, y + 2.4, z]));
                group.walls.push(block([bar - 7.1, y - 2.4, z - 0.1], [bar - 7.0, y + 2.4, z + 1.0]));
            }
        }
        for stair in [-20.0, 2.0] {
            group.roofs.push(block([bar - 1.5, stair - 2.0, height + 3.0], [bar + 1.5, stair + 2.0, height + 4.8]));
        }
    }
    group
}

/// A point block on a low base with a roof garden.
fn point_block() -> Buildings {
    let mut group = Buildings::default();
    group.walls.push(block([-33.0, -28.0, 0.0], [33.0, 28.0, 5.0]));
    group.roofs.push(ring_wall(&rect([-33.3, -28.3], [33.3, 28.3]), &rect([-32.6, -27.6], [32.6, 27.6]), 4.7, 6.0));
    let plan =
        |half: f64| rect([-half, -half], [half, half]).iter().map(|p| *p + dvec2(-12.0, -6.0)).collect::<Vec<_>>();
    group.walls.push(prism(&plan(11.0), 4.9, 46.0));
    for storey in 0..13 {
        let z = 8.0 + 3.0 * f64::from(storey);
        group.walls.push(ring_wall(&plan(12.2), &plan(10.9), z - 0.2, z));
        group.walls.push(ring_wall(&plan(12.2), &plan(12.05), z - 0.1, z + 1.0));
    }
    group.roofs.push(prism(&plan(11.6), 45.9, 46.5));
    group.roofs.push(prism(&plan(5.0), 46.4, 49.5));
    for x in [8.0, 16.0, 24.0] {
        group.roofs.push(block([x, -18.0, 4.9], [x + 4.5, 18.0, 5.6]));
    }
    group
}
