//! Ray casting on the processor, in double precision: the truth that other techniques are held against, and the
//! engine where there is no GPU.
//!
//! Plain on purpose. Intersection after Woop, Benthin and Wald, *Watertight Ray/Triangle Intersection* (JCGT 2013):
//! the triangle is sheared so that the ray is an axis, and the signs of three areas decide; a ray through a shared
//! edge or corner computes the same areas for both faces and hits at least one. Areas of exactly 0 count as hits.
//! The tree only prunes: its boxes are padded beyond all rounding of its `f32` rays, and beyond the first tenth of a
//! millimetre of a ray, in which it finds nothing.

use super::{DrawnMask, JUDGED_ABOVE_M, Scene, ShadowError, SingleCells, Technique, seen_normal};
use crate::mesh::Mesh;
use crate::sun::disc;
use crate::view::{Camera, CellWord, Elevation, Grid, Lens, Mask, Surface, Tile, View};
use glam::{DVec2, DVec3, DVec4, Vec3, Vec3A};
use obvhs::cwbvh::{CwBvh, builder::build_cwbvh};
use obvhs::ray::{Ray, RayHit};
use obvhs::{BvhBuildParams, aabb::Aabb};
use rayon::prelude::*;
use std::time::Duration;

/// Casts rays at one mesh. Points and directions are around the mesh's origin.
#[doc(hidden)]
pub struct RayCaster {
    tree: Option<CwBvh>,
    /// Corners of the faces in the tree's order, and which faces they are.
    corners: Vec<[Vec3; 3]>,
    faces: Vec<u32>,
}

/// The tree looks past boxes that a ray has left so early, in lengths of the ray's direction (`EPSILON` of obvhs 0.4).
const LOOKED_PAST: f64 = 1e-4;

impl RayCaster {
    /// Builds the tree; `reach` is the farthest that a ray's origin lies from the mesh's origin, metres.
    pub fn new(mesh: &Mesh, reach: f64) -> RayCaster {
        let size = mesh.vertices.iter().fold(0.0f32, |size, vertex| size.max(vertex.abs().max_element()));
        let rounding = (f64::from(size) + reach) * f64::from(f32::EPSILON) * 8.0;
        // the tree's rays have unit directions: whatever they meet within the first of it lies in a box that they leave later
        let padding = Vec3A::splat((rounding + 2.0 * LOOKED_PAST) as f32);
        let box_of = |face: usize| {
            let [a, b, c] = mesh.corners(face).map(Vec3A::from);
            Aabb::new(a.min(b).min(c) - padding, a.max(b).max(c) + padding)
        };
        let boxes: Vec<Aabb> = (0..mesh.faces.len()).into_par_iter().map(box_of).collect();
        let tree =
            (!boxes.is_empty()).then(|| build_cwbvh(&boxes, BvhBuildParams::fast_build(), &mut Duration::default()));
        let faces = tree.as_ref().map_or(Vec::new(), |tree| tree.primitive_indices.clone());
        RayCaster { tree, corners: faces.iter().map(|&face| mesh.corners(face as usize)).collect(), faces }
    }

    /// The nearest face along a ray, and how many lengths of `direction` away.
    pub fn first_hit(&self, origin: DVec3, direction: DVec3) -> Option<(u32, f64)> {
        let shear = Shear::along(direction);
        let length = direction.length();
        let mut nearest = None;
        let mut distance = f64::INFINITY;
        let ray = ray(origin, direction);
        self.tree.as_ref()?.ray_traverse(ray, &mut RayHit::none(), |_, at| {
            if let Some(t) = shear.hit(origin, &self.corners[at])
                && t < distance
            {
                distance = t;
                nearest = Some((self.faces[at], t));
                return ((t * length) as f32).next_up();
            }
            f32::INFINITY
        });
        nearest
    }

    /// Whether anything lies along a ray.
    pub fn blocked(&self, origin: DVec3, shear: &Shear) -> bool {
        let hit = |_: &Ray, at: usize| {
            if shear.hit(origin, &self.corners[at]).is_some() { 0.0 } else { f32::INFINITY }
        };
        self.tree.as_ref().is_some_and(|tree| !tree.ray_traverse_miss(ray(origin, shear.direction), hit))
    }

    /// How many faces lie along a ray: the count that a shadow volume must have at its origin.
    #[cfg(feature = "test-hooks")]
    pub fn crossings(&self, origin: DVec3, direction: DVec3) -> usize {
        let shear = Shear::along(direction);
        self.corners.iter().filter(|corners| shear.hit(origin, corners).is_some()).count()
    }
}

fn ray(origin: DVec3, direction: DVec3) -> Ray {
    // + 0 makes −0 into 0, of which the tree takes one sign for the direction and the other for its inverse
    Ray::new_inf(origin.as_vec3a(), direction.normalize().as_vec3a() + Vec3A::ZERO)
}

/// The frame in which a direction is an axis, the same for all parallel rays.
#[doc(hidden)]
pub struct Shear {
    direction: DVec3,
    axes: [usize; 3],
    scale: DVec3,
}

impl Shear {
    /// For rays along a direction that is not zero.
    pub fn along(direction: DVec3) -> Shear {
        let forward = direction.abs().max_position();
        let (mut right, mut up) = ((forward + 1) % 3, (forward + 2) % 3);
        if direction[forward] < 0.0 {
            std::mem::swap(&mut right, &mut up);
        }
        let scale = DVec3::new(direction[right], direction[up], 1.0) / direction[forward];
        Shear { direction, axes: [right, up, forward], scale }
    }

    /// How many lengths of the direction away the ray meets the triangle; none behind the origin or beside it.
    fn hit(&self, origin: DVec3, corners: &[Vec3; 3]) -> Option<f64> {
        let [right, up, forward] = self.axes;
        let [a, b, c] = corners.map(|corner| {
            let from_origin = corner.as_dvec3() - origin;
            let ahead = from_origin[forward];
            [from_origin[right] - self.scale.x * ahead, from_origin[up] - self.scale.y * ahead, ahead * self.scale.z]
        });
        let u = c[0] * b[1] - c[1] * b[0];
        let v = a[0] * c[1] - a[1] * c[0];
        let w = b[0] * a[1] - b[1] * a[0];
        if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
            return None;
        }
        let area = u + v + w;
        // 0: the triangle is edge-on or has no area, and shades nothing
        let distance = (area != 0.0).then(|| (u * a[2] + v * b[2] + w * c[2]) / area)?;
        (distance > 0.0).then_some(distance)
    }
}

/// Where a cell's ray from the viewer ends.
#[derive(Clone, Copy)]
pub(super) struct RayEnd {
    /// A face of the receivers, or [`Surface::GROUND`], or [`Surface::SKY`].
    pub(super) face: u32,
    /// Along the cell's ray, metres.
    pub(super) distance: f64,
}

/// The technique: one ray a cell to what is seen, once, and one ray a cell towards the sun at every instant.
pub struct RayCast {
    scene: Scene,
    rays: Rays,
    receivers: RayCaster,
    casters: RayCaster,
    seen: Vec<RayEnd>,
    mask: Mask,
    sun_samples: Option<u32>,
}

impl RayCast {
    /// Builds the trees and finds what the cells see. Rays go to so many points of the sun's disc, or to its centre.
    pub fn new(scene: Scene, view: View, sun_samples: Option<u32>) -> RayCast {
        let size = view.size();
        Self::of_part(scene, view, ([0, 0], size.into()), sun_samples)
    }

    /// The same for a tile of a plan alone.
    pub fn of_tile(scene: Scene, tile: Tile, sun_samples: Option<u32>) -> RayCast {
        Self::of_part(scene, View::Plan(tile.plan), (tile.first, tile.size), sun_samples)
    }

    fn of_part(scene: Scene, view: View, part: ([u32; 2], [u32; 2]), sun_samples: Option<u32>) -> RayCast {
        let reach = reach(&scene, &view);
        let receivers = RayCaster::new(&scene.receivers, reach);
        let casters = RayCaster::new(&scene.casters, reach);
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

    /// What is looked at.
    pub fn view(&self) -> View {
        self.rays.view
    }

    /// Turns to another view, whose rays begin no farther away than those of the first.
    pub fn look_at(&mut self, view: View) {
        let size = view.size();
        self.look_at_part(view, ([0, 0], size.into()));
    }

    /// Looks at some of a view's cells: from which column and row, and how many.
    fn look_at_part(&mut self, view: View, (first, [width, height]): ([u32; 2], [u32; 2])) {
        self.rays = Rays { first, ..Rays::new(&self.scene, view) };
        let RayCast { scene, rays, receivers, seen, mask, .. } = self;
        *seen = vec![RayEnd { face: Surface::SKY, distance: f64::INFINITY }; width as usize * height as usize];
        seen.par_chunks_mut(width as usize).enumerate().for_each(|(row, cells)| {
            for (column, cell) in cells.iter_mut().enumerate() {
                *cell = look(scene, receivers, rays.of(column as u32, row as u32));
            }
        });
        *mask = Mask { width, height, share: vec![255; seen.len()] };
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
        let RayCast { rays, casters, seen, mask, .. } = self;
        let RayEnd { face, distance } = seen[at];
        // nor is cut earth asked
        if face == Surface::SKY || (face == Surface::GROUND && distance == 0.0) {
            return 255;
        }
        let normal = self.normal(face);
        let (from, along) = rays.of(at as u32 % mask.width, at as u32 / mask.width);
        let judged = from + along * distance + normal * JUDGED_ABOVE_M;
        let lit = |(to_point, shear): &&(DVec3, Shear)| normal.dot(*to_point) > 0.0 && !casters.blocked(judged, shear);
        let seen = suns.iter().filter(lit).count();
        (255.0 * seen as f64 / suns.len() as f64).round() as u8
    }

    /// The normal of a face's seen side, or of the ground's.
    fn normal(&self, face: u32) -> DVec3 {
        let RayCast { scene, rays, .. } = self;
        let origin = scene.casters.origin;
        let world_viewer = rays.view.viewer();
        let viewer = world_viewer - DVec4::from((origin, 0.0)) * world_viewer.w;
        let ground = DVec4::new(0.0, 0.0, 1.0, origin.z - scene.ground);
        let plane = if face == Surface::GROUND { ground } else { scene.receivers.planes()[face as usize] };
        seen_normal(plane, viewer)
    }

    /// How many rays a mask takes: one for each point of the sun and each cell whose seen side it shines on.
    #[cfg(feature = "test-hooks")]
    pub fn rays(&self, to_sun: DVec3) -> usize {
        let suns = self.suns(to_sun);
        let of_cell = |seen: &RayEnd| {
            if seen.face == Surface::SKY {
                return 0;
            }
            let normal = self.normal(seen.face);
            suns.iter().filter(|(to_point, _)| normal.dot(*to_point) > 0.0).count()
        };
        self.seen.par_iter().map(of_cell).sum()
    }

    /// Which share of the sun's centre a cell sees, found without the trees: every face is asked. Slow; by this the trees
    /// themselves are proven.
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
        let normal = self.normal(face);
        let judged = from + along * distance + normal * JUDGED_ABOVE_M;
        let lit = normal.dot(to_sun) > 0.0 && hits(&scene.casters, judged, &Shear::along(to_sun)).is_empty();
        if lit { 255 } else { 0 }
    }
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
    /// A height above everything, in the world frame: the plan looks down from there.
    Above(Grid, f64),
    /// A camera's eye; its rays begin at the near plane.
    Eye(DVec3, Lens),
    /// So far before a side's own plane that everything lies behind it.
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

    /// A cell's ray: from where (around the scene's origin), and the unit direction.
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

fn look(scene: &Scene, receivers: &RayCaster, ray: (DVec3, DVec3)) -> RayEnd {
    seen(scene, ray, receivers.first_hit(ray.0, ray.1))
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
        share.par_chunks_mut(width).enumerate().for_each(|(row, shares)| {
            for (column, share) in shares.iter_mut().enumerate() {
                *share = self.share(row * width + column, &suns);
            }
        });
        self.mask.share = share;
        Ok(DrawnMask::Memory(&self.mask))
    }

    fn single_cells(&self) -> Option<SingleCells> {
        Some(SingleCells::All)
    }

    fn shaded_of(&mut self, to_sun: DVec3, asked: &[CellWord]) -> Result<Vec<u64>, ShadowError> {
        let suns = self.suns(to_sun);
        let Mask { width, .. } = self.mask;
        let in_row = width.div_ceil(64) as usize;
        let shaded = |asked: &CellWord| {
            let (row, column) = asked.place(in_row);
            let first = row * width as usize + column;
            let is_shaded = |bit: &u32| self.share(first + *bit as usize, &suns) <= 127;
            asked.bits().filter(is_shaded).fold(0, |shaded, bit| shaded | 1 << bit)
        };
        Ok(asked.par_iter().map(shaded).collect())
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
