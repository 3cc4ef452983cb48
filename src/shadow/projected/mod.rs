//! Projected shadows: exact hard shadows on a plan, the fastest of all on the processor; and those of the ground by the
//! graphics adapter.
//!
//! J. Blinn, *Me and My (Fake) Shadow*, 1988; seed 002 calls the same a hard shadow. The shadow on a flat receiver is the
//! union of the casters' faces, cut at the height that is judged and projected along the sun. `flat` finds
//! it on the ground from the silhouette alone: no rays, no volumes, no tree, and nothing that a raster rounds. What stands
//! above the ground is no flat receiver; its cells are judged one by one on the same raster, by `raised`.

mod on_gpu;

pub use on_gpu::ProjectedOnGpu;

use super::flat::FlatShadow;
use super::plan_surface::plan_surface;
use super::raised::Raised;
use super::ray_cast::TIE;
use super::{DrawnMask, JUDGED_ABOVE_M, Scene, ShadowError, Technique};
use crate::mesh::Mesh;
use crate::view::{Grid, Surface};
use glam::{DAffine3, DMat3, DVec2, DVec3};

/// The technique, made for one scene and one plan.
pub struct Projected {
    shadow: FlatShadow,
    raised: Raised,
    receivers: Mesh,
    ground: f64,
    grid: Grid,
}

impl Projected {
    /// Cuts the casters at the height at which the ground is judged, and looks down on the receivers.
    pub fn new(scene: &Scene, grid: Grid) -> Projected {
        let Scene { casters, receivers, ground } = scene;
        let raster_from_local = raster_from_local(scene, &grid);
        let shadow = FlatShadow::new(casters, raster_from_local, grid.width, grid.height);
        let raised = Raised::new(scene, &grid, &raster_from_local);
        Projected { shadow, raised, receivers: receivers.clone(), ground: *ground, grid }
    }
}

impl Technique for Projected {
    fn draw(&mut self, to_sun: DVec3) -> Result<DrawnMask<'_>, ShadowError> {
        self.shadow.draw(to_sun);
        let throw = self.shadow.throw(to_sun);
        let (bits, places, points) = self.shadow.drawn();
        self.raised.draw(to_sun, throw, places, points, bits);
        Ok(DrawnMask::Bits(bits))
    }

    fn surface(&self) -> Result<Surface, ShadowError> {
        Ok(plan_surface(&self.receivers, self.ground, &self.grid))
    }
}

/// Metres around the casters' origin → columns, rows and metres above the height at which the ground is judged. Centres of
/// cells are whole numbers.
fn raster_from_local(scene: &Scene, grid: &Grid) -> DAffine3 {
    // cells a metre, east and south
    let scale = DVec2::new(1.0, -1.0) / grid.cell;
    let corner = DVec2::new(grid.west, grid.north);
    // as for rays, what lies east of an edge through a centre counts, then what lies south
    let tie = DVec2::new(TIE.x, -TIE.y);
    let origin = scene.casters.origin;
    let place = (origin.truncate() - corner) * scale - 0.5 - tie;
    let height = origin.z - (scene.ground + JUDGED_ABOVE_M);
    DAffine3 { matrix3: DMat3::from_diagonal(scale.extend(1.0)), translation: place.extend(height) }
}
