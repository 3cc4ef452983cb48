//! Finds the faces that may be between a patch and a light, by culling with a tree of boxes.
//!
//! The paper (sections 4.4.1 and 5.5) mentions that this culling is missing. A box is culled if it is wholly outside of
//! one side of the pyramid, or of the sun's prism, between the patch's outermost centres and the light; in registered
//! coordinates each side is one linear form.

use crate::mesh::Mesh;
use crate::shadow::registered::RasterProjection;
use glam::{DVec3, DVec4, Vec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use rayon::prelude::*;
use std::time::Duration;

/// The faces of a mesh with a tree of boxes, in the tree's order, in which neighbours are close together.
pub(super) struct Occluders {
    tree: Option<Bvh2>,
    /// The mesh's face index of each.
    pub(super) faces: Vec<u32>,
    pub(super) corners: Vec<[Vec3; 3]>,
    /// By the mesh's face index: twice each edge's index, plus 1 if the face runs against it.
    pub(super) sides: Vec<[u32; 3]>,
}

/// Linear forms that are positive inside: the sides of the pyramid.
struct Sides([DVec4; 6]);

impl Sides {
    fn of(onto: &RasterProjection, width: u32, height: u32) -> Sides {
        let last = |count: u32| f64::from(count - 1);
        Sides([
            onto.height,
            onto.column,
            onto.w * last(width) - onto.column,
            onto.row,
            onto.w * last(height) - onto.row,
            onto.w,
        ])
    }

    fn rule_out(&self, bounds: &Aabb) -> bool {
        let middle = (bounds.min + bounds.max).as_dvec3() / 2.0;
        let reach: DVec3 = (bounds.max - bounds.min).as_dvec3() / 2.0;
        // f32 rounds the middle and the extent
        let slack = 1e-6 * (middle.abs().max_element() + reach.max_element());
        self.0.iter().any(|form| {
            let normal = form.truncate();
            form.dot(middle.extend(1.0)) + normal.abs().dot(reach + slack) < 0.0
        })
    }
}

/// The sides of each face: twice the edge's index, plus 1 if the face runs against it.
fn face_sides(mesh: &Mesh) -> Vec<[u32; 3]> {
    let mut sides = vec![[u32::MAX; 3]; mesh.faces.len()];
    for edge in 0..mesh.edges.len() {
        for incidence in mesh.faces_at(edge) {
            let side = (edge as u32) << 1 | u32::from(incidence.direction() < 0);
            if let Some(slot) = sides[incidence.face() as usize].iter_mut().find(|slot| **slot == u32::MAX) {
                *slot = side;
            }
        }
    }
    sides
}

impl Occluders {
    pub(super) fn new(mesh: &Mesh) -> Occluders {
        let box_of = |face: usize| {
            let [a, b, c] = mesh.corners(face).map(Vec3A::from);
            Aabb::new(a.min(b).min(c), a.max(b).max(c))
        };
        let boxes: Vec<Aabb> = (0..mesh.faces.len()).into_par_iter().map(box_of).collect();
        let tree =
            (!boxes.is_empty()).then(|| build_bvh2(&boxes, BvhBuildParams::fast_build(), &mut Duration::default()));
        let faces = tree.as_ref().map_or(Vec::new(), |tree| tree.primitive_indices.clone());
        let corners = faces.iter().map(|&face| mesh.corners(face as usize)).collect();
        Occluders { tree, corners, faces, sides: face_sides(mesh) }
    }

    /// Finds the indices, in the tree's order, of every face that may be between the light and the patch (without
    /// culling, of all faces). Returns `false` as soon as there are more than `most`.
    pub(super) fn before(
        &self,
        onto: &RasterProjection,
        (width, height): (u32, u32),
        culling: bool,
        most: usize,
        waiting: &mut Vec<u32>,
        found: &mut Vec<u32>,
    ) -> bool {
        found.clear();
        let Some(tree) = &self.tree else { return true };
        if !culling {
            found.extend(0..self.faces.len() as u32);
            return found.len() <= most;
        }
        let sides = Sides::of(onto, width, height);
        waiting.clear();
        waiting.push(0);
        while let Some(at) = waiting.pop() {
            let node = &tree.nodes[at as usize];
            if sides.rule_out(node.aabb()) {
                continue;
            }
            if !node.is_leaf() {
                waiting.extend([node.first_index, node.first_index + 1]);
                continue;
            }
            found.extend(node.first_index..node.first_index + node.prim_count);
            if found.len() > most {
                return false;
            }
        }
        true
    }
}
