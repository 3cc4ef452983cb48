//! The mesh, its silhouettes, its volumes and ray casting, each against a simple recomputation.

mod beams;
mod edges;
mod planes;
mod rasters;
mod rays;
mod report;
pub(crate) mod silhouettes;
mod strays;
mod volumes;
mod weld;

use glam::{DVec3, DVec4, dvec3};
use gnomon::mesh::{Mesh, Part};
use proptest::prelude::*;

pub(crate) fn part(positions: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Part {
    Part { name: "part".into(), positions, triangles, ..Part::default() }
}

/// The same triangles, each with corners of its own, as many files write them.
fn unjoined(part: &Part) -> Part {
    let positions = part.triangles.iter().flatten().map(|&corner| part.positions[corner as usize]).collect();
    let triangles = (0..part.triangles.len() as u32).map(|face| [face * 3, face * 3 + 1, face * 3 + 2]).collect();
    Part { positions, triangles, ..part.clone() }
}

/// A closed, well-wound sphere of flat faces around the origin, with a fan at each pole.
pub(crate) fn sphere(radius: f64, around: u32, rings: u32) -> Part {
    let mut positions = vec![DVec3::NEG_Z * radius];
    for ring in 1..rings {
        let (ring_sin, ring_cos) = (std::f64::consts::PI * f64::from(ring) / f64::from(rings)).sin_cos();
        positions.extend((0..around).map(|step| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(step) / f64::from(around)).sin_cos();
            dvec3(cos * ring_sin, sin * ring_sin, -ring_cos) * radius
        }));
    }
    let top = positions.len() as u32;
    positions.push(DVec3::Z * radius);
    let at = |ring: u32, step: u32| 1 + (ring - 1) * around + step % around;
    let mut triangles = Vec::new();
    for step in 0..around {
        triangles.push([0, at(1, step + 1), at(1, step)]);
        triangles.push([top, at(rings - 1, step), at(rings - 1, step + 1)]);
        for ring in 1..rings - 1 {
            let [a, b] = [at(ring, step), at(ring, step + 1)];
            let [c, d] = [at(ring + 1, step + 1), at(ring + 1, step)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    part(positions, triangles)
}

/// Any mesh: triangles between few points, or a closed surface, which may cross itself.
pub(crate) fn soup() -> impl Strategy<Value = Mesh> {
    prop_oneof![2 => triangles(), 1 => dented()]
}

/// Closed and well wound: a ball whose vertices are moved outwards and inwards.
fn dented() -> impl Strategy<Value = Mesh> {
    (3_u32..8, 2_u32..6).prop_flat_map(|(around, rings)| {
        let ball = sphere(3.0, around, rings);
        prop::collection::vec(-0.4..1.7, ball.positions.len()).prop_map(move |moved| {
            let positions = ball.positions.iter().zip(moved).map(|(position, by)| position * by).collect();
            let mesh = Mesh::build(vec![Part { positions, ..ball.clone() }]).unwrap();
            assert!(gnomon::mesh::report::components(&mesh)[0].closed);
            mesh
        })
    })
}

/// Triangles between few points, so that edges are open, shared, crowded and run both ways; some repeat and some
/// collapse.
fn triangles() -> impl Strategy<Value = Mesh> {
    (4_usize..12).prop_flat_map(|points| {
        let position = prop::array::uniform3(-5.0..5.0);
        let corner = 0..points as u32;
        (prop::collection::vec(position, points), prop::collection::vec(prop::array::uniform3(corner), 1..28)).prop_map(
            |(positions, triangles)| {
                // far from the world's origin, so that forgetting the mesh's own shows
                let far = dvec3(1000.0, -2000.0, 300.0);
                let positions = positions.into_iter().map(|position| DVec3::from(position) + far).collect();
                Mesh::build(vec![part(positions, triangles)]).unwrap()
            },
        )
    })
}

/// A sun, or a lamp among the points of a [`soup`], around the mesh's origin.
pub(crate) fn light() -> impl Strategy<Value = DVec4> {
    let sun = prop::array::uniform3(-1.0..1.0f64)
        .prop_map(DVec3::from)
        .prop_filter("a direction", |direction| direction.length() > 0.1)
        .prop_map(|direction| direction.normalize().extend(0.0));
    let lamp = prop::array::uniform3(-9.0..9.0).prop_map(|position| DVec3::from(position).extend(1.0));
    prop_oneof![sun, lamp]
}

/// Closed, open and crowded meshes that people would model, each with two components' worth of names at most.
pub(crate) fn modelled() -> Vec<(&'static str, Mesh)> {
    crate::shared::scenes::small().into_iter().map(|(name, parts)| (name, Mesh::build(parts).unwrap())).collect()
}
