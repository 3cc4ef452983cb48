//! Projected shadows: exact hard shadows on the ground, on the processor, and the fastest of all.
//!
//! J. Blinn, *Me and My (Fake) Shadow*, 1988; seed 002 calls the same a hard shadow. The shadow on a flat receiver is the
//! union of the casters' faces, projected along the sun, so every face is cut at the height that is judged, projected and
//! scan-converted in double precision: no rays, no volumes, no tree. Which side of a face the sun sees does not matter, so
//! casters need not be clean.
//!
//! A cell is covered where its centre lies in a face or on its edge, by [`crate::mesh::scan`].

use super::registered::{self, Place, Raster, Registered};
use super::{DrawnMask, JUDGED_ABOVE_M, Scene, ShadowError, Technique};
use crate::mesh::Mesh;
use crate::mesh::scan::Bits;
use crate::view::{Grid, Mask, Surface};
use glam::{DVec3, DVec4};
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

    /// The plan, around the mesh's origin.
    fn raster(&self) -> Raster {
        let judged_z = self.ground + JUDGED_ABOVE_M - self.casters.origin.z;
        Raster {
            corner: DVec3::new(self.grid.west, self.grid.north, self.ground) - self.casters.origin,
            right: DVec3::X,
            down: DVec3::NEG_Y,
            cell: self.grid.cell,
            plane: DVec4::new(0.0, 0.0, 1.0, -judged_z),
        }
    }

    /// Which cells the faces cover, seen along the sun.
    fn covered(&self, to_sun: DVec3) -> Bits {
        let Some(onto) = Registered::new(&self.raster(), to_sun.extend(0.0)) else {
            return Bits::empty(self.grid.width, self.grid.height);
        };
        let places: Vec<Place> = self.casters.vertices.par_iter().map(|vertex| onto.place(vertex.as_dvec3())).collect();
        let empty = || Bits::empty(self.grid.width, self.grid.height);
        let faces = self.casters.faces.par_iter().with_min_len(LEAST_FACES);
        let drawn = faces.fold(empty, |mut bits, face| {
            registered::part(face.map(|vertex| places[vertex as usize])).cover(&mut bits);
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
