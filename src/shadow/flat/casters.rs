//! What stands above a plane: points, edges, and for every sun which way the faces look.

use crate::mesh::{Incidence, Mesh, lowest};
use glam::{DAffine3, DVec2, DVec3, Vec3Swizzles};
use rayon::prelude::*;

/// Two faces lie in one plane where the sine of the angle between them is at most this. A sun that sees one of them from
/// the other side than its neighbour sees it from its edge: it covers nothing that could be told from its edge.
const SAME_PLANE: f64 = 1e-9;

/// The edges of a mesh above a plane. A face that the plane cuts ends in it, with an edge of its own.
pub(super) struct Casters {
    /// Column, row, height.
    points: Vec<DVec3>,
    /// Per group of faces that lie in one plane its normal, around the mesh's origin.
    normals: Vec<DVec3>,
    edges: Vec<Edge>,
    /// Where the points fall: column and row.
    places: Vec<DVec2>,
    /// Per group and direction (`Side`) what a face turned to the sun adds.
    signs: Vec<i8>,
}

/// An edge with two of its faces; one with more stands as often as is needed.
struct Edge {
    ends: [u32; 2],
    sides: [Side; 2],
}

/// The group of a face, and which way the face runs along the edge: in the lowest bit, 1 against it.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Side(u32);

impl Side {
    fn new(group: u32, against: bool) -> Side {
        Side(group << 1 | u32::from(against))
    }

    fn is_other_side_of(self, other: Side) -> bool {
        self.0 ^ 1 == other.0
    }
}

/// An edge of the silhouette as it falls: from where to where, and what the sum changes by where it is crossed, if it is
/// run from lower rows to higher ones.
pub(super) struct Falling {
    pub(super) from: DVec2,
    pub(super) to: DVec2,
    pub(super) change: i32,
}

impl Casters {
    pub(super) fn cut(mesh: &Mesh, raster_from_local: &DAffine3) -> Casters {
        let points = mesh.vertices.par_iter().map(|vertex| raster_from_local.transform_point3(vertex.as_dvec3()));
        let mut points: Vec<DVec3> = points.collect();
        let (group_of, normals) = groups(mesh);
        let mut edges = Vec::with_capacity(mesh.edges.len());
        let mut sections = Vec::new();
        let no_side = Side::new(normals.len() as u32, false);
        for (at, ends) in mesh.edges.iter().enumerate() {
            let [first, last] = ends.map(|end| points[end as usize].z > 0.0);
            if !first && !last {
                continue;
            }
            let faces = mesh.faces_at(at);
            let side = |face: Incidence| Side::new(group_of[face.face() as usize], face.direction() < 0);
            let mut ends = *ends;
            if first != last {
                // in the plane every sun's shadow of it is itself
                let cut = points.len() as u32;
                points.push(where_cut(ends.map(|end| points[end as usize])));
                ends[usize::from(first)] = cut;
                // a face that runs along the edge goes up where the last end is above
                sections.extend(faces.iter().map(|face| (face.face(), (face.direction() > 0) == last, cut)));
            }
            if let [one, other] = faces
                && side(*one).is_other_side_of(side(*other))
            {
                continue;
            }
            edges.extend(faces.chunks(2).map(|pair| {
                let sides = [side(pair[0]), pair.get(1).map_or(no_side, |face| side(*face))];
                Edge { ends, sides }
            }));
        }
        // a face goes down through the plane once and up once; between the two it runs in the plane
        sections.par_sort_unstable();
        for section in sections.chunks_exact(2) {
            let [(face, _, down), (_, _, up)] = [section[0], section[1]];
            edges.push(Edge { ends: [down, up], sides: [Side::new(group_of[face as usize], false), no_side] });
        }
        let places = vec![DVec2::ZERO; points.len()];
        // nothing is added on a side without a face
        let signs = vec![0; 2 * (normals.len() + 1)];
        Casters { points, normals, edges, places, signs }
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

    /// The silhouette in a run of the edges.
    pub(super) fn silhouette(&self, run: std::ops::Range<usize>) -> impl Iterator<Item = Falling> {
        self.edges[run].iter().filter_map(|edge| {
            let [one, other] = edge.sides.map(|side| i32::from(self.signs[side.0 as usize]));
            let change = one + other;
            let [from, to] = edge.ends.map(|end| self.places[end as usize]);
            (change != 0).then_some(Falling { from, to, change })
        })
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
    let mut above: Vec<u32> = (0..mesh.faces.len() as u32).collect();
    for edge in 0..mesh.edges.len() {
        if let [one, other] = mesh.faces_at(edge)
            && one.direction() != other.direction()
        {
            let [one, other] = [one.face(), other.face()];
            let [a, b] = [one, other].map(|face| of_faces[face as usize]);
            let sine_squared = a.cross(b).length_squared();
            if a.dot(b) > 0.0 && sine_squared <= SAME_PLANE * SAME_PLANE * a.length_squared() * b.length_squared() {
                let [one, other] = [one, other].map(|face| lowest(&mut above, face));
                above[one.max(other) as usize] = one.min(other);
            }
        }
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
