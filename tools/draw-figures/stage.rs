//! A scene with its view and its sun, for techniques to draw.

use crate::picture::{Part, Picture, Rgb};
use anyhow::Result;
use glam::{DVec3, DVec4, dvec3};
use gnomon::choice::Filter;
use gnomon::gpu::Gpu;
use gnomon::mesh::{self, Mesh};
use gnomon::shadow::hybrid::Hybrid;
use gnomon::shadow::ray_cast::RayCast;
use gnomon::shadow::shadow_map::ShadowMap;
use gnomon::shadow::smoothie::Smoothie;
use gnomon::shadow::stencil::Stencil;
use gnomon::shadow::{Scene, Technique, seen_normal};
use gnomon::silhouette::ProcessorFinder;
use gnomon::view::{Camera, Grid, Mask, Surface, View};
use std::sync::Arc;
use std::time::Instant;

/// Points on the sun's disc that stand for its truth.
pub(crate) const DISC_POINTS: u32 = 256;

/// What all panels of a row share.
pub(crate) struct Stage {
    gpu: Arc<Gpu>,
    pub(crate) scene: Scene,
    pub(crate) view: View,
    pub(crate) to_sun: DVec3,
    surface: Surface,
}

impl Stage {
    /// Everything casts and receives; the ground lies at 0.
    pub(crate) fn new(gpu: &Arc<Gpu>, parts: Vec<mesh::Part>, view: View, to_sun: DVec3) -> Result<Stage> {
        let mesh = Mesh::build(parts)?;
        Stage::of(gpu, Scene { casters: mesh.clone(), receivers: mesh, ground: 0.0 }, view, to_sun)
    }

    pub(crate) fn of(gpu: &Arc<Gpu>, scene: Scene, view: View, to_sun: DVec3) -> Result<Stage> {
        let surface = gnomon::shadow::GpuSurface::draw(Arc::clone(gpu), &scene, view)?.read()?;
        Ok(Stage { gpu: Arc::clone(gpu), scene, view, to_sun, surface })
    }

    pub(crate) fn map(&self, size: u32, filter: Filter) -> Result<ShadowMap> {
        Ok(ShadowMap::new(Arc::clone(&self.gpu), &self.scene, self.view, size, filter)?)
    }

    pub(crate) fn hybrid(&self, map_size: u32) -> Result<Hybrid> {
        Ok(Hybrid::new(Arc::clone(&self.gpu), self.scene.clone(), self.view, ProcessorFinder::Hierarchy, map_size)?)
    }

    pub(crate) fn stencil(&self) -> Result<Stencil> {
        Ok(Stencil::new(Arc::clone(&self.gpu), self.scene.clone(), self.view, ProcessorFinder::Hierarchy)?)
    }

    pub(crate) fn smoothie(&self, map_size: u32, width_m: Option<f64>) -> Result<Smoothie> {
        let scene = self.scene.clone();
        Ok(Smoothie::new(Arc::clone(&self.gpu), scene, self.view, ProcessorFinder::Hierarchy, map_size, width_m)?)
    }

    /// Ray casting to the sun's centre, or to points all over its disc.
    pub(crate) fn rays(&self, points: Option<u32>) -> RayCast {
        RayCast::new(self.scene.clone(), self.view, points)
    }

    pub(crate) fn mask(&self, technique: &mut dyn Technique) -> Result<Mask> {
        Ok(technique.draw(self.to_sun)?.read()?)
    }

    /// The masks, and the median of the milliseconds that an instant takes; techniques take turns, so that what else the
    /// machine does falls on all alike.
    pub(crate) fn timed(&self, techniques: &mut [Box<dyn Technique>]) -> Result<Vec<(Mask, f64)>> {
        let mut masks = Vec::new();
        for technique in &mut *techniques {
            masks.push(self.mask(&mut **technique)?);
        }
        let mut times = vec![Vec::new(); masks.len()];
        for _ in 0..7 {
            for (technique, times) in techniques.iter_mut().zip(&mut times) {
                let start = Instant::now();
                technique.draw(self.to_sun)?;
                self.gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
                times.push(start.elapsed().as_secs_f64() * 1e3);
            }
        }
        let median = |mut times: Vec<f64>| {
            times.sort_by(f64::total_cmp);
            times[times.len() / 2]
        };
        Ok(masks.into_iter().zip(times.into_iter().map(median)).collect())
    }

    /// The part of the picture that is so large and has a point in its middle.
    pub(crate) fn around(&self, point: DVec3, width: u32, height: u32) -> Part {
        let (columns, rows) = self.view.size();
        let [x, y] = self.at(point);
        let start = |at: f64, cells: u32, length: u32| {
            (at - f64::from(length) / 2.0).clamp(0.0, f64::from(cells - length)) as u32
        };
        [start(x, columns, width), start(y, rows, height), width, height]
    }

    /// The part of the picture that shows a region of the ground.
    pub(crate) fn part_of(&self, grid: &Grid) -> Part {
        let [west, south, east, north] = grid.region();
        let corners = [(west, south), (east, south), (east, north), (west, north)];
        let at = corners.map(|(x, y)| self.at(dvec3(x, y, 0.0)));
        let low = at.iter().fold([f64::INFINITY; 2], |low, at| [low[0].min(at[0]), low[1].min(at[1])]);
        let high = at.iter().fold([0.0f64; 2], |high, at| [high[0].max(at[0]), high[1].max(at[1])]);
        [low[0] as u32, low[1] as u32, (high[0] - low[0]) as u32, (high[1] - low[1]) as u32]
    }

    /// Where a point of the world lies in the picture.
    fn at(&self, point: DVec3) -> [f64; 2] {
        let (columns, rows) = self.view.size();
        match self.view {
            View::Plan(grid) => [(point.x - grid.west) / grid.cell, (grid.north - point.y) / grid.cell],
            View::Camera(camera) => {
                let at = camera.clip_from_world().project_point3(point);
                [(at.x + 1.0) / 2.0 * f64::from(columns), (1.0 - at.y) / 2.0 * f64::from(rows)]
            }
            View::Elevation(side) => {
                let ([right, up, _], half, from) = (side.axes(), side.half_size(), point - side.target);
                [(from.dot(right) + half.x) / side.cell, (half.y - from.dot(up)) / side.cell]
            }
        }
    }

    /// Matt card in sun and shade.
    pub(crate) fn shaded(&self, mask: &Mask) -> Picture {
        let light = self.lights();
        let cells: Vec<(u8, (Rgb, Rgb))> = mask.share.iter().copied().zip(light).collect();
        Picture::of(self.view.size(), &cells, |&(share, (shade, sun))| {
            crate::picture::mix(shade, sun, f64::from(share) / 255.0)
        })
    }

    /// Per cell its colours in the shade and in the sun.
    pub(crate) fn lights(&self) -> Vec<(Rgb, Rgb)> {
        let origin = self.scene.receivers.origin;
        let world_viewer = self.view.viewer();
        let viewer = world_viewer - DVec4::from((origin, 0.0)) * world_viewer.w;
        let light = |&face: &u32| {
            if face == Surface::SKY {
                return ([214, 224, 232], [214, 224, 232]);
            }
            let (card, normal) = match face {
                Surface::GROUND => (DVec3::new(0.955, 0.935, 0.89), DVec3::Z),
                face => (DVec3::splat(0.99), seen_normal(self.scene.receivers.planes()[face as usize], viewer)),
            };
            // sides are told apart in the shade too
            let sky = 0.47 + 0.09 * normal.z + 0.05 * normal.x - 0.03 * normal.y;
            let across = normal.dot(self.to_sun).max(0.0);
            let sun = if across > 0.0 { 0.16 + 0.3 * across / self.to_sun.z.max(0.4) } else { 0.0 };
            let colour = |light: DVec3| (card * light * 255.0).to_array().map(|value| value.clamp(0.0, 255.0) as u8);
            let shade = DVec3::new(0.90, 0.97, 1.10) * sky;
            (colour(shade), colour(shade + DVec3::new(1.08, 1.0, 0.86) * sun))
        };
        self.surface.face.iter().map(light).collect()
    }
}

/// A plan around a point.
pub(crate) fn plan(middle: DVec3, cell: f64, (width, height): (u32, u32)) -> Grid {
    let west = middle.x - cell * f64::from(width) / 2.0;
    let north = middle.y + cell * f64::from(height) / 2.0;
    Grid { west, north, cell, width, height }
}

/// A camera's view, from degrees.
pub(crate) fn camera(eye: DVec3, target: DVec3, fov_deg: f64, (width, height): (u32, u32)) -> View {
    View::Camera(Camera { eye, target, up: DVec3::Z, fov_rad: fov_deg.to_radians(), width, height })
}
