//! One pass over all edges: the reference for other finders.

use super::finder::{DirectedEdge, QueryCost, SilhouetteFinder, append, multiplicity};
use crate::mesh::Mesh;
use glam::DVec4;
use rayon::prelude::*;

/// Tests every edge.
#[derive(Clone, Copy, Debug, Default)]
pub struct BruteForce;

/// The number of edges per task, large enough that scheduling costs little.
const RUN: usize = 1 << 15;

impl SilhouetteFinder for BruteForce {
    fn find(&mut self, mesh: &Mesh, local_light: DVec4, silhouette: &mut Vec<DirectedEdge>) -> QueryCost {
        let facing = mesh.facing(local_light);
        let runs = mesh.edges.par_chunks(RUN).enumerate().map(|(run, edges)| {
            let mut of_run = (Vec::new(), 0);
            for (at, &edge) in edges.iter().enumerate() {
                let multiplicity = multiplicity(mesh.faces_at(run * RUN + at), |face| facing[face.face() as usize]);
                of_run.1 += usize::from(multiplicity != 0);
                append(&mut of_run.0, edge, multiplicity);
            }
            of_run
        });
        let mut found = 0;
        for (edges, count) in runs.collect::<Vec<_>>() {
            silhouette.extend(edges);
            found += count;
        }
        QueryCost { at: mesh.edges.len(), found }
    }
}
