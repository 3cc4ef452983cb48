//! The slow twin: traces rays one by one through a tree of its own, and decides every triangle that it finds in double
//! precision. With it, and with tests of all faces, the fast caster is verified.

use super::shear::Shear;
use crate::mesh::Mesh;
use glam::{DVec3, Vec3, Vec3A};
use obvhs::cwbvh::{CwBvh, builder::build_cwbvh};
use obvhs::ray::{Ray, RayHit};
use obvhs::{BvhBuildParams, aabb::Aabb};
use rayon::prelude::*;
use std::time::Duration;

/// Casts rays at one mesh as [`RayCaster`](super::RayCaster) does, without SIMD or beams.
#[doc(hidden)]
pub struct PlainCaster {
    tree: Option<CwBvh>,
    /// The corners of faces in the tree's order, and the faces' indices.
    corners: Vec<[Vec3; 3]>,
    faces: Vec<u32>,
}

/// The tree skips boxes that a ray leaves before this distance, in lengths of the ray's direction (`EPSILON` of obvhs
/// 0.4).
const LOOKED_PAST: f64 = 1e-4;

impl PlainCaster {
    /// Builds the tree; `reach` is the greatest distance of a ray's origin from the mesh's origin, metres.
    pub fn new(mesh: &Mesh, reach: f64) -> PlainCaster {
        let size = mesh.vertices.iter().fold(0.0f32, |size, vertex| size.max(vertex.abs().max_element()));
        let rounding = (f64::from(size) + reach) * f64::from(f32::EPSILON) * 8.0;
        // the tree's rays have unit directions, so padded boxes end beyond the distance that it skips
        let padding = Vec3A::splat((rounding + 2.0 * LOOKED_PAST) as f32);
        let box_of = |face: usize| {
            let [a, b, c] = mesh.corners(face).map(Vec3A::from);
            Aabb::new(a.min(b).min(c) - padding, a.max(b).max(c) + padding)
        };
        let boxes: Vec<Aabb> = (0..mesh.faces.len()).into_par_iter().map(box_of).collect();
        let tree =
            (!boxes.is_empty()).then(|| build_cwbvh(&boxes, BvhBuildParams::fast_build(), &mut Duration::default()));
        let faces = tree.as_ref().map_or(Vec::new(), |tree| tree.primitive_indices.clone());
        PlainCaster { tree, corners: faces.iter().map(|&face| mesh.corners(face as usize)).collect(), faces }
    }

    /// Returns the nearest face along a ray, and its distance in lengths of `direction`; of equally near ones the
    /// first.
    pub fn first_hit(&self, origin: DVec3, direction: DVec3) -> Option<(u32, f64)> {
        let shear = Shear::along(direction);
        let length = direction.length();
        let mut nearest = None;
        let mut so_far = (f64::INFINITY, u32::MAX);
        let ray = ray(origin, direction);
        self.tree.as_ref()?.ray_traverse(ray, &mut RayHit::none(), |_, at| {
            if let Some(t) = shear.hit(origin, &self.corners[at])
                && (t, self.faces[at]) < so_far
            {
                so_far = (t, self.faces[at]);
                nearest = Some((self.faces[at], t));
                // the tree must continue at this distance, as another face may be equally near, and must not skip it
                return ((t * length) as f32).next_up().max(2.0 * LOOKED_PAST as f32);
            }
            f32::INFINITY
        });
        nearest
    }

    /// Whether anything is in the way of a ray.
    pub fn blocked(&self, origin: DVec3, direction: DVec3) -> bool {
        let shear = Shear::along(direction);
        let hit = |_: &Ray, at: usize| {
            if shear.hit(origin, &self.corners[at]).is_some() { 0.0 } else { f32::INFINITY }
        };
        self.tree.as_ref().is_some_and(|tree| !tree.ray_traverse_miss(ray(origin, direction), hit))
    }
}

fn ray(origin: DVec3, direction: DVec3) -> Ray {
    // adding 0 turns −0 into 0: the tree uses the sign of the direction and of its inverse
    Ray::new_inf(origin.as_vec3a(), direction.normalize().as_vec3a() + Vec3A::ZERO)
}
