//! Ray casting on the processor, in double precision: the truth that other techniques are compared with, and the engine
//! on machines without a GPU.
//!
//! Intersection after Woop, Benthin and Wald, *Watertight Ray/Triangle Intersection* (JCGT 2013): the triangle is
//! sheared so that the ray is an axis, and the signs of three areas decide. A ray through a shared edge or corner
//! computes the same areas for both faces and hits at least one. Areas of exactly 0 count as hits. The tree and its
//! SIMD ([`super::rays`]) only exclude: boxes are padded beyond all rounding, and a triangle is skipped only if no
//! rounding could make it a hit. Squares of eight by eight cells are traced at once, as a beam of parallel rays.

use super::flush::FlushFaces;
use super::view_rays::Rays;
use super::{
    DifferingCells, DrawnMask, JUDGED_ABOVE_M, LightChange, Scene, ShadowError, SingleCells, Technique, seen_normal,
};
use crate::mesh::Mesh;
use crate::sun::disc;
use crate::view::{Mask, Surface, Tile, View};
use arrayvec::ArrayVec;
use glam::{DVec2, DVec3, DVec4};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

#[doc(hidden)]
pub use super::rays::{RayCaster, Shear};
pub(super) use super::view_rays::{TIE, reach};

/// The side of the squares of cells that are traced together: as many rays as a beam has.
const SIDE: usize = 8;
/// The cells in a square.
const SQUARE: usize = SIDE * SIDE;

/// Where a cell's ray from the viewer ends.
#[derive(Clone, Copy)]
pub(super) struct RayEnd {
    /// A face of the receivers, or [`Surface::GROUND`], or [`Surface::SKY`]: the nearest, which is judged.
    pub(super) face: u32,
    /// The same as it is shown: where faces are flush with the ground, the first of them.
    shown: u32,
    /// The distance along the cell's ray, metres.
    pub(super) distance: f64,
}

impl RayEnd {
    const SKY: RayEnd = RayEnd::of(Surface::SKY, f64::INFINITY);

    const fn of(face: u32, distance: f64) -> RayEnd {
        RayEnd { face, shown: face, distance }
    }
}

/// The technique: one ray per cell to what is seen, once, and one ray per cell towards the sun at every instant.
pub struct RayCast {
    scene: Scene,
    rays: Rays,
    /// The same tree as the casters' if the same faces receive and cast.
    receivers: Arc<RayCaster>,
    casters: Arc<RayCaster>,
    flush: Option<FlushFaces>,
    seen: Vec<RayEnd>,
    mask: Mask,
    sun_samples: Option<u32>,
}

impl RayCast {
    /// Builds the trees and finds what the cells see. Rays go to `sun_samples` points of the sun's disc, or to its
    /// centre.
    pub fn new(scene: Scene, view: View, sun_samples: Option<u32>) -> RayCast {
        let size = view.size();
        Self::of_part(scene, view, ([0, 0], size.into()), sun_samples)
    }

    /// The same for a single tile of a plan.
    pub fn of_tile(scene: Scene, tile: Tile, sun_samples: Option<u32>) -> RayCast {
        Self::of_part(scene, View::Plan(tile.plan), (tile.first, tile.size), sun_samples)
    }

    fn of_part(scene: Scene, view: View, part: ([u32; 2], [u32; 2]), sun_samples: Option<u32>) -> RayCast {
        let reach = reach(&scene, &view);
        let receivers = Arc::new(RayCaster::new(&scene.receivers, reach));
        let casters = if same_faces(&scene.receivers, &scene.casters) {
            Arc::clone(&receivers)
        } else {
            Arc::new(RayCaster::new(&scene.casters, reach))
        };
        let mask = Mask { width: 0, height: 0, share: Vec::new() };
        let rays = Rays::new(&scene, view);
        let flush = FlushFaces::new(&scene.receivers, scene.ground);
        let mut cast = RayCast { scene, rays, receivers, casters, flush, seen: Vec::new(), mask, sun_samples };
        cast.look_at_part(view, part);
        cast
    }

    /// The face that each cell sees, as in [`Surface::face`]: flush ones before the ground.
    #[doc(hidden)]
    pub fn faces(&self) -> Vec<u32> {
        self.seen.par_iter().map(|seen| seen.shown).collect()
    }

    /// The view.
    pub fn view(&self) -> View {
        self.rays.view
    }

    /// Turns to another view, whose rays must not begin farther away than those of the first view.
    pub fn look_at(&mut self, view: View) {
        let size = view.size();
        self.look_at_part(view, ([0, 0], size.into()));
    }

    /// Looks at a part of a view's cells: the first column and row, and the size.
    fn look_at_part(&mut self, view: View, (first, [width, height]): ([u32; 2], [u32; 2])) {
        self.rays = Rays::of_part(&self.scene, view, first);
        let mut ends = vec![RayEnd::SKY; width as usize * height as usize];
        let parallel = self.rays.shared_direction().map(Shear::along);
        ends.par_chunks_mut(width as usize * SIDE).enumerate().for_each(|(band, ends)| {
            match &parallel {
                Some(shear) => self.look_along(shear, [width as usize, band * SIDE], ends),
                None => {
                    for (at, end) in ends.iter_mut().enumerate() {
                        let ray = self.rays.of(at as u32 % width, (band * SIDE) as u32 + at as u32 / width);
                        *end = seen(&self.scene, &view, ray, self.receivers.first_hit(ray.0, ray.1));
                    }
                }
            }
            self.show_flush([width as usize, band * SIDE], ends);
        });
        self.mask = Mask { width, height, share: vec![255; ends.len()] };
        self.seen = ends;
    }

    /// Traces parallel rays for some rows: their width, and the first one.
    fn look_along(&self, shear: &Shear, [width, first_row]: [usize; 2], ends: &mut [RayEnd]) {
        for square in squares(width, ends.len()) {
            let mut rays = ArrayVec::<(DVec3, DVec3), SQUARE>::new();
            let mut origins = ArrayVec::<DVec3, SQUARE>::new();
            for Cell { column, row, .. } in square.clone() {
                let ray = self.rays.of(column, first_row as u32 + row);
                rays.push(ray);
                origins.push(ray.0);
            }
            let mut hits = [None; SQUARE];
            self.receivers.first_hits(&origins, shear, &mut hits);
            for ((Cell { at, .. }, ray), hit) in square.zip(rays).zip(hits) {
                ends[at] = seen(&self.scene, &self.rays.view, ray, hit);
            }
        }
    }

    /// Shows flush faces before the plane in which they lie, in the cells of some rows: how wide they are, and the first one.
    fn show_flush(&self, [width, first_row]: [usize; 2], ends: &mut [RayEnd]) {
        let Some(flush) = &self.flush else { return };
        for square in squares(width, ends.len()) {
            let mut of = ArrayVec::<usize, SQUARE>::new();
            let mut places = ArrayVec::<DVec2, SQUARE>::new();
            for Cell { at, column, row } in square {
                if let Some(place) = flush.place(ends[at].face, self.rays.of(column, first_row as u32 + row)) {
                    of.push(at);
                    places.push(place);
                }
            }
            for (at, first) in of.into_iter().zip(flush.first(&places)) {
                ends[at].shown = first.unwrap_or(ends[at].face);
            }
        }
    }

    /// What the cells see, row 0 first.
    pub(super) fn seen(&self) -> &[RayEnd] {
        &self.seen
    }

    /// A cell's ray: its start relative to the scene's origin, and its unit direction.
    pub(super) fn ray(&self, column: u32, row: u32) -> (DVec3, DVec3) {
        self.rays.of(column, row)
    }

    /// The directions of rays: to the sun's centre, or to points of its disc.
    pub(super) fn suns(&self, to_sun: DVec3) -> Vec<(DVec3, Shear)> {
        let points = self.sun_samples.map_or(vec![to_sun], |samples| disc(to_sun, samples).collect());
        points.into_iter().map(|to_point| (to_point, Shear::along(to_point))).collect()
    }

    /// The share of those that a cell sees.
    pub(super) fn share(&self, at: usize, suns: &[(DVec3, Shear)]) -> u8 {
        let cell = Cell { at, column: at as u32 % self.mask.width, row: at as u32 / self.mask.width };
        let Some((judged, normal)) = self.judged(&mut self.normals(), cell) else { return 255 };
        let lit =
            |(to_point, shear): &&(DVec3, Shear)| normal.dot(*to_point) > 0.0 && !self.casters.blocked(judged, shear);
        share_of(suns.iter().filter(lit).count(), suns.len())
    }

    /// Where a cell is judged, and the normal of what it sees; `None` if nothing there could be in shadow.
    #[inline(always)]
    fn judged(&self, normals: &mut SeenNormals<'_>, Cell { at, column, row }: Cell) -> Option<(DVec3, DVec3)> {
        let RayEnd { face, distance, .. } = self.seen[at];
        // cut earth is not judged either
        if face == Surface::SKY || (face == Surface::GROUND && self.rays.is_cut(distance)) {
            return None;
        }
        let normal = normals.of(face);
        let (from, along) = self.rays.of(column, row);
        Some((from + along * distance + normal * JUDGED_ABOVE_M, normal))
    }

    /// The shares for the cells of some rows: as [`RayCast::share`], but for squares of cells at once.
    fn share_rows(&self, first_row: usize, shares: &mut [u8], suns: &[(DVec3, Shear)]) {
        let width = self.mask.width as usize;
        let mut normals = self.normals();
        for square in squares(width, shares.len()) {
            let mut judged = ArrayVec::<(usize, DVec3, DVec3), SQUARE>::new();
            for Cell { at, column, row } in square {
                shares[at] = 255;
                let cell = Cell { at: first_row * width + at, column, row: first_row as u32 + row };
                if let Some((point, normal)) = self.judged(&mut normals, cell) {
                    judged.push((at, point, normal));
                }
            }
            let mut lit = [0; SQUARE];
            for (to_point, shear) in suns {
                let mut origins = ArrayVec::<DVec3, SQUARE>::new();
                let mut of = ArrayVec::<usize, SQUARE>::new();
                for (number, (_, point, normal)) in judged.iter().enumerate() {
                    if normal.dot(*to_point) > 0.0 {
                        origins.push(*point);
                        of.push(number);
                    }
                }
                let blocked = self.casters.blocked_beam(&origins, shear);
                for (ray, number) in of.into_iter().enumerate() {
                    lit[number] += usize::from(blocked >> ray & 1 == 0);
                }
            }
            for ((at, ..), lit) in judged.into_iter().zip(lit) {
                shares[at] = share_of(lit, suns.len());
            }
        }
    }

    /// The normals of the faces' visible sides, and of the ground's.
    fn normals(&self) -> SeenNormals<'_> {
        let RayCast { scene, rays, .. } = self;
        let origin = scene.casters.origin;
        let world_viewer = rays.view.viewer();
        let viewer = world_viewer - DVec4::from((origin, 0.0)) * world_viewer.w;
        let ground = seen_normal(DVec4::new(0.0, 0.0, 1.0, origin.z - scene.ground), viewer);
        SeenNormals { planes: scene.receivers.planes(), viewer, ground, last: (Surface::GROUND, ground) }
    }

    /// The number of rays of a mask: one for each point of the sun and each cell whose visible side faces it.
    #[cfg(feature = "test-hooks")]
    pub fn rays(&self, to_sun: DVec3) -> usize {
        let suns = self.suns(to_sun);
        let mut normals = self.normals();
        let of_cell = |seen: &RayEnd| {
            if seen.face == Surface::SKY {
                return 0;
            }
            let normal = normals.of(seen.face);
            suns.iter().filter(|(to_point, _)| normal.dot(*to_point) > 0.0).count()
        };
        self.seen.iter().map(of_cell).sum()
    }

    /// The share of the sun's centre that a cell sees, found by testing every face without the trees. It is slow, and
    /// tests the trees themselves.
    #[doc(hidden)]
    pub fn share_without_trees(&self, column: u32, row: u32, to_sun: DVec3) -> u8 {
        let RayCast { scene, rays, .. } = self;
        let hits = |mesh: &Mesh, from: DVec3, shear: &Shear| -> Vec<(u32, f64)> {
            let hit = |face: u32| Some((face, shear.hit(from, &mesh.corners(face as usize))?));
            (0..mesh.faces.len() as u32).filter_map(hit).collect()
        };
        let (from, along) = rays.of(column, row);
        let faces = hits(&scene.receivers, from, &Shear::along(along));
        let first = faces.into_iter().min_by(|(_, one), (_, other)| one.total_cmp(other));
        let RayEnd { face, distance, .. } = seen(scene, &rays.view, (from, along), first);
        if face == Surface::SKY || (face == Surface::GROUND && rays.is_cut(distance)) {
            return 255;
        }
        let normal = self.normals().of(face);
        let judged = from + along * distance + normal * JUDGED_ABOVE_M;
        let lit = normal.dot(to_sun) > 0.0 && hits(&scene.casters, judged, &Shear::along(to_sun)).is_empty();
        if lit { 255 } else { 0 }
    }
}

/// The visible share of the sun, rounded.
fn share_of(lit: usize, suns: usize) -> u8 {
    ((2 * 255 * lit + suns) / (2 * suns)) as u8
}

fn same_faces(one: &Mesh, other: &Mesh) -> bool {
    one.origin == other.origin && one.faces == other.faces && one.vertices == other.vertices
}

/// Computes normals, and caches the last one, as neighbours mostly see the same face.
struct SeenNormals<'a> {
    planes: &'a [DVec4],
    viewer: DVec4,
    ground: DVec3,
    last: (u32, DVec3),
}

impl SeenNormals<'_> {
    #[inline]
    fn of(&mut self, face: u32) -> DVec3 {
        if face != self.last.0 {
            let normal = if face == Surface::GROUND {
                self.ground
            } else {
                seen_normal(self.planes[face as usize], self.viewer)
            };
            self.last = (face, normal);
        }
        self.last.1
    }
}

/// A cell of some rows: its index and position.
#[derive(Clone, Copy)]
struct Cell {
    at: usize,
    column: u32,
    row: u32,
}

/// The cells of up to [`SIDE`] rows in squares, from west to east.
fn squares(width: usize, cells: usize) -> impl Iterator<Item = impl Iterator<Item = Cell> + Clone> {
    (0..width).step_by(SIDE).map(move |west| {
        let east = (west + SIDE).min(width);
        (0..cells / width).flat_map(move |row| {
            (west..east).map(move |column| Cell { at: row * width + column, column: column as u32, row: row as u32 })
        })
    })
}

/// What a ray sees, given its first hit.
fn seen(scene: &Scene, view: &View, ray: (DVec3, DVec3), first_hit: Option<(u32, f64)>) -> RayEnd {
    let (origin, direction) = ray;
    // a horizontal ray that begins below the ground sees the cut earth
    if direction.z == 0.0 && origin.z + scene.casters.origin.z < scene.ground {
        return RayEnd::of(Surface::GROUND, 0.0);
    }
    let to_ground = (scene.ground - scene.casters.origin.z - origin.z) / direction.z;
    // rays of the sun come from far away, and what begins below the ground has met it before
    let is_before = to_ground > 0.0 || matches!(view, View::Elevation(side) if !side.is_level());
    let ground = if is_before && to_ground.is_finite() { RayEnd::of(Surface::GROUND, to_ground) } else { RayEnd::SKY };
    match first_hit {
        Some((face, distance)) if distance <= ground.distance => RayEnd::of(face, distance),
        _ => ground,
    }
}

impl Technique for RayCast {
    fn draw(&mut self, to_sun: DVec3) -> Result<DrawnMask<'_>, ShadowError> {
        let suns = self.suns(to_sun);
        let mut share = std::mem::take(&mut self.mask.share);
        let width = self.mask.width as usize;
        let bands = share.par_chunks_mut(width * SIDE).enumerate();
        bands.for_each(|(band, shares)| self.share_rows(band * SIDE, shares, &suns));
        self.mask.share = share;
        Ok(DrawnMask::Memory(&self.mask))
    }

    fn single_cells(&self) -> Option<SingleCells> {
        Some(SingleCells::All)
    }

    /// To the sun's centre: of its disc no changes are searched.
    fn changes(&mut self, cells: &DifferingCells<'_>, rows: Range<usize>) -> Result<Vec<LightChange>, ShadowError> {
        let width = self.mask.width as usize;
        let judged = |row: usize, column: usize| {
            let cell = Cell { at: row * width + column, column: column as u32, row: row as u32 };
            self.judged(&mut self.normals(), cell)
        };
        Ok(cells.search(rows, &self.casters, judged))
    }

    fn turn_to_tile(&mut self, tile: Tile) -> Result<bool, ShadowError> {
        let view = View::Plan(tile.plan);
        if view != self.rays.view {
            return Ok(false);
        }
        self.look_at_part(view, (tile.first, tile.size));
        Ok(true)
    }

    fn surface(&self) -> Result<Surface, ShadowError> {
        let Mask { width, height, .. } = self.mask;
        let height_of = |(at, seen): (usize, &RayEnd)| {
            let (origin, direction) = self.rays.of(at as u32 % width, at as u32 / width);
            if seen.face == Surface::SKY {
                f32::NAN
            } else {
                (origin.z + direction.z * seen.distance + self.scene.casters.origin.z) as f32
            }
        };
        Ok(Surface {
            width,
            height,
            face: self.faces(),
            height_m: self.seen.par_iter().enumerate().map(height_of).collect(),
        })
    }
}
