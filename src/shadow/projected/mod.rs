//! Projected shadows: exact hard shadows on a plane, by far the fastest on the processor. On the ground the graphics
//! adapter can draw them, too.
//!
//! J. Blinn, *Me and My (Fake) Shadow*, 1988; M. Herf's *Efficient Generation of Soft Shadow Textures*, 1997, adds up
//! such shadows. The shadow on a flat receiver is the union of the casters' faces, cut at the judged height and
//! projected along the sun. `flat` finds it on the ground from the silhouette alone: without rays, volumes or trees,
//! and without raster rounding. What stands above the ground is not one flat receiver; `raised` judges its cells one by
//! one on the same raster.

mod on_gpu;

pub use on_gpu::ProjectedOnGpu;

use super::flat::FlatShadow;
use super::plan_surface::tile_surface;
use super::raised::{FallingShadow, RaisedCells};
use super::ray_cast::{RayCaster, TIE, reach};
use super::{DifferingCells, DrawnMask, JUDGED_ABOVE_M, LightChange, Scene, ShadowError, SingleCells, Technique};
use crate::view::{Grid, Surface, Tile, View};
use glam::{DAffine3, DMat3, DVec2, DVec3};
use std::ops::Range;

/// The technique, made for one scene and one plan, or a tile of it.
pub struct Projected {
    shadow: FlatShadow,
    raised: RaisedCells,
    scene: Scene,
    raster_from_local: DAffine3,
    tile: Tile,
    /// Made once single cells are searched.
    rays: Option<RayCaster>,
}

impl Projected {
    /// Cuts the casters at the height at which the ground is judged, and finds what the plan sees of the receivers.
    pub fn new(scene: &Scene, tile: impl Into<Tile>) -> Projected {
        let tile: Tile = tile.into();
        let raster_from_local = raster_from_local(scene, &tile.plan);
        let shadow = FlatShadow::new(&scene.casters, raster_from_local, tile.first, tile.size);
        let raised = RaisedCells::new(scene, tile, &raster_from_local);
        Projected { shadow, raised, scene: scene.clone(), raster_from_local, tile, rays: None }
    }

    /// Projects everything at every instant: the twin that tests culling.
    #[cfg(feature = "test-hooks")]
    pub fn without_culling(mut self) -> Projected {
        self.shadow.stop_culling();
        self
    }

    /// The work of the last instant.
    #[cfg(feature = "test-hooks")]
    pub fn work(&self) -> ProjectedWork {
        let [reaching, clumps, rows] = self.shadow.work();
        ProjectedWork { clumps, reaching, rows, points: self.raised.held() }
    }
}

/// The work of an instant.
#[cfg(feature = "test-hooks")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ProjectedWork {
    /// The number of clumps of casters.
    pub clumps: u64,
    /// The number of clumps whose shadows reach the drawn ground.
    pub reaching: u64,
    /// The number of rows that their silhouette crosses, each counted every time.
    pub rows: u64,
    /// The number of tests of points above the ground against faces.
    pub points: u64,
}

impl Technique for Projected {
    fn draw(&mut self, to_sun: DVec3) -> Result<DrawnMask<'_>, ShadowError> {
        self.shadow.draw(to_sun);
        let throw = self.shadow.throw(to_sun);
        let (bits, tops, clumps) = self.shadow.drawn();
        self.raised.draw(to_sun, &FallingShadow { tops, throw }, clumps, bits);
        Ok(DrawnMask::Bits(bits))
    }

    /// The cells above the ground, as the ground's shadow costs little.
    fn single_cells(&self) -> Option<SingleCells> {
        self.raised.cells().cloned().map(SingleCells::Some)
    }

    fn draw_whole(&mut self, to_sun: DVec3) -> Result<DrawnMask<'_>, ShadowError> {
        let bits = self.shadow.draw(to_sun);
        if let Some(above) = self.raised.cells() {
            bits.words.iter_mut().zip(&above.words).for_each(|(bits, above)| *bits &= !above);
        }
        Ok(DrawnMask::Bits(bits))
    }

    /// By rays: the buckets of a few points would not pay for the sorting of all faces. What the points see at the two
    /// instants is the buckets'; where a ray decides otherwise a change is found a moment earlier or later.
    fn changes(&mut self, cells: &DifferingCells<'_>, rows: Range<usize>) -> Result<Vec<LightChange>, ShadowError> {
        let Projected { raised, scene, raster_from_local, tile, rays, .. } = self;
        let rays = rays.get_or_insert_with(|| RayCaster::new(&scene.casters, reach(scene, &View::Plan(tile.plan))));
        let local_from_raster = raster_from_local.inverse();
        let judged = |row: usize, column: usize| {
            let (at, normal) = raised.judged(row, column);
            Some((local_from_raster.transform_point3(at), normal))
        };
        Ok(cells.search(rows, rays, judged))
    }

    fn turn_to_tile(&mut self, tile: Tile) -> Result<bool, ShadowError> {
        if tile.plan != self.tile.plan {
            return Ok(false);
        }
        self.shadow.turn_to(tile.first, tile.size);
        // frees the memory of the last tile before the next one's is allocated
        self.raised = RaisedCells::none(self.scene.casters.clone());
        self.raised = RaisedCells::new(&self.scene, tile, &self.raster_from_local);
        self.tile = tile;
        Ok(true)
    }

    fn surface(&self) -> Result<Surface, ShadowError> {
        Ok(tile_surface(&self.scene.receivers, self.scene.ground, self.tile))
    }
}

/// The transform from metres around the casters' origin to columns, rows and metres above the height at which the
/// ground is judged. Centres of cells are whole numbers.
fn raster_from_local(scene: &Scene, grid: &Grid) -> DAffine3 {
    // cells per metre, east and south
    let scale = DVec2::new(1.0, -1.0) / grid.cell;
    let corner = DVec2::new(grid.west, grid.north);
    // as in ray casting: what is east of an edge through a centre counts, then what is south of it
    let tie = DVec2::new(TIE.x, -TIE.y);
    let origin = scene.casters.origin;
    let place = (origin.truncate() - corner) * scale - 0.5 - tie;
    let height = origin.z - (scene.ground + JUDGED_ABOVE_M);
    DAffine3 { matrix3: DMat3::from_diagonal(scale.extend(1.0)), translation: place.extend(height) }
}
