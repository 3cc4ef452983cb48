//! Reports what is wrong with a mesh: numbers, names and places.
//!
//! None of it prevents a study: shadows of defective parts are right, too. But an open solid is often a modelling
//! mistake, and a part that is missing from the file casts no shadow.

mod open;
mod places;

pub use places::{EdgePlace, FacePlace, Junction, OpenKind, OpenPlace, Places};

use super::spacing::Spacing;
use super::{Component, Mesh};
use glam::DVec4;
use rayon::prelude::*;
use rustc_hash::FxHashSet;

/// The state of one component.
#[derive(Clone, Debug, PartialEq)]
pub struct ComponentReport {
    /// The component's name.
    pub name: String,
    /// The number of its triangles, as in the file.
    pub triangles: usize,
    /// Whether each edge is used equally in both directions: the component then encloses a solid and is consistently
    /// wound.
    pub closed: bool,
    /// The number of edges with one face.
    pub open_edges: usize,
    /// The number of T-junctions: vertices within an open edge, which should be split there.
    pub t_junctions: usize,
    /// The number of edges with more than two faces.
    pub crowded_edges: usize,
    /// The number of edges whose two faces run the same way: one of them is wound wrongly.
    pub flipped_edges: usize,
    /// The number of triangles without area.
    pub degenerate_triangles: usize,
    /// The number of triangles that repeat another one's corners, whatever their winding.
    pub duplicate_triangles: usize,
    /// The places of these defects.
    pub places: Places,
}

impl ComponentReport {
    /// Whether the component has no defect.
    pub fn clean(&self) -> bool {
        self.closed && self.crowded_edges + self.degenerate_triangles + self.duplicate_triangles == 0
    }
}

/// The state of every component.
pub fn components(mesh: &Mesh) -> Vec<ComponentReport> {
    let spacing = Spacing::of(mesh);
    mesh.components.par_iter().map(|component| report(mesh, component, &spacing)).collect()
}

fn report(mesh: &Mesh, component: &Component, spacing: &Spacing) -> ComponentReport {
    let mut closed = true;
    let (mut open, mut crowded, mut flipped) = (Vec::new(), Vec::new(), Vec::new());
    for edge in component.edges.clone() {
        let faces = mesh.faces_at(edge as usize);
        let sum: i32 = faces.iter().map(|face| face.direction()).sum();
        closed &= sum == 0;
        match faces.len() {
            1 => open.push(edge),
            2 if sum != 0 => flipped.push(edge),
            2 => (),
            _ => crowded.push(edge),
        }
    }
    let mut seen = FxHashSet::default();
    let (mut degenerate, mut duplicate) = (Vec::new(), Vec::new());
    for face in component.faces.clone() {
        let mut corners = mesh.faces[face as usize];
        corners.sort_unstable();
        if !seen.insert(corners) {
            duplicate.push(face);
        }
        if mesh.planes()[face as usize] == DVec4::ZERO {
            degenerate.push(face);
        }
    }
    let junctions = open::junctions(mesh, component, &open, spacing);
    ComponentReport {
        name: component.name.clone(),
        triangles: component.faces.len() + component.collapsed.len(),
        closed,
        open_edges: open.len(),
        t_junctions: junctions.len(),
        crowded_edges: crowded.len(),
        flipped_edges: flipped.len(),
        degenerate_triangles: degenerate.len() + component.collapsed.len(),
        duplicate_triangles: duplicate.len(),
        places: Places {
            open: open::places(mesh, &open, &junctions),
            t_junctions: places::junctions(mesh, &junctions),
            crowded: places::edges(mesh, &crowded),
            flipped: places::edges(mesh, &flipped),
            degenerate: places::faces(mesh, &degenerate, &component.collapsed),
            duplicate: places::faces(mesh, &duplicate, &[]),
        },
    }
}
