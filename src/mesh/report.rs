//! What is wrong with a mesh, in numbers and names.
//!
//! Nothing here stops a study: shadows of dirty parts are right too. But an open solid is often a modelling slip,
//! and a part that is missing from the file casts no shadow.

use super::{Component, Mesh};
use glam::DVec4;
use rustc_hash::FxHashSet;

/// The state of one component.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ComponentReport {
    /// The component's name.
    pub name: String,
    /// Its triangles, as the file has them.
    pub triangles: usize,
    /// Every edge is run along as often as against: the component bounds a solid and is well wound.
    pub closed: bool,
    /// Edges with one face.
    pub open_edges: usize,
    /// Edges with more than two faces.
    pub crowded_edges: usize,
    /// Edges whose two faces run the same way: one of them is wound wrongly.
    pub flipped_edges: usize,
    /// Triangles without area.
    pub degenerate_triangles: usize,
    /// Triangles that repeat another one's corners, whichever way they are wound.
    pub duplicate_triangles: usize,
}

impl ComponentReport {
    /// Whether there is anything to say against it.
    pub fn clean(&self) -> bool {
        self.closed && self.crowded_edges + self.degenerate_triangles + self.duplicate_triangles == 0
    }
}

/// Looks at every component.
pub fn components(mesh: &Mesh) -> Vec<ComponentReport> {
    mesh.components.iter().map(|component| report(mesh, component)).collect()
}

fn report(mesh: &Mesh, component: &Component) -> ComponentReport {
    let mut report = ComponentReport {
        name: component.name.clone(),
        triangles: component.faces.len() + component.collapsed as usize,
        closed: true,
        open_edges: 0,
        crowded_edges: 0,
        flipped_edges: 0,
        degenerate_triangles: component.collapsed as usize,
        duplicate_triangles: 0,
    };
    for edge in component.edges.clone() {
        let faces = mesh.faces_at(edge as usize);
        let sum: i32 = faces.iter().map(|face| face.direction()).sum();
        report.closed &= sum == 0;
        match faces.len() {
            1 => report.open_edges += 1,
            2 => report.flipped_edges += usize::from(sum != 0),
            _ => report.crowded_edges += 1,
        }
    }
    let mut seen = FxHashSet::default();
    for face in component.faces.clone() {
        let mut corners = mesh.faces[face as usize];
        corners.sort_unstable();
        report.duplicate_triangles += usize::from(!seen.insert(corners));
        report.degenerate_triangles += usize::from(mesh.planes[face as usize] == DVec4::ZERO);
    }
    report
}
