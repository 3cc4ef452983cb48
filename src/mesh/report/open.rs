//! Open edges: what they border, and the vertices that lie within them.

use super::places::{OpenKind, OpenPlace, edge, longest, world};
use crate::mesh::spacing::Spacing;
use crate::mesh::{Component, Mesh, adjacency, weld};
use glam::{DVec3, Vec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::cwbvh::builder::build_cwbvh;
use obvhs::ray::{Ray, RayHit};
use std::time::Duration;

/// The vertices of open edges that lie within another open edge, up to the distance that welding would join, each with
/// the longest such edge. One of the faces there was split and its neighbour was not.
pub(super) fn junctions(mesh: &Mesh, component: &Component, open: &[u32], spacing: &Spacing) -> Vec<(u32, u32)> {
    let mut ends: Vec<u32> = open.iter().flat_map(|&edge| mesh.edges[edge as usize]).collect();
    ends.sort_unstable();
    ends.dedup();
    let at_home = |vertex| mesh.is_at_home(vertex);
    let bounds =
        mesh.bounds_where(component.faces.clone(), at_home).or_else(|| mesh.bounds_of(component.faces.clone()));
    let Some((low, high)) = bounds.filter(|_| ends.len() > 2) else {
        return Vec::new();
    };
    // a vertex between two others is rounded, too
    let welded = weld::tolerance(low.distance(high), low.abs().max(high.abs()).max_element());
    let tolerance = |points: &[Vec3]| welded.max(2.0 * spacing.at(points));
    let point = |vertex: u32| Vec3A::from(mesh.vertices[vertex as usize]);
    let around = |vertex: u32| {
        let points = [mesh.vertices[vertex as usize]];
        // several times the error of the tree's single precision
        let padding = Vec3A::splat((tolerance(&points) + 8.0 * spacing.at(&points)) as f32);
        Aabb::new(point(vertex) - padding, point(vertex) + padding)
    };
    let boxes: Vec<Aabb> = ends.iter().map(|&end| around(end)).collect();
    let tree = build_cwbvh(&boxes, BvhBuildParams::fast_build(), &mut Duration::default());

    let mut found = Vec::new();
    for &edge in open {
        let [from, to] = mesh.edges[edge as usize];
        let edge_ends = [from, to].map(|vertex| mesh.vertices[vertex as usize]);
        let tolerance = tolerance(&edge_ends);
        let [a, b] = edge_ends.map(|end| end.as_dvec3());
        let length = a.distance(b);
        let within = |vertex: u32| {
            let from_a = mesh.vertices[vertex as usize].as_dvec3() - a;
            let along = from_a.dot((b - a) / length);
            let aside = from_a.distance((b - a) / length * along);
            along > tolerance && length - along > tolerance && aside <= tolerance
        };
        // adding 0 turns −0 into 0: the tree uses the sign of the direction and of its inverse
        let ray = Ray::new(point(from), point(to) - point(from) + Vec3A::ZERO, 0.0, 1.0);
        tree.ray_traverse(ray, &mut RayHit::none(), |_, at| {
            let vertex = ends[tree.primitive_indices[at] as usize];
            if within(vertex) {
                found.push((vertex, edge, length));
            }
            f32::INFINITY
        });
    }
    found.sort_unstable_by(|one, other| one.0.cmp(&other.0).then(other.2.total_cmp(&one.2)).then(one.1.cmp(&other.1)));
    found.dedup_by_key(|(vertex, ..)| *vertex);
    found.into_iter().map(|(vertex, edge, _)| (vertex, edge)).collect()
}

/// Open edges that are connected by vertices.
#[derive(Clone, Debug, Default)]
struct EdgeGroup {
    edges: Vec<u32>,
    /// Vertices with one open edge.
    ends: Vec<u32>,
    /// Whether a vertex has more than two open edges.
    branches: bool,
    /// Whether one of its vertices lies within an open edge.
    has_junction: bool,
    /// Whether one face arrives and one leaves at each vertex, so that the ring has a direction.
    is_oriented: bool,
}

/// The places of the open edges, the longest first.
pub(super) fn places(mesh: &Mesh, open: &[u32], junctions: &[(u32, u32)]) -> Vec<OpenPlace> {
    // each edge at both of its vertices, and whether its face leaves the vertex there
    let mut ends: Vec<(u32, u32, bool)> = Vec::with_capacity(open.len() * 2);
    for (at, &edge) in open.iter().enumerate() {
        let [first, last] = mesh.edges[edge as usize];
        let along = mesh.faces_at(edge as usize)[0].direction() > 0;
        ends.extend([(first, at as u32, along), (last, at as u32, !along)]);
    }
    ends.sort_unstable();
    let vertices = || ends.chunk_by(|one, other| one.0 == other.0);
    let mut above: Vec<u32> = (0..open.len() as u32).collect();
    for vertex in vertices() {
        for pair in vertex.windows(2) {
            let [one, other] = [pair[0].1, pair[1].1].map(|edge| adjacency::lowest(&mut above, edge));
            above[one.max(other) as usize] = one.min(other);
        }
    }
    let mut groups = vec![EdgeGroup { is_oriented: true, ..EdgeGroup::default() }; open.len()];
    for (at, &edge) in open.iter().enumerate() {
        groups[adjacency::lowest(&mut above, at as u32) as usize].edges.push(edge);
    }
    for vertex in vertices() {
        let group = &mut groups[adjacency::lowest(&mut above, vertex[0].1) as usize];
        match vertex {
            [alone] => group.ends.push(alone.0),
            [one, other] => group.is_oriented &= one.2 != other.2,
            _ => group.branches = true,
        }
        group.has_junction |= junctions.binary_search_by_key(&vertex[0].0, |(vertex, _)| *vertex).is_ok();
    }
    longest(groups.iter().filter(|group| !group.edges.is_empty()).map(|group| place(mesh, group)), |place| {
        place.length_m
    })
}

fn place(mesh: &Mesh, group: &EdgeGroup) -> OpenPlace {
    let edges: Vec<_> = group.edges.iter().map(|&at| edge(mesh, at)).collect();
    let length_m: f64 = edges.iter().map(|edge| edge.length_m).sum();
    let longest = edges.iter().reduce(|most, edge| if edge.length_m > most.length_m { edge } else { most });
    let [mut from, mut to] = longest.map_or([DVec3::ZERO; 2], |edge| [edge.from, edge.to]);
    let mut near = (from + to) / 2.0;
    let kind = match group.ends.as_slice() {
        _ if group.edges.len() == 1 => OpenKind::Edge,
        [first, last] if !group.branches => {
            [from, to] = [world(mesh, *first), world(mesh, *last)];
            OpenKind::Run
        }
        [] if !group.branches => {
            near = edges.iter().map(|edge| (edge.from + edge.to) / 2.0 * edge.length_m).sum::<DVec3>()
                / length_m.max(f64::MIN_POSITIVE);
            ring(mesh, group, near, length_m)
        }
        _ => OpenKind::Net,
    };
    OpenPlace { kind, edges: group.edges.len(), length_m, from, to, near }
}

/// A ring with a smaller area, as a share of its squared length, encloses nothing.
const NO_AREA: f64 = 1e-5;

/// The greatest angle of a sheet to its border's plane at its rim, about 25°, as a cosine. The flared foot of a statue
/// is not a sheet.
const SHEET: f64 = 0.9;

/// Whether a ring is a hole, a rim or a seam. The area of the ring, run around as its faces do, faces their front side
/// if they are inside the ring, and their back if they are around it.
fn ring(mesh: &Mesh, group: &EdgeGroup, middle: DVec3, length_m: f64) -> OpenKind {
    if !group.is_oriented {
        return OpenKind::Hole;
    }
    let (mut area, mut front, mut weight) = (DVec3::ZERO, DVec3::ZERO, 0.0);
    for &at in &group.edges {
        let face = mesh.faces_at(at as usize)[0];
        let [from, to] = mesh.edges[at as usize].map(|vertex| world(mesh, vertex) - middle);
        area += from.cross(to) * (0.5 * f64::from(face.direction()));
        front += mesh.planes()[face.face() as usize].truncate() * from.distance(to);
        weight += from.distance(to);
    }
    if group.has_junction && area.length() <= NO_AREA * length_m * length_m {
        OpenKind::Seam
    } else if area.dot(front) > SHEET * area.length() * weight {
        OpenKind::Rim
    } else {
        OpenKind::Hole
    }
}
