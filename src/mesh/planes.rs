//! The planes of faces: a common plane for coplanar neighbours.
//!
//! A wall is many triangles whose planes, each computed from its own rounded corners, differ in the last digits, so
//! that some would face a low sun and others not. Neighbours in the plane of a larger face therefore get its plane to
//! the bit, so that either the whole wall faces the light or none of it.

use super::Mesh;
use super::spacing::Spacing;
use glam::{DVec3, DVec4, Vec3};
use rayon::prelude::*;

impl Mesh {
    /// The unit plane (n, −n·p) of each face around `origin`, equal for coplanar neighbours; zero for a face without
    /// area. Planes are computed on first use.
    pub fn planes(&self) -> &[DVec4] {
        self.planes.get_or_init(|| unified(self))
    }

    /// Returns one bit per face: whether the light is on its front side or in its plane.
    ///
    /// Silhouettes, caps and shaders all read this bit, so that volumes are closed whatever the rounding. A face
    /// edge-on to the light, or without area, counts as facing it: its shadow is empty either way.
    pub fn facing(&self, local_light: DVec4) -> Vec<bool> {
        self.planes().iter().map(|&plane| plane_faces(plane, local_light)).collect()
    }
}

/// Whether a light is on the front side of a plane or in it. Only this function decides that.
pub fn plane_faces(plane: DVec4, local_light: DVec4) -> bool {
    plane.dot(local_light) >= 0.0
}

/// The unit plane of each face; zero if its corners are collinear within the precision of `f32`.
fn of_faces(mesh: &Mesh, spacing: &Spacing) -> Vec<DVec4> {
    let plane = |face: &[u32; 3]| {
        let corners = face.map(|vertex| mesh.vertices[vertex as usize]);
        let [a, b, c] = corners.map(|corner| corner.as_dvec3());
        let normal = (b - a).cross(c - a);
        let longest = (b - a).length().max((c - b).length()).max((a - c).length());
        // twice the area over the base is the height
        if normal.length() <= longest * spacing.at(&corners) {
            return DVec4::ZERO;
        }
        through(normal.normalize(), (a + b + c) / 3.0)
    };
    mesh.faces.par_iter().map(plane).collect()
}

fn through(normal: DVec3, point: DVec3) -> DVec4 {
    normal.extend(-normal.dot(point))
}

/// The distance, in lengths of a face, up to which its plane's tolerance grows.
const FARTHEST_CARRIED: f32 = 8.0;

/// The unit plane of each face, where larger faces pass theirs to coplanar neighbours.
///
/// A neighbour joins if all its corners are within two `f32` steps of the larger face's own plane (never of a
/// neighbour's, so that a gentle curve is not flattened step by step). Since a plane's error grows with distance, one
/// more step is added for each length of the larger face that the corner is away, up to [`FARTHEST_CARRIED`].
fn unified(mesh: &Mesh) -> Vec<DVec4> {
    let spacing = Spacing::of(mesh);
    let mut planes = of_faces(mesh, &spacing);
    let sides = sides(mesh);
    let size = |face: usize| {
        let [a, b, c] = mesh.corners(face).map(|corner| corner.as_dvec3());
        (b - a).cross(c - a).length_squared()
    };
    let mut largest_first: Vec<(f64, u32)> =
        (0..mesh.faces.len()).into_par_iter().map(|face| (size(face), face as u32)).collect();
    largest_first.par_sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));

    let mut joined = vec![false; mesh.faces.len()];
    let mut waiting = Vec::new();
    for (_, seed) in largest_first {
        if joined[seed as usize] || planes[seed as usize] == DVec4::ZERO {
            continue;
        }
        let plane = planes[seed as usize];
        let corners @ [a, b, c] = mesh.corners(seed as usize);
        let tolerance = 2.0 * spacing.at(&corners);
        let length = a.distance(b).max(b.distance(c)).max(c.distance(a));
        joined[seed as usize] = true;
        waiting.push(seed);
        while let Some(face) = waiting.pop() {
            for edge in sides[face as usize] {
                let [first, last] = [mesh.edge_first[edge as usize], mesh.edge_first[edge as usize + 1]];
                for at in first..last {
                    let other = mesh.incidences[at as usize].face() as usize;
                    if joined[other] || planes[other].truncate().dot(plane.truncate()) < 0.9 {
                        continue;
                    }
                    let lies_in = |corner: Vec3| {
                        let carried = f64::from((corner.distance(a) / length).min(FARTHEST_CARRIED));
                        plane.dot(corner.as_dvec3().extend(1.0)).abs() <= tolerance * (1.0 + carried)
                    };
                    if mesh.corners(other).into_iter().all(lies_in) {
                        joined[other] = true;
                        planes[other] = plane;
                        waiting.push(other as u32);
                    }
                }
            }
        }
    }
    planes
}

/// A face's area vector along its normal, square metres.
pub(super) fn area_vector(mesh: &Mesh, face: u32) -> DVec3 {
    let [a, b, c] = mesh.corners(face as usize).map(|corner| corner.as_dvec3());
    (b - a).cross(c - a) / 2.0
}

/// For each face, its three edges.
pub(super) fn sides(mesh: &Mesh) -> Vec<[u32; 3]> {
    let mut sides = vec![[u32::MAX; 3]; mesh.faces.len()];
    for edge in 0..mesh.edges.len() {
        for incidence in mesh.faces_at(edge) {
            let slots = &mut sides[incidence.face() as usize];
            if let Some(slot) = slots.iter_mut().find(|slot| **slot == u32::MAX) {
                *slot = edge as u32;
            }
        }
    }
    sides
}
