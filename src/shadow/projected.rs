//! Projected shadows: exact hard shadows on the ground, on the processor, and the fastest of all.
//!
//! J. Blinn, *Me and My (Fake) Shadow*, 1988; seed 002 calls the same a hard shadow. The shadow on a flat receiver is the
//! union of the casters' faces, cut at the height that is judged and projected along the sun. [`flat`](super::flat) finds
//! it from the silhouette alone: no rays, no volumes, no tree, and nothing that a raster rounds.

use super::flat::FlatShadow;
use super::ray_cast::TIE;
use super::{DrawnMask, JUDGED_ABOVE_M, Scene, ShadowError, Technique};
use crate::view::{Grid, Surface};
use glam::{DAffine3, DMat3, DVec2, DVec3};

/// The technique, made for the casters of one scene and the ground under one plan. What else receives is not judged.
pub struct Projected {
    shadow: FlatShadow,
    ground: f64,
    grid: Grid,
}

impl Projected {
    /// Cuts the casters at the height that is judged.
    pub fn new(scene: &Scene, grid: Grid) -> Projected {
        let Scene { casters, ground, .. } = scene;
        // cells a metre, east and south
        let scale = DVec2::new(1.0, -1.0) / grid.cell;
        let corner = DVec2::new(grid.west, grid.north);
        // as for rays, what lies east of an edge through a centre counts, then what lies south
        let tie = DVec2::new(TIE.x, -TIE.y);
        let origin = (casters.origin.truncate() - corner) * scale - 0.5 - tie;
        let height = casters.origin.z - (ground + JUDGED_ABOVE_M);
        let raster_from_local =
            DAffine3 { matrix3: DMat3::from_diagonal(scale.extend(1.0)), translation: origin.extend(height) };
        let shadow = FlatShadow::new(casters, raster_from_local, grid.width, grid.height);
        Projected { shadow, ground: *ground, grid }
    }
}

impl Technique for Projected {
    fn draw(&mut self, to_sun: DVec3) -> Result<DrawnMask<'_>, ShadowError> {
        Ok(DrawnMask::Bits(self.shadow.draw(to_sun)))
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
