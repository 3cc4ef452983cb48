//! Gathers connected faces in one plane.

use super::{FLAT_ANGLE_DEG, FLAT_M, seen_side};
use crate::mesh::planes::{self, area_vector};
use crate::mesh::spacing::Spacing;
use crate::mesh::{Component, Mesh};
use glam::DVec4;
use rayon::prelude::*;

/// A patch without texels.
#[derive(Clone, Debug)]
pub(super) struct FlatPatch {
    pub(super) component: u32,
    pub(super) faces: Vec<u32>,
    /// The plane relative to the mesh's origin, facing the judged side.
    pub(super) plane: DVec4,
    pub(super) two_sided: bool,
    pub(super) area_m2: f64,
}

/// The patches of all components that receive, in the order of components, the larger ones of each first.
pub(super) fn gather(mesh: &Mesh, receives: &[bool]) -> Vec<FlatPatch> {
    let edges = planes::sides(mesh);
    let spacing = Spacing::of(mesh);
    let receiving: Vec<(u32, &Component)> =
        (0..).zip(&mesh.components).zip(receives).filter(|(_, receives)| **receives).map(|(it, _)| it).collect();
    let of_component = |&(index, component): &(u32, &Component)| {
        let seen = seen_side::of_faces(mesh, component, &edges);
        of_component(mesh, index, component, &edges, &seen, &spacing)
    };
    receiving.par_iter().map(of_component).collect::<Vec<_>>().into_iter().flatten().collect()
}

/// Grows patches from the largest faces of a component. All faces of a patch are compared with its first face's plane,
/// never with a neighbour's, so that a gentle curve is not flattened step by step.
fn of_component(
    mesh: &Mesh,
    index: u32,
    component: &Component,
    edges: &[[u32; 3]],
    seen: &[seen_side::SeenSide],
    spacing: &Spacing,
) -> Vec<FlatPatch> {
    let first = component.faces.start;
    let mut largest_first: Vec<(f64, u32)> =
        component.faces.clone().map(|face| (area_vector(mesh, face).length(), face)).collect();
    largest_first.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let plane_of = |face: u32| {
        let plane = mesh.planes()[face as usize];
        if seen[(face - first) as usize].turned { -plane } else { plane }
    };
    let least_cosine = FLAT_ANGLE_DEG.to_radians().cos();

    let mut joined = vec![false; component.faces.len()];
    let mut flats = Vec::new();
    for (_, seed) in largest_first {
        let plane = plane_of(seed);
        if joined[(seed - first) as usize] || plane == DVec4::ZERO {
            continue;
        }
        joined[(seed - first) as usize] = true;
        let tolerance = FLAT_M.max(2.0 * spacing.at(&mesh.corners(seed as usize)));
        let two_sided = seen[(seed - first) as usize].both;
        let mut flat = FlatPatch { component: index, faces: vec![seed], plane, two_sided, area_m2: 0.0 };
        let mut at = 0;
        while at < flat.faces.len() {
            let face = flat.faces[at];
            flat.area_m2 += area_vector(mesh, face).length();
            at += 1;
            for other in edges[face as usize].iter().flat_map(|&edge| mesh.faces_at(edge as usize)) {
                let other = other.face();
                let local = (other - first) as usize;
                let lies_in = || {
                    let near = |corner: glam::Vec3| plane.dot(corner.as_dvec3().extend(1.0)).abs() <= tolerance;
                    plane_of(other).truncate().dot(plane.truncate()) >= least_cosine
                        && seen[local].both == two_sided
                        && mesh.corners(other as usize).into_iter().all(near)
                };
                if !joined[local] && lies_in() {
                    joined[local] = true;
                    flat.faces.push(other);
                }
            }
        }
        flats.push(flat);
    }
    flats.sort_by(|one, other| other.area_m2.total_cmp(&one.area_m2).then(one.faces[0].cmp(&other.faces[0])));
    flats
}
