//! Which faces meet at which edge.
//!
//! Components share no vertices, so neither edges nor the order of edges crosses a component.

use super::blocks::{self, VertexBlock};
use super::triangles::MeshBlock;
use super::{Incidence, Mesh};
use rayon::prelude::*;
use std::ops::Range;

/// Finds the mesh's edges and the faces at them, block by block.
pub(super) fn find(mesh: &mut Mesh) {
    let blocks = blocks::blocks(&mesh.faces, mesh.vertices.len());
    let found: Vec<BlockEdges> = blocks.par_iter().map(|block| BlockEdges::of(&mesh.faces, block)).collect();
    let count = found.iter().map(|block| block.edges.len()).sum();
    let (mut edges, mut edge_first) = (Vec::with_capacity(count), Vec::with_capacity(count + 1));
    let mut incidences = Vec::with_capacity(mesh.faces.len() * 3);
    mesh.blocks = blocks
        .iter()
        .zip(found)
        .map(|(block, found)| {
            let before = edges.len() as u32;
            edges.extend(found.edges);
            edge_first.extend(found.first.iter().map(|first| first + incidences.len() as u32));
            incidences.extend(found.incidences);
            let Range { start, end } = block.triangles;
            MeshBlock { faces: start as u32..end as u32, edges: before..edges.len() as u32 }
        })
        .collect();
    edge_first.push(incidences.len() as u32);
    mesh.edges = edges.into();
    mesh.edge_first = edge_first.into();
    mesh.incidences = incidences.into();
    name_runs(mesh);
}

/// The least number of vertices for one task.
const LEAST_RUN: usize = 1 << 12;

/// The edges of a block, the index of the first side of each, and the sides.
#[derive(Default)]
struct BlockEdges {
    edges: Vec<[u32; 2]>,
    first: Vec<u32>,
    incidences: Vec<Incidence>,
}

impl BlockEdges {
    /// Sorts sides by their lower vertex in one pass, then the few sides of each vertex.
    fn of(faces: &[[u32; 3]], block: &VertexBlock) -> BlockEdges {
        let faces = block.triangles.clone().zip(&faces[block.triangles.clone()]);
        let lower = |[from, to]: [u32; 2]| from.min(to) as usize - block.vertices.start;
        let mut first = vec![0_u32; block.vertices.len() + 1];
        for side in faces.clone().flat_map(|(_, corners)| sides(corners)) {
            first[lower(side) + 1] += 1;
        }
        for vertex in 1..first.len() {
            first[vertex] += first[vertex - 1];
        }
        // the higher vertex and the incidence in one number
        let mut sorted = vec![0_u64; block.triangles.len() * 3];
        let mut next = first.clone();
        for (face, corners) in faces {
            for [from, to] in sides(corners) {
                let slot = &mut next[lower([from, to])];
                sorted[*slot as usize] =
                    u64::from(from.max(to)) << 32 | u64::from(Incidence::new(face as u32, from > to).0);
                *slot += 1;
            }
        }

        let vertices = block.vertices.len();
        let run = vertices.div_ceil(4 * rayon::current_num_threads()).max(LEAST_RUN);
        let mut runs = Vec::new();
        let mut rest = &mut sorted[..];
        for begin in (0..vertices).step_by(run) {
            let end = (begin + run).min(vertices);
            let (of_run, others) = rest.split_at_mut((first[end] - first[begin]) as usize);
            runs.push((begin..end, of_run));
            rest = others;
        }
        let before = block.vertices.start as u32;
        let of_runs = runs.into_par_iter().map(|(vertices, sides)| edges_of(vertices, before, &first, sides));
        let incidences = |sorted: &[u64]| sorted.iter().map(|side| Incidence(*side as u32)).collect();
        let mut of_runs: Vec<(Vec<[u32; 2]>, Vec<u32>)> = of_runs.collect();
        if let [(edges, first)] = &mut of_runs[..] {
            let (edges, first) = (std::mem::take(edges), std::mem::take(first));
            return BlockEdges { edges, first, incidences: incidences(&sorted) };
        }
        let (edges, first): (Vec<_>, Vec<_>) = of_runs.into_iter().unzip();
        BlockEdges { edges: edges.concat(), first: first.concat(), incidences: incidences(&sorted) }
    }
}

/// The edges whose lower vertex is in a range, counted from a block's first vertex, and the index of the first side of
/// each. Sorts the sides.
fn edges_of(vertices: Range<usize>, before: u32, first: &[u32], sides: &mut [u64]) -> (Vec<[u32; 2]>, Vec<u32>) {
    let mut edges = Vec::with_capacity(sides.len() / 2);
    let mut edge_first = Vec::with_capacity(sides.len() / 2);
    let first_side = first[vertices.start];
    for vertex in vertices {
        let (begin, end) = (first[vertex], first[vertex + 1]);
        let of_vertex = &mut sides[(begin - first_side) as usize..(end - first_side) as usize];
        of_vertex.sort_unstable();
        let mut last = None;
        for (at, side) in (begin..).zip(of_vertex) {
            let higher = (*side >> 32) as u32;
            if last != Some(higher) {
                last = Some(higher);
                edges.push([before + vertex as u32, higher]);
                edge_first.push(at);
            }
        }
    }
    (edges, edge_first)
}

/// A face's sides, in the direction in which it runs.
fn sides(&[a, b, c]: &[u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

/// Sets the range of edges of each component. Edges are in the order of components, as vertices and faces are.
fn name_runs(mesh: &mut Mesh) {
    let mut first = 0;
    for index in 0..mesh.components.len() {
        let faces = mesh.components[index].faces.end;
        let of_edge = |first: &u32| mesh.incidences[*first as usize].face() < faces;
        let end = mesh.edge_first[..mesh.edges.len()].partition_point(of_edge) as u32;
        mesh.components[index].edges = first..end;
        first = end;
    }
}

/// Finds the lowest element of a set in a union-find forest, whose links always lead to lower elements.
pub(crate) fn lowest(above: &mut [u32], mut element: u32) -> u32 {
    while above[element as usize] != element {
        above[element as usize] = above[above[element as usize] as usize];
        element = above[element as usize];
    }
    element
}

impl Mesh {
    /// Returns one bit per face: whether its shell (the faces connected by edges) has an even number of faces at each
    /// edge, as closed surfaces have whatever their winding.
    pub fn in_even_shells(&self) -> Vec<bool> {
        // union by lower index, so that every face links down to its shell's first face
        let mut above: Vec<u32> = (0..self.faces.len() as u32).collect();
        for edge in 0..self.edges.len() {
            for pair in self.faces_at(edge).windows(2) {
                let [one, other] = [pair[0], pair[1]].map(|incidence| lowest(&mut above, incidence.face()));
                above[one.max(other) as usize] = one.min(other);
            }
        }
        let mut even = vec![true; self.faces.len()];
        for edge in 0..self.edges.len() {
            let faces = self.faces_at(edge);
            if faces.len() % 2 == 1 {
                even[lowest(&mut above, faces[0].face()) as usize] = false;
            }
        }
        (0..self.faces.len() as u32).map(|face| even[lowest(&mut above, face) as usize]).collect()
    }
}
