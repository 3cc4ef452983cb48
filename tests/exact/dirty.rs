//! Meshes with each kind of defect: the stencil equals ray casting on the plan, on receivers and in pictures.

use super::{agree, masks};
use crate::shared::drawing::{scene_of, to_sun};
use crate::shared::scenes::{cuboid, joined, sheet, small};
use glam::{DVec3, dvec3};
use gnomon::choice::Receivers;
use gnomon::mesh::{Mesh, Part};
use gnomon::shadow::Scene;
use gnomon::verification::Difference;
use gnomon::view::{Camera, View};
use proptest::prelude::*;

fn turned(mut part: Part) -> Part {
    part.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    part
}

/// A box around (0, 0) that stands on no round numbers.
fn house(low: f64, high: f64) -> Part {
    cuboid("house", dvec3(-5.23, -4.11, low), dvec3(4.37, 6.41, high))
}

/// A box of four walls whose lid is turned by a half: two opposite walls cross each other.
fn twisted() -> Part {
    let mut part = house(0.0, 9.1);
    part.positions.swap(4, 5);
    part
}

/// The tetrahemihexahedron: every edge has two faces, and no winding is right for all of them.
fn one_sided() -> Part {
    let at = |x: f64, y: f64, z: f64| dvec3(x * 7.1 + 0.13, y * 6.3, z * 6.7 + 8.2);
    let positions = vec![
        at(1.0, 0.0, 0.0),
        at(-1.0, 0.0, 0.0),
        at(0.0, 1.0, 0.0),
        at(0.0, -1.0, 0.0),
        at(0.0, 0.0, 1.0),
        at(0.0, 0.0, -1.0),
    ];
    let triangles = vec![
        [0, 2, 4],
        [1, 3, 4],
        [0, 3, 5],
        [1, 2, 5],
        [0, 2, 1],
        [0, 1, 3],
        [0, 4, 1],
        [0, 1, 5],
        [2, 4, 3],
        [2, 3, 5],
    ];
    Part { name: "one-sided".into(), positions, triangles, ..Part::default() }
}

/// A pyramid whose base lies `depth` below the ground.
fn pyramid(depth: f64) -> Part {
    let base = [(-7.3, -6.1), (6.9, -6.4), (7.2, 5.8), (-6.6, 7.1)];
    let mut positions: Vec<DVec3> = base.map(|(x, y)| dvec3(x, y, -depth)).to_vec();
    positions.push(dvec3(0.31, 0.17, 9.4));
    let triangles = vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [0, 2, 1], [0, 3, 2]];
    Part { name: "pyramid".into(), positions, triangles, ..Part::default() }
}

/// Named scenes of several components.
pub(crate) fn dirty() -> Vec<(&'static str, Vec<Part>)> {
    let mut open = house(0.0, 9.3);
    open.triangles.drain(2..4); // the lid
    let mut sideless = house(0.0, 9.3);
    sideless.triangles.drain(8..10);
    let mut all_double = house(1.0, 9.3);
    all_double.triangles.extend(turned(house(1.0, 9.3)).triangles);
    // the lid has a corner in the middle of a side that the wall below has not
    let mut t_junction = house(0.0, 9.3);
    t_junction.positions.push(t_junction.positions[4].lerp(t_junction.positions[5], 0.37));
    t_junction.triangles.splice(2..4, [[4, 8, 6], [8, 7, 6], [8, 5, 7]]);
    // triangles without area along edges, and of one point
    let mut degenerate = t_junction.clone();
    degenerate.triangles.extend([[4, 5, 8], [4, 8, 4], [0, 1, 0], [8, 5, 4]]);
    let mut hole = house(0.0, 9.3);
    hole.triangles.remove(2);
    let apart = |gap: f64| cuboid("neighbour", dvec3(4.37 + gap, -4.11, 0.0), dvec3(11.0, 6.41, 6.2));
    let plate = |z: f64| sheet([dvec3(-6.1, -5.3, z), dvec3(6.2, -5.3, z), dvec3(6.2, 5.1, z), dvec3(-6.1, 5.1, z)]);
    vec![
        ("without a lid", vec![open]),
        ("without a side", vec![sideless]),
        ("with half a lid", vec![hole]),
        ("all faces twice, both ways", vec![all_double]),
        ("T-junction", vec![t_junction]),
        ("without area", vec![degenerate]),
        ("the same solid twice", vec![house(0.0, 9.3), house(0.0, 9.3)]),
        ("the same solid inside out", vec![house(0.0, 9.3), turned(house(0.0, 9.3))]),
        ("inside out", vec![turned(house(0.0, 9.3))]),
        (
            "a hollow",
            vec![joined(vec![house(0.0, 12.0), turned(cuboid("in", dvec3(-3.1, -2.2, 2.0), dvec3(2.3, 4.1, 9.0)))])],
        ),
        (
            "a solid in a solid",
            vec![joined(vec![house(0.0, 12.0), cuboid("in", dvec3(-3.1, -2.2, 2.0), dvec3(2.3, 4.1, 15.0))])],
        ),
        ("twisted", vec![twisted()]),
        ("one-sided", vec![one_sided()]),
        ("a solid and a sheet", vec![joined(vec![house(0.0, 7.0), plate(8.3)])]),
        (
            "touching along an edge",
            vec![joined(vec![house(0.0, 7.0), cuboid("b", dvec3(4.37, 6.41, 0.0), dvec3(9.1, 10.3, 7.0))])],
        ),
        ("a thin gap", vec![house(0.0, 9.3), apart(0.0006)]),
        ("no gap", vec![house(0.0, 9.3), apart(0.0)]),
        ("plates nearly on each other", vec![plate(6.0), plate(6.0004), plate(6.0), turned(plate(6.0009))]),
        ("sunk", vec![pyramid(3.7)]),
        (
            "sunk and open",
            vec![{
                let mut part = pyramid(3.7);
                part.triangles.truncate(3);
                part
            }],
        ),
        ("a millimetre into the ground", vec![pyramid(0.001), apart(1.0)]),
        ("nearly sunk", vec![house(-5.0, 0.0015), pyramid(0.0)]),
    ]
}

fn day() -> Vec<DVec3> {
    [(95.3, 4.1), (171.2, 51.9), (231.6, 21.8)].map(|(azimuth, altitude)| to_sun(azimuth, altitude)).to_vec()
}

/// Outside, above, within the solids and close to a wall.
fn cameras() -> Vec<Camera> {
    let camera = |eye, target| Camera { eye, target, up: DVec3::Z, fov_rad: 1.1, width: 104, height: 78 };
    vec![
        camera(dvec3(17.1, -19.3, 11.2), dvec3(0.0, 0.0, 3.0)),
        camera(dvec3(-9.4, 13.2, 21.7), dvec3(1.0, 1.0, 2.0)),
        camera(dvec3(0.4, 0.7, 4.9), dvec3(3.0, 5.0, 1.0)),
        camera(dvec3(-6.1, -7.2, 1.3), dvec3(4.0, 3.0, 4.0)),
    ]
}

#[test]
fn dirty_meshes_agree_with_ray_casting() {
    for (name, parts) in dirty() {
        let mesh = Mesh::build(parts).unwrap();
        for receivers in [Receivers::Ground, Receivers::Top] {
            agree(
                &format!("{name} {receivers:?}"),
                &scene_of(&mesh, receivers, 0.0),
                super::plan(40.371_93, 350),
                &day(),
                0.01,
            );
        }
    }
}

#[test]
fn pictures_of_dirty_meshes_agree_with_ray_casting() {
    for (name, parts) in dirty().into_iter().chain(small()) {
        let mesh = Mesh::build(parts).unwrap();
        let whole = scene_of(&mesh, Receivers::Top, 0.0);
        // casters that are not all seen: then the light cap is drawn, and no wall is saved
        let keep: Vec<bool> = (0..mesh.components.len()).map(|component| component > 0).collect();
        let partly = Scene { receivers: mesh.of_components(&keep), ..whole.clone() };
        for (scene, every) in [(whole, 1), (partly, 2)] {
            let mut total = Difference::default();
            for camera in cameras().into_iter().step_by(every) {
                for (_, _, difference) in masks(&scene, View::Camera(camera), &day()[..2]) {
                    assert!(difference.holds(0.05), "{name} from {}: {difference}", camera.eye);
                    total.add(difference);
                }
            }
            assert!(total.edge_share() <= 0.01, "{name}: {total}");
        }
    }
}

#[test]
fn slopes_that_hardly_come_out_of_the_ground_stay_in_it() {
    let mut drawn_dark = 0;
    for (height, depth, out) in [(0.006, 8.0, 6.0), (0.01, 8.0, 3.0), (0.3, 8.0, 3.0)] {
        let base = [(-out, -out), (out, -out), (out, out), (-out, out)];
        let mut part = pyramid(depth);
        part.positions = base.iter().map(|&(x, y)| dvec3(x, y, -depth)).chain([dvec3(0.0, 0.0, height)]).collect();
        let mesh = Mesh::build(vec![part]).unwrap();
        for (azimuth, altitude) in [(180.0, 0.2), (190.0, 0.5), (230.0, 3.0)] {
            let suns = [to_sun(azimuth, altitude)];
            let scene = scene_of(&mesh, Receivers::Ground, 0.0);
            let (drawn, _, difference) = masks(&scene, super::plan(10.0, 80), &suns).remove(0);
            drawn_dark += drawn.share.iter().filter(|share| **share == 0).count();
            // a shadow of millimetres: hardly a cell's centre lies in it
            assert!(difference.edge_differ <= 1 && difference.other_differ == 0, "{height} {azimuth}: {difference}");
        }
    }
    assert!(drawn_dark > 0);
}

/// A wall seen edge-on, whose edge rises away from the sun through a row of cells' centres, over a plate in the sun.
#[test]
fn a_wall_seen_edge_on_shades_nothing_above_its_edge() {
    let fin = [dvec3(0.25, -10.0, 1.0), dvec3(0.25, 10.0, 9.0), dvec3(0.25, 10.0, 0.0), dvec3(0.25, -10.0, 0.0)];
    let plate = [dvec3(-4.0, -12.0, 5.0), dvec3(4.0, -12.0, 5.0), dvec3(4.0, -1.0, 5.0), dvec3(-4.0, -1.0, 5.0)];
    let parts = [fin, plate].map(|corners| Part {
        name: "sheet".into(),
        positions: corners.to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Part::default()
    });
    let scene = scene_of(&Mesh::build(parts.to_vec()).unwrap(), Receivers::Top, 0.0);
    let azimuths = [180.0, 180.001, 180.005, 180.01, 180.02, 180.05, 179.98];
    let suns = azimuths.map(|azimuth| to_sun(azimuth, 40.0));
    for ((_, truth, difference), azimuth) in masks(&scene, super::plan(20.0, 80), &suns).into_iter().zip(azimuths) {
        assert!(truth.share.contains(&0));
        assert!(difference.other_differ == 0 && difference.edge_differ <= 16, "{azimuth}: {difference}");
    }
}

/// A triangle with one corner just below the ground, whose wall is far longer than the view.
#[test]
fn a_corner_in_the_ground_shades_nothing_outside() {
    let part = Part {
        name: "triangle".into(),
        positions: vec![dvec3(-5.837_056, 0.0, -0.072_523), dvec3(-4.142_79, -3.346_309, 5.753_491), DVec3::ZERO],
        triangles: vec![[2, 1, 0]],
        ..Part::default()
    };
    let mesh = Mesh::build(vec![part]).unwrap();
    for receivers in [Receivers::Top, Receivers::Ground] {
        let scene = scene_of(&mesh, receivers, 0.0);
        let suns = [to_sun(40.573_723, 4.0), to_sun(40.573_723, 0.02), to_sun(40.573_723, 40.0)];
        for (_, _, difference) in masks(&scene, super::plan(20.371_93, 300), &suns) {
            assert!(difference.edge_differ <= 2 && difference.other_differ == 0, "{receivers:?}: {difference}");
        }
    }
}

/// Triangles between few points, some of them below the ground, of one or two components.
fn soup() -> impl Strategy<Value = Mesh> {
    (4_usize..10).prop_flat_map(|points| {
        let position = (-6.0..6.0, -6.0..6.0, -1.0..7.0f64).prop_map(|(x, y, z)| dvec3(x, y, z));
        let corner = 0..points as u32;
        let triangle = prop::array::uniform3(corner);
        (prop::collection::vec(position, points), prop::collection::vec(triangle, 1..24), any::<bool>()).prop_map(
            |(positions, triangles, two)| {
                let (first, second) = triangles.split_at(if two { triangles.len() / 2 } else { 0 });
                let part = |triangles: &[[u32; 3]]| Part {
                    name: "soup".into(),
                    positions: positions.clone(),
                    triangles: triangles.to_vec(),
                    ..Part::default()
                };
                Mesh::build(vec![part(first), part(second)]).unwrap()
            },
        )
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn any_triangles_agree_with_ray_casting(mesh in soup(), azimuth in 0.0..360.0, altitude in 4.0..85.0, at in 0_usize..2) {
        let sun = [to_sun(azimuth, altitude)];
        // from outside: beside a face that nearly touches the eye, a millimetre is more than a pixel
        let top = scene_of(&mesh, Receivers::Top, 0.0);
        let ground = scene_of(&mesh, Receivers::Ground, 0.0);
        let plan = super::plan(20.371_93, 128);
        let drawn = [(&top, plan), (&ground, plan), (&top, View::Camera(cameras()[at]))];
        for (scene, view) in drawn {
            let (_, _, difference) = masks(scene, view, &sun).remove(0);
            // few cells, and many edges in them: a wrong wall or cap makes whole areas differ
            prop_assert!(difference.edge_differ <= 6 && difference.other_differ <= 1, "{view:?}: {difference}");
        }
    }
}
