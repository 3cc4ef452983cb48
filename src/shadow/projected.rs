//! Projected shadows: exact hard shadows on the ground, on the processor, and the fastest of all.
//!
//! J. Blinn, *Me and My (Fake) Shadow*, 1988; seed 002 calls the same a hard shadow. The shadow on a flat receiver is the
//! union of the casters' faces, projected along the sun, so every face is cut at the height that is judged, projected and
//! scan-converted in double precision: no rays, no volumes, no tree. Which side of a face the sun sees does not matter, so
//! casters need not be clean.
//!
//! A cell is covered where its centre lies in a face or on its edge, by [`crate::mesh::scan`].

use super::ray_cast::TIE;
use super::{DrawnMask, JUDGED_ABOVE_M, Scene, ShadowError, Technique};
use crate::mesh::Mesh;
use crate::mesh::scan::Bits;
use crate::view::{Grid, Mask, Surface};
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// The technique, made for the casters of one scene and the ground under one plan. What else receives is not judged.
pub struct Projected {
    casters: Mesh,
    ground: f64,
    grid: Grid,
    mask: Mask,
}

/// Faces a task: enough that its own raster costs nothing beside them.
const LEAST_FACES: usize = 1 << 14;

impl Projected {
    /// Nothing is prepared.
    pub fn new(scene: Scene, grid: Grid) -> Projected {
        let mask = Mask { width: grid.width, height: grid.height, share: vec![0; grid.cells()] };
        Projected { casters: scene.casters, ground: scene.ground, grid, mask }
    }

    /// Which cells the faces cover, seen along the sun.
    fn covered(&self, to_sun: DVec3) -> Bits {
        let onto = Onto::new(&self.grid, self.casters.origin, self.ground + JUDGED_ABOVE_M, to_sun);
        let places: Vec<Place> = self.casters.vertices.par_iter().map(|vertex| onto.place(vertex.as_dvec3())).collect();
        let empty = || Bits::empty(self.grid.width, self.grid.height);
        let faces = self.casters.faces.par_iter().with_min_len(LEAST_FACES);
        let drawn = faces.fold(empty, |mut bits, face| {
            cover_face(&mut bits, face.map(|vertex| places[vertex as usize]));
            bits
        });
        drawn.reduce(empty, Bits::or)
    }
}

impl Technique for Projected {
    fn draw(&mut self, to_sun: DVec3) -> Result<DrawnMask<'_>, ShadowError> {
        let covered = self.covered(to_sun);
        let rows =
            self.mask.share.par_chunks_mut(self.grid.width as usize).zip(covered.words.par_chunks(covered.in_row));
        rows.for_each(|(shares, words)| {
            for (shares, word) in shares.chunks_mut(64).zip(words) {
                for (at, share) in shares.iter_mut().enumerate() {
                    *share = if word >> at & 1 == 1 { 0 } else { 255 };
                }
            }
        });
        Ok(DrawnMask::Memory(&self.mask))
    }

    fn surface(&self) -> Result<Surface, ShadowError> {
        let cells = self.grid.cells();
        Ok(Surface {
            width: self.grid.width,
            height: self.grid.height,
            face: vec![Surface::GROUND; cells],
            height_m: vec![self.ground as f32; cells],
        })
    }
}

/// A vertex seen along the sun.
#[derive(Clone, Copy)]
struct Place {
    /// Where it falls, in cells from the grid's north-west corner, such that centres are whole numbers.
    at: DVec2,
    /// How high above the judged height it stands, metres.
    height: f64,
}

/// From vertices to where they fall.
struct Onto {
    /// The mesh's origin, in cells and metres.
    origin: DVec2,
    judged_z: f64,
    /// Cells a metre, east and south.
    scale: DVec2,
    /// Metres of shadow a metre of height.
    throw: DVec2,
}

impl Onto {
    fn new(grid: &Grid, origin: DVec3, judged: f64, to_sun: DVec3) -> Onto {
        let scale = DVec2::new(1.0, -1.0) / grid.cell;
        let corner = DVec2::new(grid.west, grid.north);
        // as for rays, what lies east of an edge through a centre counts, then what lies south
        let tie = DVec2::new(TIE.x, -TIE.y);
        Onto {
            origin: (origin.truncate() - corner) * scale - 0.5 - tie,
            judged_z: judged - origin.z,
            scale,
            throw: to_sun.truncate() / to_sun.z.max(1e-9),
        }
    }

    fn place(&self, vertex: DVec3) -> Place {
        let height = vertex.z - self.judged_z;
        Place { at: self.origin + (vertex.truncate() - self.throw * height) * self.scale, height }
    }
}

/// Covers what a face does, cut at the judged height: the part above it is a triangle, or a quadrilateral.
fn cover_face(bits: &mut Bits, face: [Place; 3]) {
    let above = face.map(|place| place.height > 0.0);
    match above.iter().filter(|above| **above).count() {
        0 => {}
        3 => bits.cover(face.map(|place| place.at)),
        count => {
            // turned so that the one that stands alone on its side is first
            let alone = (0..3).find(|&at| above[at] == (count == 1)).unwrap_or(0);
            let [one, next, last] = [face[alone], face[(alone + 1) % 3], face[(alone + 2) % 3]];
            let (to_next, to_last) = (cut(one, next), cut(one, last));
            if count == 1 {
                bits.cover([one.at, to_next, to_last]);
            } else {
                bits.cover([to_next, next.at, last.at]);
                bits.cover([to_next, last.at, to_last]);
            }
        }
    }
}

/// Where the line between two vertices crosses the judged height. The same whichever is named first.
fn cut(one: Place, other: Place) -> DVec2 {
    let (low, high) = if one.height < other.height { (one, other) } else { (other, one) };
    // projection is linear, below the judged height as well
    low.at + (high.at - low.at) * (-low.height / (high.height - low.height))
}
