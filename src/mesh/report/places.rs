//! The places of a mesh's defects: points and edges in metres of the world frame, the longest first.

use crate::mesh::Mesh;
use glam::DVec3;

/// The greatest number of places of a kind; the longest are kept.
const MOST_PLACES: usize = 100;

/// The places of a component's defects: at most 100 of each kind, the longest first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Places {
    /// Open edges; connected ones are one place.
    pub open: Vec<OpenPlace>,
    /// T-junctions, the longest split edge first.
    pub t_junctions: Vec<Junction>,
    /// Crowded edges.
    pub crowded: Vec<EdgePlace>,
    /// Flipped edges.
    pub flipped: Vec<EdgePlace>,
    /// Triangles without area.
    pub degenerate: Vec<FacePlace>,
    /// Triangles that duplicate another one.
    pub duplicate: Vec<FacePlace>,
}

/// How open edges are connected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OpenKind {
    /// A single edge.
    Edge,
    /// A closed ring in a surface.
    Hole,
    /// A closed ring around an open surface: a sheet.
    Rim,
    /// A closed ring whose edges lie on each other: two borders with different corners.
    Seam,
    /// A chain of edges between two ends.
    Run,
    /// A network of edges that branch.
    Net,
}

/// Connected open edges.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenPlace {
    /// How they are connected.
    pub kind: OpenKind,
    /// The number of edges.
    pub edges: usize,
    /// The length of all of them, metres.
    pub length_m: f64,
    /// One end of an edge or a run; otherwise, of the longest edge.
    pub from: DVec3,
    /// The other end.
    pub to: DVec3,
    /// The middle of a ring; otherwise, of the longest edge.
    pub near: DVec3,
}

/// A defective edge.
#[derive(Clone, Debug, PartialEq)]
pub struct EdgePlace {
    /// One end.
    pub from: DVec3,
    /// The other.
    pub to: DVec3,
    /// Its length, metres.
    pub length_m: f64,
    /// The number of its faces.
    pub faces: usize,
}

/// A defective triangle.
#[derive(Clone, Debug, PartialEq)]
pub struct FacePlace {
    /// Its middle.
    pub near: DVec3,
    /// Its longest side, metres.
    pub length_m: f64,
}

/// A vertex that lies within an open edge.
#[derive(Clone, Debug, PartialEq)]
pub struct Junction {
    /// The vertex.
    pub at: DVec3,
    /// The edge that should be split there.
    pub edge: EdgePlace,
}

pub(super) fn world(mesh: &Mesh, vertex: u32) -> DVec3 {
    mesh.origin + mesh.vertices[vertex as usize].as_dvec3()
}

pub(super) fn edge(mesh: &Mesh, edge: u32) -> EdgePlace {
    let [from, to] = mesh.edges[edge as usize].map(|vertex| world(mesh, vertex));
    EdgePlace { from, to, length_m: from.distance(to), faces: mesh.faces_at(edge as usize).len() }
}

pub(super) fn edges(mesh: &Mesh, edges: &[u32]) -> Vec<EdgePlace> {
    longest(edges.iter().map(|&at| edge(mesh, at)), |place| place.length_m)
}

/// Places of triangles of the mesh, and of those that collapsed to a line between two vertices.
pub(super) fn faces(mesh: &Mesh, faces: &[u32], collapsed: &[[u32; 2]]) -> Vec<FacePlace> {
    let whole = faces.iter().map(|&face| {
        let [a, b, c] = mesh.faces[face as usize].map(|vertex| world(mesh, vertex));
        FacePlace { near: (a + b + c) / 3.0, length_m: a.distance(b).max(b.distance(c)).max(c.distance(a)) }
    });
    let collapsed = collapsed.iter().map(|&line| {
        let [a, b] = line.map(|vertex| world(mesh, vertex));
        FacePlace { near: (a + b) / 2.0, length_m: a.distance(b) }
    });
    longest(whole.chain(collapsed), |place| place.length_m)
}

/// Places of vertices, with the edges that they lie in.
pub(super) fn junctions(mesh: &Mesh, found: &[(u32, u32)]) -> Vec<Junction> {
    let places = found.iter().map(|&(vertex, within)| Junction { at: world(mesh, vertex), edge: edge(mesh, within) });
    longest(places, |place| place.edge.length_m)
}

/// The longest ones; of equals the first.
pub(super) fn longest<T>(places: impl Iterator<Item = T>, length_m: impl Fn(&T) -> f64) -> Vec<T> {
    let mut places: Vec<T> = places.collect();
    places.sort_by(|one, other| length_m(other).total_cmp(&length_m(one)));
    places.truncate(MOST_PLACES);
    places
}
