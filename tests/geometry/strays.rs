//! Stray geometry far away: leftovers of a drawing do not change one bit of the result at the place.

use super::{part, unjoined};
use crate::shared::scenes::{cuboid, joined};
use glam::{DVec3, dvec3};
use gnomon::mesh::{Mesh, MeshError, Part, report};

/// Forty slats 5 cm wide and 10 cm apart, 3 m above the ground.
fn pergola(at: DVec3) -> Part {
    let slat = |index: u32| {
        let low = at + dvec3(f64::from(index) * 0.15, 0.0, 3.0);
        cuboid("pergola", low, low + dvec3(0.05, 4.0, 0.1))
    };
    joined((0..40).map(slat).collect())
}

fn stray(at: DVec3) -> Part {
    let corners = vec![at, at + DVec3::X, at + DVec3::Y];
    Part { name: "leftover".into(), ..part(corners, vec![[0, 1, 2]]) }
}

/// Corners and plane, to the bit, of every face that stands within 100 m of the place.
fn at_home(mesh: &Mesh) -> Vec<([[u32; 3]; 3], [u64; 4])> {
    let near =
        |face: &usize| mesh.corners(*face).iter().all(|corner| (corner.as_dvec3() + mesh.origin).length() < 100.0);
    let bits = |face: usize| {
        let corners = mesh.corners(face).map(|corner| corner.to_array().map(f32::to_bits));
        (corners, mesh.planes()[face].to_array().map(f64::to_bits))
    };
    (0..mesh.faces.len()).filter(near).map(bits).collect()
}

#[test]
fn a_stray_far_away_moves_no_bit_of_what_stands_at_home() {
    let home = || pergola(DVec3::ZERO);
    let alone = Mesh::build(vec![home()]).unwrap();
    let right = at_home(&alone);
    assert_eq!(right.len(), 480);
    let ways = [dvec3(1.0, 0.0, 0.0), dvec3(-0.6, 0.8, 0.0), dvec3(0.0, -1.0, 0.001)];
    for (km, way) in [60.0, 100.0, 200.0, 500.0, 1000.0, 5000.0].into_iter().flat_map(|km| ways.map(|way| (km, way))) {
        let at = way * (km * 1000.0);
        let meshes = [
            ("the same primitive", vec![joined(vec![home(), stray(at)])]),
            ("before it", vec![joined(vec![stray(at), home()])]),
            ("its own component", vec![home(), stray(at)]),
            ("its own component, first", vec![stray(at), home()]),
            ("another instance", vec![joined(vec![home(), pergola(at)])]),
        ];
        for (what, parts) in meshes {
            let mesh = Mesh::build(parts).unwrap();
            assert_eq!(mesh.origin, alone.origin, "{what} at {km} km");
            assert!(at_home(&mesh) == right, "{what} at {km} km");
            assert_eq!(mesh.bounds_at_home(), alone.bounds_at_home(), "{what} at {km} km");
        }
    }
}

/// Twenty bars of 0.9 mm, which a tolerance of a millimetre would make lines.
fn bars(at: DVec3) -> Part {
    let bar = |index: u32| {
        let low = at + dvec3(f64::from(index) * 0.1, 0.0, 1.0);
        cuboid("bars", low, low + dvec3(0.0009, 0.0009, 1.0))
    };
    joined((0..20).map(bar).collect())
}

#[test]
fn a_stray_near_by_makes_nothing_flat_that_stands_at_home() {
    for at in [DVec3::ZERO, dvec3(-120.0, 240.0, 3.0)] {
        for away in [0.6, 2.0, 9.0, 15.0].map(|km| dvec3(km * 1000.0, 3.0, 0.0)) {
            let mesh = Mesh::build(vec![joined(vec![bars(at), stray(at + away)])]).unwrap();
            assert_eq!(mesh.faces.len(), 20 * 12 + 1, "{away}");
            assert_eq!(mesh.components[0].flattened, 0, "{away}");
        }
    }
}

#[test]
fn corners_at_both_sides_of_a_border_of_cells_are_welded() {
    // borders lie at each 250 m from the place; one runs along a side of this house, and corners lie a hair beside it
    let low = dvec3(250.0, 500.0, 0.0);
    let mut house = unjoined(&cuboid("house", low, low + dvec3(40.0, 60.0, 3.0)));
    for (at, corner) in house.positions.iter_mut().enumerate() {
        corner.x += if at % 2 == 0 { 1e-5 } else { -1e-5 };
    }
    let far = low + dvec3(0.0, 900.0, 0.0);
    let mesh = Mesh::build(vec![joined(vec![house, cuboid("far", far, far + 200.0)])]).unwrap();
    assert_eq!(mesh.vertices.len(), 16);
}

/// A shed so large that no two of its corners lie in neighbouring cells, from a file that rounds each corner either way.
#[test]
fn corners_that_stand_alone_are_welded_as_exactly_as_the_file_holds_them() {
    for (size, at) in [(271.0, dvec3(240.0, 240.0, 0.0)), (600.0, DVec3::ZERO), (1200.0, dvec3(-300.0, 90.0, 0.0))] {
        let mut shed = unjoined(&cuboid("shed", at, at + dvec3(size, size, 6.0)));
        for (number, corner) in shed.positions.iter_mut().enumerate() {
            let rounded = corner.to_array().map(|at| if number % 2 == 0 { at as f32 } else { (at as f32).next_up() });
            *corner = DVec3::from(rounded.map(f64::from));
        }
        let mesh = Mesh::build(vec![shed]).unwrap();
        assert_eq!(mesh.vertices.len(), 8, "{size} m");
        assert!(report::components(&mesh)[0].closed, "{size} m");
    }
}

#[test]
fn a_triangle_from_home_to_far_away_joins_nothing() {
    let home = || pergola(DVec3::ZERO);
    let alone = Mesh::build(vec![home()]).unwrap();
    for km in [60.0, 1000.0] {
        let at = dvec3(km * 1000.0, 0.0, 0.0);
        let corners = vec![dvec3(1.0, 1.0, 0.0), dvec3(2.0, 1.0, 0.0), at];
        let across = || Part { name: "leftover".into(), ..part(corners.clone(), vec![[0, 1, 2]]) };
        // a stray of its own at the other end, too
        for parts in [vec![home(), across()], vec![joined(vec![across(), home()])], vec![across(), home(), stray(at)]] {
            let mesh = Mesh::build(parts).unwrap();
            assert_eq!(mesh.origin, alone.origin, "{km} km");
            assert!(at_home(&mesh) == at_home(&alone), "{km} km");
            assert_eq!(mesh.home(), alone.home(), "{km} km");
        }
    }
}

#[test]
fn land_whose_triangles_are_wider_than_strays_are_far_is_one_home() {
    let far = 30_000.0;
    let corners = [(-far, -far), (far, -far), (far, far), (-far, far)].map(|(x, y)| dvec3(x, y, 0.0)).to_vec();
    let mesh = Mesh::build(vec![Part { name: "land".into(), ..part(corners, vec![[0, 1, 2], [0, 2, 3]]) }]).unwrap();
    assert!((0..4).all(|vertex| mesh.is_at_home(vertex)));
}

#[test]
fn many_strays_near_each_other_are_not_the_home() {
    // more triangles than the pergola, but it is the one near the place
    let strays: Vec<Part> = (0..900).map(|index| stray(dvec3(3.0e5, f64::from(index), 0.0))).collect();
    let mesh = Mesh::build(vec![joined(strays), pergola(DVec3::ZERO)]).unwrap();
    let alone = Mesh::build(vec![pergola(DVec3::ZERO)]).unwrap();
    assert_eq!(mesh.origin, alone.origin);
    assert!(at_home(&mesh) == at_home(&alone));
    assert!((0..mesh.vertices.len() as u32).any(|vertex| !mesh.is_at_home(vertex)));
}

#[test]
fn what_is_wide_is_no_reason_to_join_what_is_narrow() {
    // a meadow of 60 km in the same component: a millionth of it is wider than a slat
    let low = dvec3(-30_000.0, -30_000.0, 0.0);
    let meadow = cuboid("meadow", low, low + dvec3(60_000.0, 60_000.0, 0.5));
    let mesh = Mesh::build(vec![joined(vec![meadow, pergola(DVec3::ZERO)])]).unwrap();
    assert_eq!(mesh.faces.len(), 41 * 12);
    assert!(report::components(&mesh)[0].closed);
}

#[test]
fn models_far_from_the_place_are_one_home() {
    let at = dvec3(691_607.253, 5_334_762.118, 0.0);
    let mesh = Mesh::build(vec![pergola(at), cuboid("house", at + 30.0, at + 45.0)]).unwrap();
    assert!(mesh.origin.distance(at) < 50.0);
    assert!((0..mesh.vertices.len() as u32).all(|vertex| mesh.is_at_home(vertex)));
}

#[test]
fn what_no_number_reaches_is_refused_by_its_name() {
    let error = Mesh::build(vec![pergola(DVec3::ZERO), stray(dvec3(0.0, 9.0e6, 0.0))]).unwrap_err();
    assert!(matches!(error, MeshError::TooWide { .. }));
    assert!(error.to_string().contains("'leftover' reaches 9000 km"), "{error}");
}
