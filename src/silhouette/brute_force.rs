//! One pass over all edges: the reference that other finders are held against.

use super::{DirectedEdge, SilhouetteFinder, multiplicity};
use crate::mesh::Mesh;
use rayon::prelude::*;

/// Asks every edge.
#[derive(Clone, Copy, Debug, Default)]
pub struct BruteForce;

/// Edges a task: enough that handing it out costs nothing beside it.
const RUN: usize = 1 << 15;

impl SilhouetteFinder for BruteForce {
    fn find(&self, mesh: &Mesh, facing: &[bool], silhouette: &mut Vec<DirectedEdge>) {
        let runs = mesh.edges.par_chunks(RUN).enumerate().map(|(run, edges)| {
            let mut found = Vec::new();
            for (at, &[first, second]) in edges.iter().enumerate() {
                let multiplicity = multiplicity(mesh, facing, run * RUN + at);
                let edge = if multiplicity > 0 { [first, second] } else { [second, first] };
                found.extend(std::iter::repeat_n(edge, multiplicity.unsigned_abs() as usize));
            }
            found
        });
        for found in runs.collect::<Vec<_>>() {
            silhouette.extend(found);
        }
    }

    fn name(&self) -> &'static str {
        "brute"
    }
}
