//! The colours and lines of a camera's picture: like a photograph of a plain model, warm in the sun and cool in the
//! shade.

use super::FigureContext;
use super::components::Components;
use super::picture::{CellBorder, Fit, PagePicture, Pen, compose};
use super::scale::Rgb;
use crate::look::LOOK;
use crate::view::{Camera, Elevation, Mask, Surface};
use glam::{DVec3, DVec4, Vec4Swizzles as _};
use rayon::prelude::*;

/// Colours that replace those of the material.
#[derive(Clone, Copy)]
pub(super) struct OwnColours<'a> {
    /// Components, shown in sun and shadow.
    pub(super) components: Option<&'a Components>,
    /// Cells, shown instead of sun and shadow, without the sky.
    pub(super) of_cells: Option<&'a [Rgb]>,
}

/// Sun and shadow at one instant, as the camera sees them; like matt card where nothing has a colour of its own.
pub(super) fn instant(
    scene: &FigureContext,
    lens: &PixelRays,
    mask: &Mask,
    to_sun: DVec3,
    OwnColours { components, of_cells }: OwnColours<'_>,
    fit: Fit,
) -> PagePicture {
    if let Some(of_cells) = of_cells {
        // lines would be mistaken for cells
        return painted(scene, lens, of_cells, false, fit);
    }
    let light = SurfaceLight::new(to_sun);
    let ground_only = scene.is_ground_alone();
    let width = lens.width();
    let colours: Vec<Rgb> = (0..scene.surface.face.len())
        .into_par_iter()
        .map(|pixel| {
            let ray = lens.ray(pixel % width, pixel / width);
            let share = f64::from(mask.share[pixel]) / 255.0;
            let colour = match scene.surface.face[pixel] {
                Surface::SKY => sky(ray),
                Surface::GROUND => {
                    let card = if lens.is_level { LOOK.ground * LOOK.cut_earth } else { LOOK.ground };
                    let lit = card * light.on(DVec3::Z, share);
                    let far = lens.ground_distance(scene, pixel, ray);
                    lit.lerp(LOOK.horizon, lens.haze(far))
                }
                face => {
                    let plane = facing(scene, face, lens.viewer);
                    // A mask of the ground says nothing about the walls.
                    let share = if ground_only { 1.0 } else { share };
                    let own = |of: &Components| DVec3::from(of.colour(face).map(f64::from)) / 255.0;
                    components.map_or(LOOK.building, own) * light.on(plane.xyz(), share)
                }
            };
            display(at_night(to_sun, colour))
        })
        .collect();
    // colours already distinguish the parts, and dense lines would hide the colours of fine ones
    let strength = if components.is_some() { LOOK.tinted_lines } else { 1.0 };
    let quieter = |pen: Pen| Pen { strength: pen.strength * strength, ..pen };
    compose(fit, CellBorder::Smooth, &colours, |a, b| pen(scene, lens, a, b).map(quieter))
}

/// Cells in given colours, with or without lines, under a daytime sky. The colours of the sky's cells are not used.
pub(super) fn painted(
    scene: &FigureContext,
    lens: &PixelRays,
    of_cells: &[Rgb],
    with_lines: bool,
    fit: Fit,
) -> PagePicture {
    let width = lens.width();
    let colour = |(pixel, &colour): (usize, &Rgb)| match scene.surface.face[pixel] {
        Surface::SKY => display(sky(lens.ray(pixel % width, pixel / width))),
        _ => colour,
    };
    let colours: Vec<Rgb> = of_cells.par_iter().enumerate().map(colour).collect();
    compose(fit, CellBorder::Smooth, &colours, |a, b| pen(scene, lens, a, b).filter(|_| with_lines))
}

/// The colours of level ground in the sun and in the shade, for the legend.
pub(super) fn ground_tones(to_sun: DVec3) -> [Rgb; 2] {
    let light = SurfaceLight::new(to_sun);
    [1.0, 0.0].map(|share| display(at_night(to_sun, LOOK.ground * light.on(DVec3::Z, share))))
}

/// Darkens a colour and makes it bluish at night.
fn at_night(to_sun: DVec3, colour: DVec3) -> DVec3 {
    if to_sun.z > 0.0 { colour } else { colour * LOOK.night }
}

/// The axes of the camera, scaled so that each pixel's ray is a linear combination of them.
pub(super) struct PixelRays {
    forward: DVec3,
    right: DVec3,
    up: DVec3,
    size: [f64; 2],
    focus_m: f64,
    /// The viewer as a homogeneous point: the eye, or the direction to the viewer of parallel rays.
    pub(super) viewer: DVec4,
    /// Of parallel rays, the middle of the picture and a pixel's side in metres.
    side: Option<(DVec3, f64)>,
    /// Whether it is a side, with cut earth below the ground's line.
    is_level: bool,
}

impl PixelRays {
    pub(super) fn new(camera: &Camera) -> PixelRays {
        let sight = camera.target - camera.eye;
        let forward = sight.try_normalize().unwrap_or(DVec3::NEG_Z);
        // A camera that looks along its up vector still needs an axis to the right.
        let right = forward.cross(camera.up).try_normalize().unwrap_or_else(|| forward.any_orthonormal_vector());
        let size = [f64::from(camera.width.max(1)), f64::from(camera.height.max(1))];
        let tall = (0.5 * camera.fov_rad).tan();
        PixelRays {
            forward,
            right: right * (tall * size[0] / size[1]),
            up: right.cross(forward) * tall,
            size,
            focus_m: sight.length().max(1e-6),
            viewer: camera.eye.extend(1.0),
            side: None,
            is_level: false,
        }
    }

    /// The rays of a side or of the sun, which are parallel.
    pub(super) fn of_side(side: &Elevation) -> PixelRays {
        let [right, up, forward] = side.axes();
        let half = side.half_size();
        PixelRays {
            forward,
            right: right * half.x,
            up: up * half.y,
            size: [f64::from(side.width.max(1)), f64::from(side.height.max(1))],
            focus_m: 1.0,
            viewer: side.to_viewer.extend(0.0),
            side: Some((side.target, side.cell)),
            is_level: side.is_level(),
        }
    }

    fn width(&self) -> usize {
        self.size[0] as usize
    }

    /// A point on a pixel's ray: the eye, or for a side the point at which the ray crosses the picture.
    pub(super) fn start(&self, column: usize, row: usize) -> DVec3 {
        let [x, y] = self.at(column, row);
        self.side.map_or(self.viewer.xyz(), |(target, _)| target + self.right * x + self.up * y)
    }

    fn at(&self, column: usize, row: usize) -> [f64; 2] {
        [2.0 * (column as f64 + 0.5) / self.size[0] - 1.0, 1.0 - 2.0 * (row as f64 + 0.5) / self.size[1]]
    }

    /// The vector from the eye through a pixel's centre; along it, one metre of length is one metre of depth.
    pub(super) fn ray(&self, column: usize, row: usize) -> DVec3 {
        let [x, y] = self.at(column, row);
        if self.side.is_some() { self.forward } else { self.forward + self.right * x + self.up * y }
    }

    fn ground_distance(&self, scene: &FigureContext, pixel: usize, ray: DVec3) -> f64 {
        let drop = f64::from(scene.surface.height_m[pixel]) - self.viewer.z;
        let depth = drop / ray.z;
        if depth.is_finite() { depth.max(0.0) * ray.length() } else { f64::INFINITY }
    }

    /// The share of haze: 0 at the subject, towards 1 at many times its distance.
    fn haze(&self, distance_m: f64) -> f64 {
        if self.side.is_some() {
            return 0.0;
        }
        1.0 - (-(distance_m / self.focus_m - LOOK.haze_begins).max(0.0) / LOOK.haze_length).exp()
    }
}

/// A face's plane (n, d) with n·p + d > 0 towards the viewer (homogeneous), in the world frame.
pub(super) fn facing(scene: &FigureContext, face: u32, viewer: DVec4) -> DVec4 {
    let Some(plane) = scene.mesh.planes().get(face as usize) else {
        return DVec3::Z.extend(0.0);
    };
    let offset = plane.w - plane.xyz().dot(scene.mesh.origin);
    let plane = plane.xyz().extend(offset);
    if plane.dot(viewer) < 0.0 { -plane } else { plane }
}

/// The light on a surface: from the sky above, and from the sun where it is seen.
struct SurfaceLight {
    to_sun: DVec3,
    sun: f64,
}

impl SurfaceLight {
    /// Exposes so that level ground in the sun is nearly the paper's white, even at a low sun.
    fn new(to_sun: DVec3) -> SurfaceLight {
        let sun = (LOOK.exposure - LOOK.sky - LOOK.sky_slope) / to_sun.z.max(LOOK.least_height);
        SurfaceLight { to_sun, sun }
    }

    fn on(&self, normal: DVec3, share: f64) -> DVec3 {
        let sky = LOOK.sky + LOOK.sky_slope * normal.z;
        let across = normal.dot(self.to_sun);
        let sun = if across > 0.0 { (self.sun * across).max(LOOK.least_sun) } else { 0.0 };
        LOOK.sky_light * sky + LOOK.sun_light * sun * share
    }
}

fn sky(ray: DVec3) -> DVec3 {
    let height = (ray.z / ray.length()).clamp(0.0, 1.0);
    LOOK.horizon.lerp(LOOK.zenith, (height * LOOK.sky_rise).min(1.0).sqrt() * LOOK.sky_most)
}

/// Converts to display values; the brightest tenth is compressed instead of cut off.
fn display(colour: DVec3) -> Rgb {
    let (above, room) = (LOOK.pressed_above, LOOK.pressed_room);
    let soft = |value: f64| {
        let over = value - above;
        let value = if over > 0.0 { above + room * (1.0 - (-over / room).exp()) } else { value };
        (value.max(0.0) * 255.0).round() as u8
    };
    [soft(colour.x), soft(colour.y), soft(colour.z)]
}

fn pen(scene: &FigureContext, lens: &PixelRays, a: usize, b: usize) -> Option<Pen> {
    let (from, to) = (scene.surface.face[a], scene.surface.face[b]);
    if from == to {
        return None;
    }
    let building = |face: u32| face < Surface::GROUND;
    match (building(from), building(to)) {
        // only a side shows the ground's line
        (false, false) => lens.is_level.then_some(Pen::STEP),
        (true, true) => {
            let (from, to) = (facing(scene, from, lens.viewer), facing(scene, to, lens.viewer));
            let width = lens.width();
            let depth = |plane: DVec4, pixel: usize| {
                let (column, row) = (pixel % width, pixel / width);
                -plane.dot(lens.start(column, row).extend(1.0)) / plane.xyz().dot(lens.ray(column, row))
            };
            let gap = |pixel| depth(from, pixel) - depth(to, pixel);
            let (here, there) = (gap(a), gap(b));
            // Planes that intersect between the two pixels adjoin, however steep they are; otherwise there is air
            // between them.
            let least = lens
                .side
                .map_or_else(|| LOOK.step_share * depth(from, a).abs(), |(_, cell)| LOOK.side_step_pixels * cell);
            let step = here * there > 0.0 && here.abs().min(there.abs()) > least;
            let crease = from.xyz().dot(to.xyz()) < LOOK.crease_cos;
            match (step, crease) {
                (true, _) => Some(Pen::STEP),
                (false, true) => Some(Pen::CREASE),
                (false, false) => None,
            }
        }
        _ if from == Surface::SKY || to == Surface::SKY => Some(Pen::STEP),
        _ => Some(Pen::FOOT),
    }
}
