//! What lies far off: leftovers of a drawing change no bit of what stands at home.

use super::part;
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
