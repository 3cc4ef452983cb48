//! Coplanar faces get the same plane to the bit; faces of curved surfaces keep their own.

use super::part;
use glam::{DQuat, DVec3, DVec4, dvec3};
use gnomon::mesh::{Mesh, Part};
use std::collections::HashSet;

fn bits(plane: DVec4) -> [u64; 4] {
    plane.to_array().map(f64::to_bits)
}

fn distinct(planes: impl Iterator<Item = DVec4>) -> usize {
    planes.map(bits).collect::<HashSet<_>>().len()
}

/// The plane of each face from its own corners.
fn own(mesh: &Mesh) -> impl Iterator<Item = DVec4> {
    (0..mesh.faces.len()).map(|face| {
        let [a, b, c] = mesh.corners(face).map(|corner| corner.as_dvec3());
        let normal = (b - a).cross(c - a).normalize();
        normal.extend(-normal.dot(a))
    })
}

/// A box of six walls, each of `side` × `side` panes, turned so that no corner is a round number.
fn panes(side: u32) -> Part {
    let turn = DQuat::from_euler(glam::EulerRot::ZYX, 0.37, 0.21, 0.53);
    let mut whole = part(Vec::new(), Vec::new());
    for axis in 0..6 {
        let normal = if axis < 3 { DVec3::AXES[axis] } else { -DVec3::AXES[axis - 3] };
        let across = DVec3::AXES[(axis + 1) % 3];
        let up = normal.cross(across);
        for row in 0..side {
            for column in 0..side {
                let corner = |column: u32, row: u32| {
                    let place = |at: u32| f64::from(at) / f64::from(side) * 2.0 - 1.0;
                    turn * ((normal + across * place(column) + up * place(row)) * 8.0)
                };
                let base = whole.positions.len() as u32;
                whole.positions.extend([
                    corner(column, row),
                    corner(column + 1, row),
                    corner(column + 1, row + 1),
                    corner(column, row + 1),
                ]);
                whole.triangles.extend([[base, base + 1, base + 2], [base, base + 2, base + 3]]);
            }
        }
    }
    whole
}

#[test]
fn the_halves_of_a_wall_have_one_plane() {
    walls_have_one_plane(1);
}

#[test]
fn a_wall_of_many_panes_has_one_plane() {
    walls_have_one_plane(7);
    walls_have_one_plane(20);
}

fn walls_have_one_plane(side: u32) {
    let mesh = Mesh::build(vec![panes(side)]).unwrap();
    assert_eq!(distinct(mesh.planes().iter().copied()), 6, "{side} panes");
    for edge in 0..mesh.edges.len() {
        let &[one, other] = mesh.faces_at(edge) else { panic!("the box is closed") };
        let [one, other] = [one, other].map(|at| mesh.planes()[at.face() as usize]);
        let apart = one.truncate().angle_between(other.truncate());
        assert_eq!(bits(one) == bits(other), apart < 0.1);
    }
    // each for itself they differ, though by a hair
    assert!(distinct(own(&mesh)) > 6);
    for (own, given) in own(&mesh).zip(mesh.planes()) {
        assert!((own - given).abs().max_element() < 1e-4, "{own} became {given}");
    }
}

#[test]
fn a_wall_faces_the_sun_as_one() {
    let mesh = Mesh::build(vec![panes(20)]).unwrap();
    for wall in mesh.planes().iter().map(|plane| plane.truncate()).take(800 * 3).step_by(800) {
        // edge-on, as near as numbers go
        let sun = wall.any_orthonormal_vector().extend(0.0);
        let facing = mesh.facing(sun);
        let mixed = |planes: Vec<DVec4>| {
            let kinds: HashSet<bool> = (0..800).map(|face| planes[face].dot(sun) >= 0.0).collect();
            kinds.len() == 2
        };
        for run in facing.chunks(800) {
            assert!(run.iter().all(|facing| *facing == run[0]));
        }
        if wall == mesh.planes()[0].truncate() {
            assert!(mixed(own(&mesh).collect()), "the panes' own planes would not");
        }
    }
}

#[test]
fn a_finely_faceted_cylinder_stays_round() {
    for facets in [24, 360, 3600] {
        let rim = |step: u32, z: f64| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(step) / f64::from(facets)).sin_cos();
            dvec3(10.0 * cos, 10.0 * sin, z)
        };
        let positions = (0..facets).flat_map(|step| [rim(step, 0.0), rim(step, 12.0)]).collect();
        let wall = |step: u32| {
            let [a, b] = [step * 2, (step + 1) % facets * 2];
            [[a, b, b + 1], [a, b + 1, a + 1]]
        };
        let mesh = Mesh::build(vec![part(positions, (0..facets).flat_map(wall).collect())]).unwrap();
        assert_eq!(distinct(mesh.planes().iter().copied()), facets as usize);
        for pair in mesh.planes().chunks(2) {
            assert_eq!(bits(pair[0]), bits(pair[1]), "the halves of a facet");
        }
    }
}
