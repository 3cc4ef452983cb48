//! Fills the hard shadows of one sample on one patch, on the processor, in double precision.
//!
//! - [`Fill::Faces`] fills every face, one bit per cell: the plain twin.
//! - [`Fill::Silhouettes`] is the edge-flag fill (section 4.3.1 of M. Herf's paper, after Ackland and Weste, 1981) of
//!   silhouettes (4.3.3). In every row each edge marks the cell at which the layers of its faces begin or end; a running
//!   sum over the row then gives the number of layers before each cell. An edge counts by the sum of its faces'
//!   directions: ±2 between two faces of one side, ±1 at a border, 0 inside. The paper stores events by light in each
//!   cell; we add one sample's events at once, so that an event is a number and needs no allocation.
//!
//! Both cut faces at the judged plane in the same way. A face that is cut marks its own border, the section included;
//! where it meets a face that is not cut, their marks fall into the same cells and cancel in the sum.

use super::occluders::Occluders;
use crate::mesh::Mesh;
use crate::mesh::scan::{Coverage, TriangleSide};
use crate::shadow::rays::{BlockedCells, CellSet};
use crate::shadow::registered::{self, ClippedFace, ProjectedVertex, RasterProjection};
use glam::DVec2;

/// How the processor fills hard shadows; the results are the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fill {
    /// Every face.
    Faces,
    /// Silhouettes by edge flags.
    Silhouettes,
}

/// Buffers for filling, which are reused.
#[derive(Default)]
pub(super) struct Scratch {
    pub(super) waiting: Vec<u32>,
    /// The last sample's occluders.
    pub(super) found: Vec<u32>,
    /// For each edge of the mesh, the sum of its faces' directions; all 0 between patches.
    multiplicity: Vec<i32>,
    /// The edges whose sums were changed.
    touched: Vec<u32>,
    /// Which texels of a patch are asked, and which of them are blocked.
    pub(super) asked: CellSet,
    pub(super) blocked: BlockedCells,
    /// Events, row by row, with one cell more than the patch's columns.
    events: Vec<i32>,
}

/// The covered cells of a patch.
pub(super) enum CoveredCells<'a> {
    Bits(Coverage),
    /// The number of layers, row by row; a row has one number more than the patch has columns.
    Layers(&'a [i32], usize),
}

impl CoveredCells<'_> {
    pub(super) fn at(&self, column: u32, row: u32) -> bool {
        match self {
            CoveredCells::Bits(bits) => bits.get(column, row),
            CoveredCells::Layers(layers, in_row) => layers[row as usize * in_row + column as usize] != 0,
        }
    }
}

/// The casters, as filling needs them.
pub(super) struct CasterFaces<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) occluders: &'a Occluders,
}

impl CasterFaces<'_> {
    /// Fills the shadow of the faces in `scratch.found` on a raster of this size.
    pub(super) fn covered<'a>(
        &self,
        fill: Fill,
        onto: &RasterProjection,
        (width, height): (u32, u32),
        scratch: &'a mut Scratch,
    ) -> CoveredCells<'a> {
        match fill {
            Fill::Faces => {
                let mut bits = Coverage::empty(width, height);
                for &at in &scratch.found {
                    registered::part(self.places(onto, at)).cover(&mut bits);
                }
                CoveredCells::Bits(bits)
            }
            Fill::Silhouettes => self.layers(onto, (width, height), scratch),
        }
    }

    fn places(&self, onto: &RasterProjection, at: u32) -> [ProjectedVertex; 3] {
        self.occluders.corners[at as usize].map(|corner| onto.place(corner.as_dvec3()))
    }

    fn layers<'a>(
        &self,
        onto: &RasterProjection,
        (width, height): (u32, u32),
        scratch: &'a mut Scratch,
    ) -> CoveredCells<'a> {
        let in_row = width as usize + 1;
        let Scratch { found, multiplicity, touched, events, .. } = scratch;
        multiplicity.resize(self.mesh.edges.len(), 0);
        events.clear();
        events.resize(in_row * height as usize, 0);
        let mut raster = Events { events, in_row, width: width.into(), height: height.into() };
        for &at in found.iter() {
            let places = self.places(onto, at);
            if places.iter().all(|place| place.height <= 0.0) {
                continue;
            }
            let [a, b, c] = places.map(|place| place.at);
            // the sign of its visible area says whether the face is turned to the light
            let facing = if a.dot(b.cross(c)) < 0.0 { -1 } else { 1 };
            if registered::is_whole(&places) {
                for side in self.occluders.sides[self.occluders.faces[at as usize] as usize] {
                    let edge = side >> 1;
                    let sum = &mut multiplicity[edge as usize];
                    *sum += if side & 1 == 0 { facing } else { -facing };
                    touched.push(edge);
                }
            } else {
                raster.mark_part(&registered::part(places), facing);
            }
        }
        for edge in touched.drain(..) {
            // an edge is visited once for each of its faces
            let sum = std::mem::take(&mut multiplicity[edge as usize]);
            if sum != 0 {
                let [from, to] = self.mesh.edges[edge as usize].map(|vertex| {
                    let place = onto.place(self.mesh.vertices[vertex as usize].as_dvec3());
                    place.at.truncate() / place.at.z
                });
                raster.mark(from, to, sum);
            }
        }
        for row in raster.events.chunks_exact_mut(in_row) {
            let mut layers = 0;
            for cell in row {
                layers += *cell;
                *cell = layers;
            }
        }
        CoveredCells::Layers(events, in_row)
    }
}

/// Where layers begin and end.
struct Events<'a> {
    events: &'a mut [i32],
    in_row: usize,
    width: i64,
    height: i64,
}

impl Events<'_> {
    fn mark_part(&mut self, part: &ClippedFace, facing: i32) {
        let points = part.points();
        for (at, from) in points.iter().enumerate() {
            self.mark(*from, points[(at + 1) % points.len()], facing);
        }
    }

    /// Marks the rows that an edge crosses, with the multiplicity `times`; the inside is on its left as rows go down.
    /// Edges left of the raster are marked at its left border (section 4.3.1, clipping).
    fn mark(&mut self, from: DVec2, to: DVec2, times: i32) {
        let (top, bottom, times) = if from.y < to.y { (from, to, -times) } else { (to, from, times) };
        // a row belongs to the edge whose upper end it touches
        let first = top.y.ceil().max(0.0);
        let last = (bottom.y.ceil() - 1.0).min((self.height - 1) as f64);
        let is_crossed = first <= last && top.x.min(bottom.x) <= self.width as f64;
        if !is_crossed {
            return;
        }
        let side = TriangleSide::between(top, bottom);
        for row in first as i64..=last as i64 {
            let column = side.x_at(row as f64).ceil().clamp(0.0, self.width as f64);
            self.events[row as usize * self.in_row + column as usize] += times;
        }
    }
}
