//! Which faces meet at which edge.
//!
//! Parts share no vertices, so neither an edge nor an order of edges by their vertices crosses a component.

use super::{Incidence, Mesh};
use rayon::prelude::*;

/// Fills in the mesh's edges and what meets there.
pub(super) fn find(mesh: &mut Mesh) {
    let mut sides: Vec<([u32; 2], Incidence)> = Vec::with_capacity(mesh.faces.len() * 3);
    for (face, &[a, b, c]) in mesh.faces.iter().enumerate() {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            sides.push(([from.min(to), from.max(to)], Incidence::new(face as u32, from > to)));
        }
    }
    sides.par_sort_unstable_by_key(|(edge, incidence)| (*edge, incidence.0));

    mesh.edges.clear();
    mesh.edge_first.clear();
    for (index, (edge, _)) in sides.iter().enumerate() {
        if mesh.edges.last() != Some(edge) {
            mesh.edges.push(*edge);
            mesh.edge_first.push(index as u32);
        }
    }
    mesh.edge_first.push(sides.len() as u32);
    mesh.incidences = sides.into_iter().map(|(_, incidence)| incidence).collect();
    name_runs(mesh);
}

/// Gives each component its run of edges. Components keep the order of their vertices, as of their faces.
fn name_runs(mesh: &mut Mesh) {
    let mut edge = 0;
    for index in 0..mesh.components.len() {
        let faces = mesh.components[index].faces.clone();
        let first = edge;
        while edge < mesh.edges.len() && faces.contains(&mesh.faces_at(edge)[0].face()) {
            edge += 1;
        }
        mesh.components[index].edges = first as u32..edge as u32;
    }
}

/// Follows a forest of unions, in which each element leads to a lower one of its set, to the set's lowest.
pub(super) fn lowest(above: &mut [u32], mut element: u32) -> u32 {
    while above[element as usize] != element {
        above[element as usize] = above[above[element as usize] as usize];
        element = above[element as usize];
    }
    element
}

/// Per face, whether all edges of its shell have an even number of faces.
pub(super) fn in_even_shells(mesh: &Mesh) -> Vec<bool> {
    // union by the lower face, so that every face leads downwards to its shell's first
    let mut above: Vec<u32> = (0..mesh.faces.len() as u32).collect();
    for edge in 0..mesh.edges.len() {
        for pair in mesh.faces_at(edge).windows(2) {
            let [one, other] = [pair[0], pair[1]].map(|incidence| lowest(&mut above, incidence.face()));
            above[one.max(other) as usize] = one.min(other);
        }
    }
    let mut even = vec![true; mesh.faces.len()];
    for edge in 0..mesh.edges.len() {
        let faces = mesh.faces_at(edge);
        if faces.len() % 2 == 1 {
            even[lowest(&mut above, faces[0].face()) as usize] = false;
        }
    }
    (0..mesh.faces.len() as u32).map(|face| even[lowest(&mut above, face) as usize]).collect()
}
