//! What stands above a plane: points and edges, and for every sun the facing of the faces.

use crate::mesh::{Incidence, Mesh, lowest};
use glam::{DAffine3, DVec2, DVec3, Vec3Swizzles};
use rayon::prelude::*;
use std::ops::Range;

/// Two faces lie in one plane where the sine of the angle between them is at most this. A sun that sees one of them from
/// the other side than its neighbour sees it from its edge: it covers nothing that could be told from its edge.
const SAME_PLANE: f64 = 1e-9;

/// The edges of a mesh above a plane, and where its faces go through the plane.
pub(super) struct Casters {
    /// Column, row, height.
    points: Vec<DVec3>,
    /// Per group of faces that lie in one plane its normal, around the mesh's origin.
    normals: Vec<DVec3>,
    edges: Vec<Edge>,
    /// Where faces go through the plane, from where they go down to where they go up.
    sections: Vec<([u32; 2], FaceSide)>,
    /// Where the points fall: column and row.
    places: Vec<DVec2>,
    /// Per group and direction (`FaceSide`) what a face turned to the sun adds.
    signs: Vec<i8>,
}

/// An edge with two of its faces; one with more stands as often as is needed.
struct Edge {
    ends: [u32; 2],
    sides: [FaceSide; 2],
}

/// The group of a face, and which way the face runs along the edge: in the lowest bit, 1 against it.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct FaceSide(u32);

impl FaceSide {
    fn new(group: u32, against: bool) -> FaceSide {
        FaceSide(group << 1 | u32::from(against))
    }

    fn is_other_side_of(self, other: FaceSide) -> bool {
        self.0 ^ 1 == other.0
    }
}

/// An edge of the silhouette as it falls: from where to where, and what the sum changes by where it is crossed, if it is
/// run from lower rows to higher ones.
pub(super) struct FallingEdge {
    pub(super) from: DVec2,
    pub(super) to: DVec2,
    pub(super) change: i32,
}

impl Casters {
    pub(super) fn cut(mesh: &Mesh, raster_from_local: &DAffine3) -> Casters {
        let points = mesh.vertices.par_iter().map(|vertex| raster_from_local.transform_point3(vertex.as_dvec3()));
        let mut points: Vec<DVec3> = points.collect();
        let (group_of, normals) = groups(mesh);
        let no_side = FaceSide::new(normals.len() as u32, false);
        let runs = (0..mesh.edges.len().div_ceil(RUN)).into_par_iter().map(|run| {
            let run = run * RUN..((run + 1) * RUN).min(mesh.edges.len());
            EdgesAbove::cut(mesh, &points, run, |face| group_of[face as usize], no_side)
        });
        let runs: Vec<EdgesAbove> = runs.collect();
        let whole = points.len() as u32;
        let mut edges = Vec::with_capacity(runs.iter().map(|run| run.edges.len()).sum());
        let mut meets = Vec::new();
        for run in runs {
            let before = points.len() as u32 - whole;
            let of_all = |point: u32| if point < whole { point } else { point + before };
            edges.extend(run.edges.iter().map(|edge| Edge { ends: edge.ends.map(of_all), ..*edge }));
            meets.extend(run.meets.iter().map(|&(face, up, cut)| (face, up, of_all(cut))));
            points.extend(run.cuts);
        }
        // a face goes down through the plane once and up once; between the two it runs in the plane
        meets.par_sort_unstable();
        let sections = meets.chunks_exact(2).map(|meet| {
            let [(face, _, down), (_, _, up)] = [meet[0], meet[1]];
            ([down, up], FaceSide::new(group_of[face as usize], false))
        });
        let sections = sections.collect();
        let places = vec![DVec2::ZERO; points.len()];
        // nothing is added on a side without a face
        let signs = vec![0; 2 * (normals.len() + 1)];
        Casters { points, normals, edges, sections, places, signs }
    }

    /// Lets all fall along a sun; `throw` is how many columns and rows the sun moves away in a metre of height.
    pub(super) fn project(&mut self, to_sun: DVec3, throw: DVec2) {
        const AT_ONCE: usize = 1 << 13;
        let Casters { points, normals, places, signs, .. } = self;
        let fall = |(place, point): (&mut DVec2, &DVec3)| *place = point.xy() - throw * point.z;
        let turn = |(signs, normal): (&mut [i8], &DVec3)| {
            let sign = if normal.dot(to_sun) >= 0.0 { 1 } else { -1 };
            signs.copy_from_slice(&[sign, -sign]);
        };
        rayon::join(
            || places.par_iter_mut().zip(&*points).with_min_len(AT_ONCE).for_each(fall),
            || signs.par_chunks_exact_mut(2).zip(&*normals).with_min_len(AT_ONCE).for_each(turn),
        );
    }

    /// Where the points fell, and the points, the mesh's vertices first.
    pub(super) fn fallen(&self) -> (&[DVec2], &[DVec3]) {
        (&self.places, &self.points)
    }

    /// How many edges there are, silhouette or not.
    pub(super) fn edges(&self) -> usize {
        self.edges.len()
    }

    /// Where faces go through the plane, whatever the sun: each as an edge with what its side's sign is to be multiplied by.
    pub(super) fn sections(&self) -> impl Iterator<Item = (FallingEdge, FaceSide)> {
        self.sections.iter().map(|&(ends, side)| {
            let [from, to] = ends.map(|end| self.points[end as usize].xy());
            (FallingEdge { from, to, change: 1 }, side)
        })
    }

    /// What a face on a side adds under the sun of the last projection.
    pub(super) fn sign(&self, side: FaceSide) -> i32 {
        i32::from(self.signs[side.0 as usize])
    }

    /// Tells the silhouette in a run of the edges.
    pub(super) fn silhouette(&self, run: Range<usize>, mut tell: impl FnMut(FallingEdge)) {
        const AT_ONCE: usize = 128;
        let change = |edge: &Edge| -> i32 { edge.sides.map(|side| self.sign(side)).iter().sum() };
        for edges in self.edges[run].chunks(AT_ONCE) {
            // found first and told then: no processor foresees which edge is one
            let (mut found, mut count) = ([0_u8; AT_ONCE], 0);
            for (at, edge) in edges.iter().enumerate() {
                found[count] = at as u8;
                count += usize::from(change(edge) != 0);
            }
            for at in &found[..count] {
                let edge = &edges[usize::from(*at)];
                let [from, to] = edge.ends.map(|end| self.places[end as usize]);
                tell(FallingEdge { from, to, change: change(edge) });
            }
        }
    }
}

/// Edges of the mesh that one task cuts.
const RUN: usize = 1 << 13;

/// What of a run of edges is above the plane.
#[derive(Default)]
struct EdgesAbove {
    edges: Vec<Edge>,
    /// Where they meet the plane; these follow the mesh's vertices.
    cuts: Vec<DVec3>,
    /// Faces that go through the plane, whether up there, and at which point.
    meets: Vec<(u32, bool, u32)>,
}

impl EdgesAbove {
    fn cut(
        mesh: &Mesh,
        points: &[DVec3],
        run: Range<usize>,
        group_of: impl Fn(u32) -> u32,
        no_side: FaceSide,
    ) -> EdgesAbove {
        let mut above = EdgesAbove { edges: Vec::with_capacity(run.len()), ..EdgesAbove::default() };
        for at in run {
            let mut ends = mesh.edges[at];
            let [first, last] = ends.map(|end| points[end as usize].z > 0.0);
            if !first && !last {
                continue;
            }
            let faces = mesh.faces_at(at);
            let side = |face: Incidence| FaceSide::new(group_of(face.face()), face.direction() < 0);
            if first != last {
                // in the plane every sun's shadow of it is itself
                let cut = (points.len() + above.cuts.len()) as u32;
                above.cuts.push(where_cut(ends.map(|end| points[end as usize])));
                ends[usize::from(first)] = cut;
                // a face that runs along the edge goes up where the last end is above
                above.meets.extend(faces.iter().map(|face| (face.face(), (face.direction() > 0) == last, cut)));
            }
            if let [one, other] = faces
                && side(*one).is_other_side_of(side(*other))
            {
                continue;
            }
            above.edges.extend(faces.chunks(2).map(|pair| {
                let sides = [side(pair[0]), pair.get(1).map_or(no_side, |face| side(*face))];
                Edge { ends, sides }
            }));
        }
        above
    }
}

/// Where an edge between a point above the plane and one that is not meets it. The same whichever is named first.
pub(in crate::shadow) fn where_cut([one, other]: [DVec3; 2]) -> DVec3 {
    let (low, high) = if one.z < other.z { (one, other) } else { (other, one) };
    low.lerp(high, -low.z / (high.z - low.z)).xy().extend(0.0)
}

/// The group of every face and the normal of every group: faces that meet at an edge and lie in one plane, whole walls
/// and not their triangles.
fn groups(mesh: &Mesh) -> (Vec<u32>, Vec<DVec3>) {
    // corners are f32, so that this is all but exact
    let normal = |face: &[u32; 3]| {
        let [a, b, c] = face.map(|vertex| mesh.vertices[vertex as usize].as_dvec3());
        (b - a).cross(c - a)
    };
    let of_faces: Vec<DVec3> = mesh.faces.par_iter().map(normal).collect();
    let lie_in_one_plane = |edge: usize| {
        let [one, other] = mesh.faces_at(edge) else { return false };
        let [a, b] = [one, other].map(|face| of_faces[face.face() as usize]);
        let sine_squared = a.cross(b).length_squared();
        one.direction() != other.direction()
            && a.dot(b) > 0.0
            && sine_squared <= SAME_PLANE * SAME_PLANE * a.length_squared() * b.length_squared()
    };
    let edges = (0..mesh.edges.len()).into_par_iter().with_min_len(RUN);
    let flat: Vec<bool> = edges.map(lie_in_one_plane).collect();
    let mut above: Vec<u32> = (0..mesh.faces.len() as u32).collect();
    for (edge, _) in flat.iter().enumerate().filter(|(_, is_flat)| **is_flat) {
        let [one, other] = [0, 1].map(|at| lowest(&mut above, mesh.faces_at(edge)[at].face()));
        above[one.max(other) as usize] = one.min(other);
    }
    // the largest face's normal stands for all
    let mut group_of = vec![0; mesh.faces.len()];
    let mut normals: Vec<DVec3> = Vec::new();
    for face in 0..mesh.faces.len() {
        let first = lowest(&mut above, face as u32) as usize;
        if first == face {
            group_of[face] = normals.len() as u32;
            normals.push(of_faces[face]);
        } else {
            let group = group_of[first];
            group_of[face] = group;
            let normal = &mut normals[group as usize];
            if of_faces[face].length_squared() > normal.length_squared() {
                *normal = of_faces[face];
            }
        }
    }
    (group_of, normals)
}
