//! Collects the faces of an entity in its layer.

use super::drawing::LayerTriangles;
use crate::formats::face_cutter::{FaceCutter, Uncut};
use crate::formats::left_out::LeftOutTally;
use glam::DVec3;

/// Where an entity's faces go.
pub(super) struct EntityFaces<'a> {
    into: &'a mut LayerTriangles,
    cutter: &'a mut FaceCutter,
    left_out: &'a mut LeftOutTally,
    ring: Vec<DVec3>,
}

impl<'a> EntityFaces<'a> {
    pub(super) fn new(
        into: &'a mut LayerTriangles,
        cutter: &'a mut FaceCutter,
        left_out: &'a mut LeftOutTally,
    ) -> Self {
        Self { into, cutter, left_out, ring: Vec::new() }
    }

    /// Adds a face. Consecutive corners at the same point count as one.
    pub(super) fn face(&mut self, corners: &[DVec3]) {
        self.ring.clear();
        self.ring.extend_from_slice(corners);
        self.ring.dedup();
        while self.ring.len() > 1 && self.ring.first() == self.ring.last() {
            self.ring.pop();
        }
        let triangles = match self.cutter.cut(&self.ring, &[self.ring.len()]) {
            Ok(cut) => cut.triangles,
            // an entity without any area is reported as a whole
            Err(Uncut::NoArea) => return,
            Err(uncut) => return self.left_out.add("faces", uncut.why()),
        };
        // cannot overflow: a file of 4 GiB has fewer corners
        let first = self.into.positions.len() as u32;
        self.into.triangles.extend(triangles.iter().map(|triangle| triangle.map(|corner| first + corner)));
        self.into.positions.extend_from_slice(&self.ring);
    }
}
