//! Receivers that are flush with the ground, such as lawns, plots and paving in its plane: which of them is seen.
//!
//! Whether such a face or the plane is nearer depends on rounding, which may differ from cell to cell; so it does for
//! two faces that lie on each other. The mask does not depend on it, but a picture would show noise. So one rule
//! decides what is seen: where the plane or a flush face is nearest, the first flush face in the order of the mesh is
//! seen. What is judged remains what is nearest.

use super::JUDGED_ABOVE_M;
use super::rays::{RayCaster, Shear};
use crate::mesh::Mesh;
use crate::view::Surface;
use arrayvec::ArrayVec;
use glam::{DVec2, DVec3, Vec3, Vec3Swizzles};
use rayon::prelude::*;
use std::sync::Arc;

/// The least height of a flush face's unit normal: a steeper face is not flush, however low it is.
const LEAST_UP: f32 = 0.5;

/// The receivers' faces that lie in the ground's plane, in the order of the mesh: all their corners are within a
/// millimetre of it, above or below.
pub(super) fn flush_faces(receivers: &Mesh, ground: f64) -> Vec<u32> {
    let level = ground - receivers.origin.z;
    let is_flush = |face: &u32| {
        let corners = receivers.corners(*face as usize);
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a);
        corners.iter().all(|corner| (f64::from(corner.z) - level).abs() <= JUDGED_ABOVE_M)
            && normal.z.abs() > LEAST_UP * normal.length()
    };
    (0..receivers.faces.len() as u32).into_par_iter().filter(is_flush).collect()
}

/// Finds the flush faces at points of the ground's plane.
#[doc(hidden)]
pub struct FlushFaces {
    /// The faces, in the order of the mesh.
    faces: Vec<u32>,
    /// The same faces pressed flat, at height 0 whatever the ground's height.
    flat: RayCaster,
    /// A box around the faces, metres from the receivers' origin.
    low: DVec2,
    high: DVec2,
    /// The plane's height above the receivers' origin, metres.
    level: f64,
    down: Shear,
}

impl FlushFaces {
    /// The flush faces of some receivers; `None` if there are none.
    pub fn new(receivers: &Mesh, ground: f64) -> Option<FlushFaces> {
        let faces = flush_faces(receivers, ground);
        let corners = |face: &u32| receivers.corners(*face as usize).map(|corner| corner.with_z(0.0));
        let vertices: Vec<Vec3> = faces.iter().flat_map(corners).collect();
        let low = vertices.iter().copied().reduce(Vec3::min)?.xy().as_dvec2();
        let high = vertices.iter().copied().reduce(Vec3::max)?.xy().as_dvec2();
        let mut flat = receivers.of_components(&[]);
        flat.vertices = Arc::new(vertices);
        flat.faces = Arc::new((0..faces.len() as u32).map(|face| [3 * face, 3 * face + 1, 3 * face + 2]).collect());
        let flat = RayCaster::new(&flat, 1.0);
        let level = ground - receivers.origin.z;
        Some(FlushFaces { faces, flat, low, high, level, down: Shear::along(DVec3::NEG_Z) })
    }

    /// The point where a ray meets the plane, if a flush face may be seen there: the plane or a flush face is nearest
    /// along the ray, and others are near. A ray is its start, relative to the receivers' origin, and its unit
    /// direction.
    pub(super) fn place(&self, nearest: u32, (from, along): (DVec3, DVec3)) -> Option<DVec2> {
        if nearest != Surface::GROUND && self.faces.binary_search(&nearest).is_err() {
            return None;
        }
        let distance = (self.level - from.z) / along.z;
        let place = (distance > 0.0 && distance.is_finite()).then(|| (from + along * distance).truncate())?;
        (place.cmpge(self.low).all() && place.cmple(self.high).all()).then_some(place)
    }

    /// The first face at each of up to [`RayCaster::MOST_RAYS`] points of the plane, if there is one.
    pub(super) fn first(&self, places: &[DVec2]) -> ArrayVec<Option<u32>, { RayCaster::MOST_RAYS }> {
        // from a height of exactly 1, so that all faces are exactly 1 away and the first of them is found
        let origins: ArrayVec<DVec3, { RayCaster::MOST_RAYS }> = places.iter().map(|place| place.extend(1.0)).collect();
        let mut hits = [None; RayCaster::MOST_RAYS];
        self.flat.first_hits(&origins, &self.down, &mut hits);
        hits[..places.len()].iter().map(|hit| hit.map(|(at, _)| self.faces[at as usize])).collect()
    }

    /// What is seen along a ray, as [`FlushFaces::place`] takes it, if this face or the ground is nearest along it.
    pub fn seen(&self, nearest: u32, ray: (DVec3, DVec3)) -> u32 {
        self.place(nearest, ray).and_then(|place| self.first(&[place])[0]).unwrap_or(nearest)
    }
}
