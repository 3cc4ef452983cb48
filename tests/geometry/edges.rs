//! Edges and their faces, found block by block, against a list of all sides.

use super::part;
use glam::{DVec3, dvec3};
use gnomon::mesh::{Mesh, Part};
use std::collections::BTreeMap;

/// The number of boxes: several blocks' worth of triangles.
const BOXES: u32 = 4000;

/// Boxes in a row, with eight corners each. Each stands apart, except that some share a wall with the one before.
fn boxes() -> Part {
    let (mut positions, mut triangles, mut west) = (Vec::new(), Vec::new(), 0.0);
    for number in 0..BOXES {
        let east = west + 1.0 + f64::from(number % 3);
        let corner = |at: u32| dvec3([west, east][at as usize & 1], f64::from(at >> 1 & 1), f64::from(at >> 2));
        positions.extend((0..8).map(corner));
        let sides = [[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4], [2, 6, 7], [2, 7, 3], [0, 4, 6]];
        let sides = sides.into_iter().chain([[0, 6, 2], [1, 3, 7], [1, 7, 5]]);
        triangles.extend(sides.map(|side| side.map(|at| number * 8 + at)));
        west = if number % 5 == 0 { east } else { east + 0.5 };
    }
    part(positions, triangles)
}

/// The faces at each edge, by a list of all sides.
fn plain(mesh: &Mesh) -> BTreeMap<[u32; 2], Vec<(u32, i32)>> {
    let mut found: BTreeMap<[u32; 2], Vec<(u32, i32)>> = BTreeMap::new();
    for (face, &[a, b, c]) in mesh.faces.iter().enumerate() {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            let direction = if from < to { 1 } else { -1 };
            found.entry([from.min(to), from.max(to)]).or_default().push((face as u32, direction));
        }
    }
    found
}

/// An edge, and for each face at it the index and the direction.
type FacedEdge = ([u32; 2], Vec<(u32, i32)>);

fn edges(mesh: &Mesh) -> Vec<FacedEdge> {
    let faces = |edge: usize| mesh.faces_at(edge).iter().map(|at| (at.face(), at.direction())).collect();
    mesh.edges.iter().enumerate().map(|(edge, ends)| (*ends, faces(edge))).collect()
}

#[test]
fn edges_of_blocks_are_those_of_the_whole() {
    let boxes = boxes();
    // the first and the last corner in one triangle: nothing can be cut
    let last = boxes.positions.len() as u32 - 1;
    let tied = Part { triangles: [&[[0, 1, last]], &boxes.triangles[..]].concat(), ..boxes.clone() };
    let few = Part { triangles: boxes.triangles[..24].to_vec(), ..boxes.clone() };
    let lists =
        [(vec![boxes.clone()], true), (vec![tied], false), (vec![few.clone()], false), (vec![few, boxes], true)];
    for (parts, is_cut) in lists {
        let mesh = Mesh::build(parts).unwrap();
        assert_eq!(mesh.block_count() > 1, is_cut, "{} blocks", mesh.block_count());
        assert_eq!(edges(&mesh), plain(&mesh).into_iter().collect::<Vec<_>>());
        let of_components: usize = mesh.components.iter().map(|component| component.edges.len()).sum();
        assert_eq!(of_components, mesh.edges.len());
        let every_third = mesh.of_faces(|face| face % 3 == 0);
        assert_eq!(edges(&every_third), plain(&every_third).into_iter().collect::<Vec<_>>());
    }
}

#[test]
fn a_mesh_without_faces_is_one_block() {
    let mesh = Mesh::build(vec![part(vec![DVec3::ZERO], Vec::new())]).unwrap();
    assert_eq!((mesh.block_count(), mesh.edges.len()), (1, 0));
}
