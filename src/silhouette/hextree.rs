//! The hextree of *Geometry of Real Time Shadows*, section 4: silhouettes as a search in the dual space of the faces.
//!
//! A face's plane π, as a point of the 4D dual space, is in front of a light L when π·L ≥ 0: the light is a hyperplane
//! through the dual space's origin. An edge between two faces joins their two points there, and is part of the
//! silhouette when the hyperplane separates them. Edges lie in a tree of 16 children per node, each in the smallest
//! cell that contains both its ends; a query visits the cells that the hyperplane crosses. The tree only prunes: the
//! sum of directions decides, as everywhere.
//!
//! Deviations from the paper: duals of faces, not of vertices with their normals, so that the answer is the
//! polyhedron's own silhouette; two faces wound the same way join d₁π₁ and −d₂π₂; edges with one face or more than two
//! are in a list that every query tests.
//!
//! Where it fails: an edge whose ends lie on two sides of a cell border near the root is tested by almost every query.
//! Buildings, with their right angles, have many such edges; [`super::hierarchy`] does better.

use super::finder::{DirectedEdge, QueryCost, SilhouetteFinder, append, multiplicity};
use crate::mesh::{Mesh, plane_faces};
use glam::{DVec3, DVec4};
use std::ops::Range;

/// The greatest depth: 16⁸ cells are more than there are edges.
pub const DEEPEST: u32 = 8;
/// The paper's depth.
#[cfg(feature = "test-hooks")]
pub const PAPER_DEPTH: u32 = 4;

/// The tree over the edges of one mesh.
#[derive(Clone, Debug)]
pub struct Hextree {
    /// Centres the mesh and scales it to radius 1; otherwise n·p is much larger than n, and all duals crowd at w = ±1.
    frame: DualFrame,
    /// The root first; the children of a node are consecutive.
    nodes: Vec<HextreeNode>,
    /// Edges of the mesh, grouped by node.
    edges: Vec<u32>,
    /// Edges with one face or more than two.
    always: Vec<u32>,
}

#[derive(Clone, Debug)]
struct HextreeNode {
    low: DVec4,
    size: f64,
    edges: Range<u32>,
    children: Range<u32>,
}

/// An edge in dual space, during construction.
struct DualEdge {
    ends: [DVec4; 2],
    edge: u32,
}

/// Cells are enlarged by this, so that rounding never excludes what the faces' own planes would find.
const MARGIN: f64 = 1e-9;

impl Hextree {
    /// Builds the tree, with at most `depth` levels below its root (and at most [`DEEPEST`]).
    pub fn new(mesh: &Mesh, depth: u32) -> Hextree {
        let frame = DualFrame::around(mesh);
        let mut always = Vec::new();
        let mut duals = Vec::new();
        for edge in 0..mesh.edges.len() as u32 {
            if let [one, other] = *mesh.faces_at(edge as usize) {
                let dual = |incidence: crate::mesh::Incidence| frame.dual(mesh.planes()[incidence.face() as usize]);
                let ends = [dual(one) * f64::from(one.direction()), dual(other) * -f64::from(other.direction())];
                duals.push(DualEdge { ends, edge });
            } else {
                always.push(edge);
            }
        }
        let root = HextreeNode { low: DVec4::splat(-1.0), size: 2.0, edges: 0..duals.len() as u32, children: 0..0 };
        let mut tree = Hextree { frame, nodes: vec![root], edges: Vec::new(), always };
        tree.split(0, &mut duals, depth.min(DEEPEST));
        tree.edges = duals.iter().map(|dual| dual.edge).collect();
        tree
    }

    /// Keeps the edges that straddle a node's children in the node, and passes the others down.
    fn split(&mut self, node: usize, duals: &mut [DualEdge], depth: u32) {
        let HextreeNode { low, size, ref edges, .. } = self.nodes[node];
        let whole = edges.start as usize..edges.end as usize;
        if depth == 0 || whole.len() < 2 {
            return;
        }
        let middle = low + size / 2.0;
        let child_of = |point: DVec4| point.cmpge(middle).bitmask();
        // none first, so that a node's own edges come before its children's
        let child = |dual: &DualEdge| {
            let [one, other] = dual.ends.map(child_of);
            (one == other).then_some(one)
        };
        let own = &mut duals[whole.clone()];
        own.sort_by_cached_key(child);
        let first_child = self.nodes.len() as u32;
        let mut from = whole.start;
        for group in own.chunk_by(|a, b| child(a) == child(b)) {
            let edges = from as u32..(from + group.len()) as u32;
            from += group.len();
            match child(&group[0]) {
                None => self.nodes[node].edges = edges,
                Some(index) => {
                    let corner = DVec4::from_array([0, 1, 2, 3].map(|axis| f64::from(index >> axis & 1)));
                    self.nodes.push(HextreeNode {
                        low: low + corner * size / 2.0,
                        size: size / 2.0,
                        edges,
                        children: 0..0,
                    });
                }
            }
        }
        let last_child = self.nodes.len() as u32;
        if child(&duals[whole.start]).is_some() {
            self.nodes[node].edges = whole.start as u32..whole.start as u32;
        }
        self.nodes[node].children = first_child..last_child;
        for child in first_child..last_child {
            self.split(child as usize, duals, depth - 1);
        }
    }

    /// The size of the tree in memory, bytes.
    #[cfg(feature = "test-hooks")]
    pub fn bytes(&self) -> usize {
        self.nodes.len() * size_of::<HextreeNode>() + (self.edges.len() + self.always.len()) * size_of::<u32>()
    }
}

impl SilhouetteFinder for Hextree {
    fn find(&mut self, mesh: &Mesh, local_light: DVec4, silhouette: &mut Vec<DirectedEdge>) -> QueryCost {
        let light = self.frame.light(local_light);
        // for each axis, whether the cell's corner farthest against the light is the upper one
        let against = DVec4::select(light.cmplt(DVec4::ZERO), DVec4::ONE, DVec4::ZERO);
        let mut looked = QueryCost::default();
        let mut test = |edges: &[u32]| {
            looked.at += edges.len();
            for &edge in edges {
                let facing =
                    |face: crate::mesh::Incidence| plane_faces(mesh.planes()[face.face() as usize], local_light);
                let multiplicity = multiplicity(mesh.faces_at(edge as usize), facing);
                looked.found += usize::from(multiplicity != 0);
                append(silhouette, mesh.edges[edge as usize], multiplicity);
            }
        };
        test(&self.always);
        let mut visited = 0;
        let mut waiting = vec![0];
        while let Some(node) = waiting.pop() {
            let node = &self.nodes[node as usize];
            visited += 1;
            let [least, most] = [against, DVec4::ONE - against].map(|corner| light.dot(node.low + corner * node.size));
            if least > MARGIN || most < -MARGIN {
                continue;
            }
            test(&self.edges[node.edges.start as usize..node.edges.end as usize]);
            waiting.extend(node.children.clone());
        }
        looked.at += visited;
        looked
    }
}

/// The frame in which planes become points of the hypercube [−1, 1]⁴: the mesh centred, and of radius 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct DualFrame {
    centre: DVec3,
    radius: f64,
}

impl DualFrame {
    /// The frame of planes with w = 0, which is enough for suns.
    pub(super) const OF_SUNS: DualFrame = DualFrame { centre: DVec3::ZERO, radius: 1.0 };

    /// The frame of a mesh, relative to its origin.
    pub(super) fn around(mesh: &Mesh) -> DualFrame {
        let (low, high) = mesh.bounds().unwrap_or_default();
        let radius = ((high - low).length() / 2.0).max(f64::MIN_POSITIVE);
        DualFrame { centre: (low + high) / 2.0 - mesh.origin, radius }
    }

    /// A plane as a point of length 1; 0 for a face without area.
    pub(super) fn dual(&self, plane: DVec4) -> DVec4 {
        let normal = plane.truncate();
        normal.extend((plane.w + normal.dot(self.centre)) / self.radius).normalize_or_zero()
    }

    /// A light as a hyperplane of length 1.
    pub(super) fn light(&self, light: DVec4) -> DVec4 {
        ((light.truncate() - self.centre * light.w) / self.radius).extend(light.w).normalize_or_zero()
    }
}
