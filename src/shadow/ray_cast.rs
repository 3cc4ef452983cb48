//! Ray casting on the processor, in double precision: the truth with which other techniques are compared, and the
//! engine where there is no GPU.
//!
//! Intersection after Woop, Benthin and Wald, *Watertight Ray/Triangle Intersection* (JCGT 2013): the triangle is sheared so
//! that the ray is an axis, and the signs of three areas decide; a ray through a shared edge or corner computes the same areas
//! for both faces and hits at least one. Areas of exactly 0 count as hits. The tree and its SIMD ([`super::rays`]) only rule
//! out: boxes are padded beyond all rounding, and a triangle is only left out where no rounding could make it a hit. Cells of
//! eight rows and columns are asked at once, as a beam of parallel rays.

use super::{
    DifferingCells, DrawnMask, JUDGED_ABOVE_M, LightChange, Scene, ShadowError, SingleCells, Technique, seen_normal,
};
use crate::mesh::Mesh;
use crate::sun::disc;
use crate::view::{Camera, Elevation, Grid, Lens, Mask, Surface, Tile, View};
use arrayvec::ArrayVec;
use glam::{DVec2, DVec3, DVec4};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

#[doc(hidden)]
pub use super::rays::{RayCaster, Shear};

/// Cells are asked in squares of so many a side: as many rays as a beam has.
const SIDE: usize = 8;
/// As many cells as a square has.
const SQUARE: usize = SIDE * SIDE;

/// Where a cell's ray from the viewer ends.
#[derive(Clone, Copy)]
pub(super) struct RayEnd {
    /// A face of the receivers, or [`Surface::GROUND`], or [`Surface::SKY`].
    pub(super) face: u32,
    /// Along the cell's ray, metres.
    pub(super) distance: f64,
}

/// The technique: one ray per cell to what is seen, once, and one ray per cell towards the sun at every instant.
pub struct RayCast {
    scene: Scene,
    rays: Rays,
    /// One tree where the same faces receive and cast.
    receivers: Arc<RayCaster>,
    casters: Arc<RayCaster>,
    seen: Vec<RayEnd>,
    mask: Mask,
    sun_samples: Option<u32>,
}

impl RayCast {
    /// Builds the trees and finds what the cells see. Rays go to that many points of the sun's disc, or to its centre.
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
        let mut cast = RayCast { scene, rays, receivers, casters, seen: Vec::new(), mask, sun_samples };
        cast.look_at_part(view, part);
        cast
    }

    /// The face that each cell sees, as in [`Surface::face`].
    #[doc(hidden)]
    pub fn faces(&self) -> Vec<u32> {
        self.seen.par_iter().map(|seen| seen.face).collect()
    }

    /// The view.
    pub fn view(&self) -> View {
        self.rays.view
    }

    /// Turns to another view, whose rays begin no farther away than those of the first view.
    pub fn look_at(&mut self, view: View) {
        let size = view.size();
        self.look_at_part(view, ([0, 0], size.into()));
    }

    /// Looks at some of a view's cells: from which column and row, and how many.
    fn look_at_part(&mut self, view: View, (first, [width, height]): ([u32; 2], [u32; 2])) {
        self.rays = Rays { first, ..Rays::new(&self.scene, view) };
        let mut ends = vec![RayEnd { face: Surface::SKY, distance: f64::INFINITY }; width as usize * height as usize];
        let parallel = self.rays.shared_direction().map(Shear::along);
        ends.par_chunks_mut(width as usize * SIDE).enumerate().for_each(|(band, ends)| match &parallel {
            Some(shear) => self.look_along(shear, [width as usize, band * SIDE], ends),
            None => {
                for (at, end) in ends.iter_mut().enumerate() {
                    let ray = self.rays.of(at as u32 % width, (band * SIDE) as u32 + at as u32 / width);
                    *end = seen(&self.scene, ray, self.receivers.first_hit(ray.0, ray.1));
                }
            }
        });
        self.mask = Mask { width, height, share: vec![255; ends.len()] };
        self.seen = ends;
    }

    /// Looks along parallel rays, from the cells of some rows: how wide they are, and the first one.
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
                ends[at] = seen(&self.scene, ray, hit);
            }
        }
    }

    /// What the cells see, row 0 first.
    pub(super) fn seen(&self) -> &[RayEnd] {
        &self.seen
    }

    /// A cell's ray: from where (around the scene's origin), and the unit direction.
    pub(super) fn ray(&self, column: u32, row: u32) -> (DVec3, DVec3) {
        self.rays.of(column, row)
    }

    /// The directions in which rays are cast: to the sun's centre, or to points of its disc.
    pub(super) fn suns(&self, to_sun: DVec3) -> Vec<(DVec3, Shear)> {
        let points = self.sun_samples.map_or(vec![to_sun], |samples| disc(to_sun, samples).collect());
        points.into_iter().map(|to_point| (to_point, Shear::along(to_point))).collect()
    }

    /// Which share of those a cell sees.
    pub(super) fn share(&self, at: usize, suns: &[(DVec3, Shear)]) -> u8 {
        let cell = Cell { at, column: at as u32 % self.mask.width, row: at as u32 / self.mask.width };
        let Some((judged, normal)) = self.judged(&mut self.normals(), cell) else { return 255 };
        let lit =
            |(to_point, shear): &&(DVec3, Shear)| normal.dot(*to_point) > 0.0 && !self.casters.blocked(judged, shear);
        share_of(suns.iter().filter(lit).count(), suns.len())
    }

    /// Where a cell is judged, and the normal of what it sees; none where it sees nothing that could be in shadow.
    #[inline(always)]
    fn judged(&self, normals: &mut SeenNormals<'_>, Cell { at, column, row }: Cell) -> Option<(DVec3, DVec3)> {
        let RayEnd { face, distance } = self.seen[at];
        // nor is cut earth asked
        if face == Surface::SKY || (face == Surface::GROUND && distance == 0.0) {
            return None;
        }
        let normal = normals.of(face);
        let (from, along) = self.rays.of(column, row);
        Some((from + along * distance + normal * JUDGED_ABOVE_M, normal))
    }

    /// Which share of those the cells of some rows see, as [`RayCast::share`], but for squares of cells at once.
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

    /// The normals of faces' seen sides, and of the ground's.
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

    /// The share of the sun's centre that a cell sees, found without the trees by testing every face. It is slow; it
    /// proves the trees themselves.
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
        let RayEnd { face, distance } = seen(scene, (from, along), first);
        if face == Surface::SKY || (face == Surface::GROUND && distance == 0.0) {
            return 255;
        }
        let normal = self.normals().of(face);
        let judged = from + along * distance + normal * JUDGED_ABOVE_M;
        let lit = normal.dot(to_sun) > 0.0 && hits(&scene.casters, judged, &Shear::along(to_sun)).is_empty();
        if lit { 255 } else { 0 }
    }
}

/// The share of the sun that is seen, rounded to the nearest.
fn share_of(lit: usize, suns: usize) -> u8 {
    ((2 * 255 * lit + suns) / (2 * suns)) as u8
}

fn same_faces(one: &Mesh, other: &Mesh) -> bool {
    one.origin == other.origin && one.faces == other.faces && one.vertices == other.vertices
}

/// Finds normals, and remembers the last one, as neighbours mostly see the same face.
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

/// A cell of some rows: which one, and where it lies.
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

/// What a cell takes when an edge runs through its very centre, in cells: what lies east of it, and on an edge from west
/// to east what lies south. That is the rasterisers' top-left rule, so that drawing boards whose walls stand on whole
/// cells give the same plan on every machine; a ten-thousandth is beyond the rounding of corners and nothing else.
pub(super) const TIE: DVec2 = DVec2::new(1e-4, -1e-5);

/// The rays on which cells are seen.
struct Rays {
    view: View,
    /// Column and row of the view at which what is looked at begins.
    first: [u32; 2],
    /// The scene's origin.
    origin: DVec3,
    start: RayStart,
}

/// Where rays begin.
enum RayStart {
    /// A height above everything, in the world frame, from which the plan looks down.
    Above(Grid, f64),
    /// A camera's eye; its rays begin at the near plane.
    Eye(DVec3, Lens),
    /// The distance in front of a side's own plane from which everything lies behind it.
    Before(Elevation, f64),
}

impl Rays {
    fn new(scene: &Scene, view: View) -> Rays {
        let start = match view {
            View::Plan(grid) => RayStart::Above(grid, scene.receivers.top().max(scene.ground) + 1.0),
            View::Camera(camera) => RayStart::Eye(camera.eye, camera.lens()),
            View::Elevation(side) => {
                let (low, high) = scene.receivers.bounds().unwrap_or_default();
                let nearest = DVec3::select(side.to_viewer.cmpgt(DVec3::ZERO), high, low);
                RayStart::Before(side, (nearest - side.target).dot(side.to_viewer) + 1.0)
            }
        };
        Rays { view, first: [0, 0], origin: scene.casters.origin, start }
    }

    /// The direction of all rays, where they have one.
    fn shared_direction(&self) -> Option<DVec3> {
        match &self.start {
            RayStart::Above(..) => Some(DVec3::NEG_Z),
            RayStart::Eye(..) => None,
            RayStart::Before(side, _) => Some(-side.to_viewer),
        }
    }

    /// A cell's ray: from where (around the scene's origin), and the unit direction.
    #[inline(always)]
    fn of(&self, column: u32, row: u32) -> (DVec3, DVec3) {
        let (column, row) = (self.first[0] + column, self.first[1] + row);
        match &self.start {
            RayStart::Above(grid, top) => {
                let at = grid.centre(column, row) + TIE * grid.cell;
                (at.extend(*top) - self.origin, DVec3::NEG_Z)
            }
            RayStart::Eye(eye, lens) => {
                let direction = lens.direction(column, row);
                let near = direction * (Camera::NEAR_M / direction.dot(lens.forward()));
                (*eye + near - self.origin, direction)
            }
            RayStart::Before(side, away) => {
                (side.centre(column, row) + side.to_viewer * *away - self.origin, -side.to_viewer)
            }
        }
    }
}

/// What a ray sees whose first face that is.
fn seen(scene: &Scene, (origin, direction): (DVec3, DVec3), first_hit: Option<(u32, f64)>) -> RayEnd {
    // a level ray that begins below the ground sees the earth that is cut there
    if direction.z == 0.0 && origin.z + scene.casters.origin.z < scene.ground {
        return RayEnd { face: Surface::GROUND, distance: 0.0 };
    }
    let to_ground = (scene.ground - scene.casters.origin.z - origin.z) / direction.z;
    let ground = if to_ground > 0.0 && to_ground.is_finite() {
        RayEnd { face: Surface::GROUND, distance: to_ground }
    } else {
        RayEnd { face: Surface::SKY, distance: f64::INFINITY }
    };
    match first_hit {
        Some((face, distance)) if distance <= ground.distance => RayEnd { face, distance },
        _ => ground,
    }
}

/// How far from the origin rays begin, metres.
pub(super) fn reach(scene: &Scene, view: &View) -> f64 {
    let farthest = match view {
        View::Plan(grid) => {
            let [west, south, east, north] = grid.region();
            DVec3::new(west.abs().max(east.abs()), south.abs().max(north.abs()), scene.ground.abs())
        }
        View::Camera(camera) => camera.eye.abs(),
        View::Elevation(side) => {
            let (low, high) = scene.receivers.bounds().unwrap_or_default();
            (side.target.abs() + side.half_size().max_element()).max(low.abs()).max(high.abs()) + 1.0
        }
    };
    (farthest + scene.casters.origin.abs()).max_element()
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
            face: self.seen.iter().map(|seen| seen.face).collect(),
            height_m: self.seen.par_iter().enumerate().map(height_of).collect(),
        })
    }
}
