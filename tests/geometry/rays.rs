//! The ray caster: no ray slips through a shared edge, and the nearest face is found.

use super::{part, soup, sphere};
use crate::shared::scenes::stack;
use glam::{DVec3, dvec3};
use gnomon::mesh::{Mesh, Part};
use gnomon::shadow::ray_cast::{RayCaster, Shear};
use proptest::prelude::*;

/// Rays from a point inside to every vertex, and to points on every edge.
fn targets(mesh: &Mesh) -> Vec<DVec3> {
    let at = |vertex: u32| mesh.vertices[vertex as usize].as_dvec3();
    let on_edge = |&[a, b]: &[u32; 2]| [0.5, 0.25, 0.3, 0.9].map(|share| at(a) + (at(b) - at(a)) * share);
    let vertices = mesh.vertices.iter().map(|vertex| vertex.as_dvec3());
    vertices.chain(mesh.edges.iter().flat_map(on_edge)).collect()
}

/// How many of the rays from a point to the targets miss the mesh, with all three kinds of queries.
fn passes(mesh: &Mesh, from: DVec3) -> usize {
    let caster = RayCaster::new(mesh, 100.0);
    let missed = |&&target: &&DVec3| {
        let direction = target - from;
        let hit = caster.first_hit(from, direction);
        assert_eq!(hit.is_some(), caster.blocked(from, &Shear::along(direction)));
        assert_eq!(hit.is_some(), caster.crossings(from, direction) > 0);
        if let Some((_, distance)) = hit {
            assert!((distance - 1.0).abs() < 1e-5, "hit at {distance}");
        }
        hit.is_none()
    };
    targets(mesh).iter().filter(missed).count()
}

/// A turned, round thing whose corners are no round numbers.
fn turned(part: Part) -> Part {
    let turn = glam::DQuat::from_euler(glam::EulerRot::ZYX, 0.37, 0.21, 0.53);
    Part { positions: part.positions.iter().map(|&position| turn * position).collect(), ..part }
}

#[test]
fn nothing_passes_a_closed_mesh_at_edges_and_vertices() {
    for ball in [sphere(7.0, 48, 24), turned(sphere(7.0, 48, 24)), sphere(50.0, 500, 3)] {
        let mesh = Mesh::build(vec![ball]).unwrap();
        let mut aimed = 0;
        for from in [DVec3::ZERO, dvec3(0.5, 0.25, -0.125), dvec3(-1.3, 2.1, 0.7)] {
            assert_eq!(passes(&mesh, from), 0, "from {from}");
            aimed += targets(&mesh).len();
        }
        assert!(aimed > 10_000, "{aimed}");
        // with a face taken out, rays do pass
        let holed = mesh.of_faces(|face| face + 1 < mesh.faces.len() as u32);
        let caster = RayCaster::new(&holed, 100.0);
        let hole = mesh.corners(mesh.faces.len() - 1).map(|corner| corner.as_dvec3()).iter().sum::<DVec3>() / 3.0;
        assert!(caster.first_hit(DVec3::ZERO, hole).is_none());
        assert!(RayCaster::new(&mesh, 100.0).first_hit(DVec3::ZERO, hole).is_some());
    }
}

#[test]
fn rays_from_outside_cross_a_closed_mesh_twice_at_least() {
    let mesh = Mesh::build(vec![turned(sphere(7.0, 48, 24))]).unwrap();
    let caster = RayCaster::new(&mesh, 100.0);
    let targets = targets(&mesh);
    for from in [dvec3(20.0, 3.0, 4.0), dvec3(-3.0, 11.0, -9.0), dvec3(0.0, 0.0, 64.0)] {
        let seen = targets.iter().filter(|target| target.dot(from - **target) > 40.0);
        let mut aimed = 0;
        for &target in seen {
            assert!(caster.crossings(from, target - from) >= 2, "from {from} to {target}");
            assert!(caster.first_hit(from, target - from).is_some_and(|(_, distance)| (distance - 1.0).abs() < 1e-5));
            aimed += 1;
        }
        assert!(aimed > 1000, "{aimed}");
        assert_eq!(caster.crossings(from, from), 0, "away from it");
    }
}

#[test]
fn axes_and_straight_lines_pass_no_fan() {
    // a fan whose spokes lie in the rays' own planes, right above
    let spokes = 64;
    let mut positions = vec![dvec3(0.0, 0.0, 4.0)];
    positions.extend((0..spokes).map(|spoke| {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(spoke) / f64::from(spokes)).sin_cos();
        dvec3(cos * 6.0, sin * 6.0, 4.0)
    }));
    let mesh =
        Mesh::build(vec![part(positions, (0..spokes).map(|at| [0, 1 + at, 1 + (at + 1) % spokes]).collect())]).unwrap();
    let caster = RayCaster::new(&mesh, 100.0);
    for vertex in mesh.vertices.iter().map(|vertex| vertex.as_dvec3()) {
        for share in (0..100).map(|step| f64::from(step) / 100.0) {
            let above = dvec3(vertex.x * share, vertex.y * share, 0.0);
            for from in [above - DVec3::Z * 9.0, above + DVec3::Z * 9.0] {
                assert!(caster.first_hit(from, DVec3::Z * -from.z).is_some(), "at {above}");
            }
        }
    }
    assert!(caster.first_hit(dvec3(6.1, 0.0, -9.0), DVec3::Z).is_none());
}

#[test]
fn the_nearest_plate_is_hit_from_both_sides() {
    let mesh = Mesh::build(vec![stack(300, 0.0)]).unwrap();
    let caster = RayCaster::new(&mesh, 100.0);
    let height = |face: u32| f64::from(mesh.corners(face as usize)[0].z) + mesh.origin.z;
    for (z, direction, nearest) in [(-7.0, 1.0, 1.0), (7.0, -1.0, 3.99), (1.005, 1.0, 1.01), (1.005, -1.0, 1.0)] {
        let from = dvec3(1.3, -0.7, z) - mesh.origin;
        let (face, distance) = caster.first_hit(from, DVec3::Z * direction * 2.0).unwrap();
        assert!((height(face) - nearest).abs() < 1e-5, "from {z}: {}", height(face));
        assert!((distance * 2.0 - (nearest - z).abs()).abs() < 1e-5, "in lengths of the direction");
    }
    assert_eq!(caster.crossings(dvec3(1.3, -0.7, -7.0), DVec3::Z), 300);
    assert!(caster.first_hit(dvec3(1.3, -0.7, 7.0), DVec3::Z).is_none());
}

#[test]
fn a_ray_in_a_face_s_plane_meets_nothing() {
    let corners = [dvec3(-2.0, -2.0, 0.0), dvec3(2.0, -2.0, 0.0), dvec3(2.0, 2.0, 0.0), dvec3(-2.0, 2.0, 0.0)];
    let mesh = Mesh::build(vec![part(corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]])]).unwrap();
    let caster = RayCaster::new(&mesh, 100.0);
    for (from, direction) in [
        (dvec3(-9.0, 0.3, 0.0), DVec3::X),
        (dvec3(0.1, 0.3, 0.0), dvec3(-0.4, 0.9, 0.0)),
        (dvec3(-9.0, -2.0, 0.0), DVec3::X),
        (dvec3(-9.0, -9.0, 0.0), dvec3(1.0, 1.0, 0.0)),
    ] {
        assert!(caster.first_hit(from, direction).is_none(), "from {from}");
        assert!(!caster.blocked(from, &Shear::along(direction)));
        assert_eq!(caster.crossings(from, direction), 0);
    }
    // out of the plane by a hair, and a ray that starts on the face and leaves it
    assert!(caster.first_hit(dvec3(-9.0, 0.3, 0.009), dvec3(1.0, 0.0, -0.001)).is_some());
    assert!(caster.first_hit(dvec3(0.1, 0.3, 0.0), DVec3::Z).is_none());
}

/// Möller and Trumbore, 1997: how many lengths away.
fn plain_hit([a, b, c]: [DVec3; 3], origin: DVec3, direction: DVec3) -> Option<f64> {
    let (ab, ac) = (b - a, c - a);
    let across = direction.cross(ac);
    let determinant = ab.dot(across);
    let from_a = origin - a;
    let u = from_a.dot(across) / determinant;
    let v = direction.dot(from_a.cross(ab)) / determinant;
    let t = ac.dot(from_a.cross(ab)) / determinant;
    (determinant != 0.0 && u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0).then_some(t)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn rays_agree_with_a_plain_intersection(mesh in soup(), from in prop::array::uniform3(-9.0..9.0), to in prop::array::uniform3(-4.0..4.0)) {
        let (from, to) = (DVec3::from(from), DVec3::from(to));
        let caster = RayCaster::new(&mesh, 100.0);
        let direction = to - from;
        let hits: Vec<f64> = (0..mesh.faces.len())
            .filter_map(|face| plain_hit(mesh.corners(face).map(|corner| corner.as_dvec3()), from, direction))
            .collect();
        prop_assert_eq!(caster.crossings(from, direction), hits.len());
        let nearest = hits.iter().copied().reduce(f64::min);
        let found = caster.first_hit(from, direction);
        prop_assert_eq!(found.is_some(), nearest.is_some());
        if let (Some((face, distance)), Some(nearest)) = (found, nearest) {
            prop_assert!((distance - nearest).abs() < 1e-6 * nearest.max(1.0), "{} not {}", distance, nearest);
            let own = plain_hit(mesh.corners(face as usize).map(|corner| corner.as_dvec3()), from, direction);
            prop_assert!(own.is_some_and(|own| (own - nearest).abs() < 1e-6 * nearest.max(1.0)));
        }
    }
}

#[test]
fn what_stands_a_hundredth_of_a_millimetre_away_is_hit() {
    // a wall at whole metres, far from everything else; a tree's ray has its own least distance
    let wall = Part {
        name: "wall".into(),
        positions: vec![dvec3(-5.0, 0.0, 1.0), dvec3(-5.0, 5.0, 1.0), dvec3(-5.0, 5.0, 4.0), dvec3(-5.0, 0.0, 4.0)],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Part::default()
    };
    let mesh = Mesh::build(vec![wall]).unwrap();
    for reach in [0.1, 10.0, 1000.0] {
        let caster = RayCaster::new(&mesh, reach);
        for (off, length) in [(1e-5, 1.0), (2.5e-5, 1.0), (9e-5, 40.0), (1e-3, 40.0)] {
            let from = dvec3(-5.0 + off, 4.6, 1.001) - mesh.origin;
            let direction = dvec3(-0.8, -0.45, 0.39).normalize() * length;
            let hit = caster.first_hit(from, direction);
            let expected = off / -direction.x;
            assert!(hit.is_some_and(|(_, distance)| (distance - expected).abs() < 1e-9), "{hit:?} of {expected}");
            assert!(caster.blocked(from, &Shear::along(direction)));
            assert!(!caster.blocked(from, &Shear::along(-direction)));
        }
    }
}
