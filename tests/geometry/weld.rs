//! Coincident corners become one vertex within a part, but never across parts.

use super::{part, sphere, unjoined};
use crate::shared::scenes::cuboid;
use glam::{DVec3, Vec3, dvec3};
use gnomon::mesh::{Mesh, Part, report};
use std::collections::HashSet;
use std::time::{Duration, Instant};

fn block() -> Part {
    cuboid("block", dvec3(-5.0, -4.0, 0.0), dvec3(5.0, 4.0, 9.0))
}

/// The part with each corner moved by the same distance, but each in a different direction.
fn shaken(part: &Part, by: f64) -> Part {
    let moved = |(at, &position): (usize, &DVec3)| {
        let (sin, cos) = (at as f64 * 2.4).sin_cos();
        position + dvec3(sin, cos, 0.0) * by
    };
    Part { positions: part.positions.iter().enumerate().map(moved).collect(), ..part.clone() }
}

#[test]
fn corners_in_one_place_become_one_vertex() {
    let apart = unjoined(&block());
    assert_eq!(apart.positions.len(), 36);
    for (by, vertices) in [(0.0, Some(8)), (3e-6, Some(8)), (1e-3, None)] {
        let mesh = Mesh::build(vec![shaken(&apart, by)]).unwrap();
        assert_eq!(mesh.faces.len(), 12);
        assert_eq!(report::components(&mesh)[0].closed, vertices.is_some(), "shaken by {by} m");
        match vertices {
            Some(vertices) => assert_eq!(mesh.vertices.len(), vertices, "shaken by {by} m"),
            None => assert_eq!(mesh.vertices.len(), 36, "what lies a millimetre apart stays apart"),
        }
    }
}

#[test]
fn corners_in_one_place_become_one_vertex_anywhere() {
    // so many that some lie on both sides of a border, however places are told apart
    let [around, rings] = [60, 40];
    let mesh = Mesh::build(vec![shaken(&unjoined(&sphere(10.0, around, rings)), 1e-5)]).unwrap();
    assert_eq!(mesh.vertices.len() as u32, around * (rings - 1) + 2);
    assert!(report::components(&mesh)[0].closed);
}

#[test]
fn both_zeros_are_one_place() {
    let positions = vec![dvec3(0.0, 0.0, 0.0), dvec3(1.0, 0.0, 0.0), dvec3(0.0, 1.0, 0.0), dvec3(-0.0, -0.0, 0.0)];
    let mesh = Mesh::build(vec![part(positions, vec![[0, 1, 2], [3, 2, 1]])]).unwrap();
    assert_eq!(mesh.vertices.len(), 3);
}

#[test]
fn parts_share_no_vertex_and_no_edge() {
    let mesh = Mesh::build(vec![block(), block()]).unwrap();
    assert_eq!((mesh.vertices.len(), mesh.faces.len(), mesh.edges.len()), (16, 24, 36));
    let of = |component: usize| -> HashSet<u32> {
        let run = mesh.components[component].faces.clone();
        mesh.faces[run.start as usize..run.end as usize].iter().flatten().copied().collect()
    };
    assert!(of(0).is_disjoint(&of(1)));
    assert!(!of(0).is_disjoint(&of(0)));
    for (component, edges) in mesh.components.iter().map(|component| (component, component.edges.clone())) {
        assert_eq!(edges.len(), 18);
        for edge in edges {
            assert!(mesh.faces_at(edge as usize).iter().all(|at| component.faces.contains(&at.face())));
        }
    }
}

#[test]
fn collapsed_triangles_are_counted_and_left_out() {
    let mut block = block();
    block.positions.push(block.positions[0] + dvec3(1e-7, 0.0, 0.0));
    block.triangles.extend([[0, 8, 1], [2, 2, 3], [0, 8, 0]]);
    let mesh = Mesh::build(vec![block]).unwrap();
    assert_eq!((mesh.faces.len(), mesh.components[0].collapsed.len()), (12, 3));
    let report = &report::components(&mesh)[0];
    assert_eq!((report.triangles, report.degenerate_triangles, report.closed), (15, 3, true));
}

#[test]
fn far_from_the_origin_the_file_s_precision_is_kept() {
    let low = dvec3(2_680_000.015_625, 1_200_000.125, 400.25);
    let high = low + dvec3(20.5, 30.25, 12.007_812_5);
    let far = cuboid("far", low, high);
    let mesh = Mesh::build(vec![far.clone()]).unwrap();
    assert_eq!(mesh.vertices.len(), 8);
    for (vertex, position) in mesh.vertices.iter().zip(&far.positions) {
        assert_eq!(vertex.as_dvec3() + mesh.origin, *position);
    }
    // which single precision alone does not hold
    assert!(far.positions.iter().any(|position| position.as_vec3().as_dvec3() != *position));
    let near = Mesh::build(vec![cuboid("near", low - mesh.origin, high - mesh.origin)]).unwrap();
    assert_eq!(near.vertices[..], mesh.vertices[..]);
    assert_eq!(near.planes(), mesh.planes());
}

#[test]
fn tiny_and_crowded_meshes_are_welded_in_time() {
    let side = 224;
    let sheet = |size: f64, at: DVec3| {
        let point = |index: u32| {
            let place = dvec3(f64::from(index % side), f64::from(index / side), 0.0) / f64::from(side - 1);
            at + place * size
        };
        let cell = |index: u32| {
            let corner = index / (side - 1) * side + index % (side - 1);
            [[corner, corner + 1, corner + side + 1], [corner, corner + side + 1, corner + side]]
        };
        part((0..side * side).map(point).collect(), (0..(side - 1) * (side - 1)).flat_map(cell).collect())
    };
    let started = Instant::now();
    let alone = Mesh::build(vec![sheet(0.001, DVec3::ZERO)]).unwrap();
    assert_eq!(alone.vertices.len(), 50_176);
    assert!(alone.components[0].collapsed.is_empty());
    // in a wide model, single precision has few places for so small a part
    for size in [0.001, 1e-6] {
        let wide = Mesh::build(vec![sheet(size, DVec3::ZERO), sheet(size, DVec3::splat(2000.0))]).unwrap();
        let places: HashSet<[u32; 3]> = wide.vertices.iter().map(|at: &Vec3| at.to_array().map(f32::to_bits)).collect();
        assert_eq!(wide.vertices.len(), places.len(), "no two vertices in one place");
        assert!(wide.vertices.len() < 1000);
    }
    assert!(started.elapsed() < Duration::from_secs(20), "{:?}", started.elapsed());
}
