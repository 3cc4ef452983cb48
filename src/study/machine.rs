//! A technique with everything that it needs to be made for a view.

use super::search_memory::SEARCH_BYTES;
use super::{StudyError, Wants, subject};
use crate::choice::{Engine, Finder, Method, MethodRow, Misfit, Receivers, Settings, Subject};
use crate::gpu::Gpu;
use crate::profile::Provenance;
use crate::shadow::hybrid::Hybrid;
use crate::shadow::projected::{Projected, ProjectedOnGpu};
use crate::shadow::ray_cast::RayCast;
use crate::shadow::shadow_map::ShadowMap;
use crate::shadow::smoothie::Smoothie;
use crate::shadow::soft_picture::SoftPicture;
use crate::shadow::stencil::Stencil;
use crate::shadow::{Scene, Silhouettes, Technique};
use crate::silhouette::ProcessorFinder;
use crate::site::{GroundKind, Site};
use crate::view::{Tile, View};
use std::sync::Arc;

/// A technique with everything that it needs to be made for a view.
#[derive(Clone)]
pub(super) struct Machine {
    /// Never [`Method::Auto`].
    method: Method,
    /// The adapter that draws; without one, the processor draws.
    gpu: Option<Arc<Gpu>>,
    /// The finder of silhouettes, if the technique uses one.
    silhouettes: Option<Silhouettes>,
    settings: Settings,
}

impl Machine {
    /// A technique with a site's settings, on the processor.
    pub(super) fn on_processor(method: Method, site: &Site) -> Machine {
        Machine { method, gpu: None, silhouettes: None, settings: method.row().set(&site.settings) }
    }

    /// A technique with a site's settings, on an adapter.
    pub(super) fn on(gpu: Arc<Gpu>, method: Method, site: &Site) -> Machine {
        let row = method.row();
        let silhouettes = (!row.finders.is_empty()).then(|| silhouettes(row, site, &gpu));
        Machine { method, silhouettes, settings: row.set(&site.settings), gpu: Some(gpu) }
    }

    /// Ray casting with this number of samples of the sun's disc, or to its centre.
    pub(super) fn rays(sun_samples: Option<u32>) -> Machine {
        let settings = Settings { sun_samples, ..Settings::NONE };
        Machine { method: Method::RayCast, gpu: None, silhouettes: None, settings }
    }

    pub(super) fn method(&self) -> Method {
        self.method
    }

    pub(super) fn settings(&self) -> &Settings {
        &self.settings
    }

    pub(super) fn gpu(&self) -> Option<Arc<Gpu>> {
        self.gpu.clone()
    }

    pub(super) fn drawn(&self) -> Provenance {
        let finder = self.silhouettes.map(|silhouettes| match silhouettes {
            Silhouettes::OnProcessor(ProcessorFinder::BruteForce) => Finder::Brute,
            Silhouettes::OnProcessor(ProcessorFinder::Hextree { .. } | ProcessorFinder::Hierarchy) => Finder::Hextree,
            Silhouettes::OnGpu => Finder::Gpu,
            #[cfg(feature = "test-hooks")]
            Silhouettes::InVertexShader => Finder::Gpu,
        });
        Provenance {
            technique: self.method,
            finder,
            engine: if self.gpu.is_some() { Engine::Gpu } else { Engine::Cpu },
            adapter: self.gpu.as_ref().map(|gpu| gpu.name().to_owned()),
            settings: self.settings,
            resolution_secs: 0,
        }
    }

    /// The provenance over a site's track; it includes the search between instants, if the technique does one.
    pub(super) fn drawn_over(&self, site: &Site, subject: Subject) -> Provenance {
        let finds = self.method.row().finds_changes(subject, self.settings.sun_samples);
        Provenance { resolution_secs: if finds { site.track.resolution_secs } else { 0 }, ..self.drawn() }
    }

    /// An upper bound of the memory for a cell of the plan, bytes. Measured (docs/benchmarks/growth.md), and rounded
    /// up.
    pub(super) fn cell_bytes(&self, subject: Subject, wants: &Wants, searches: bool) -> u64 {
        let drawing = match (self.method, &self.gpu, subject) {
            // sums, and their copy while the state is stored
            (Method::Projected, None, Subject::Ground) => 14,
            // surfaces and judged points, three times while they are sorted
            (Method::Projected, None, _) => 160,
            (_, None, _) => 36,
            // textures of surfaces, judged depth, mask and sums, and the buffer that is read back
            (_, Some(_), _) => 64,
        };
        // bits of both ends of a gap and of what they have in common; the changes of a part of the cells
        let search = if searches && self.searches_cells(subject) { 2 + SEARCH_BYTES[0] } else { 0 };
        // bits twice; fragments as they are summed, and as they are read back
        drawing + search + u64::from(wants.bits) + if wants.statistics { 32 } else { 0 }
    }

    /// The memory for a column of the plan besides that for its cells, bytes.
    pub(super) fn column_bytes(&self, subject: Subject, searches: bool) -> u64 {
        if searches && self.searches_cells(subject) { SEARCH_BYTES[1] } else { 0 }
    }

    /// Whether times of change are searched cell by cell, and not by drawing all moments.
    fn searches_cells(&self, subject: Subject) -> bool {
        let draws_whole = self.method == Method::Projected && subject == Subject::Ground;
        self.gpu.is_none() && !draws_whole
    }

    /// The greatest number of columns and rows that can be drawn at once.
    pub(super) fn most_cells(&self) -> Option<u32> {
        self.gpu.as_ref().map(|gpu| gpu.limits.max_texture_dimension_2d)
    }

    /// The technique for a tile of the plan.
    pub(super) fn technique_of(&self, scene: Scene, tile: Tile) -> Result<Box<dyn Technique>, StudyError> {
        self.made(scene, View::Plan(tile.grid()), Some(tile))
    }

    pub(super) fn technique(&self, scene: Scene, view: View) -> Result<Box<dyn Technique>, StudyError> {
        let whole = match view {
            View::Plan(grid) => Some(Tile::from(grid)),
            View::Camera(_) | View::Elevation(_) => None,
        };
        self.made(scene, view, whole)
    }

    /// Makes each technique, one per line. [`MethodRow::fit`] lets only existing combinations through.
    fn made(&self, scene: Scene, view: View, tile: Option<Tile>) -> Result<Box<dyn Technique>, StudyError> {
        let none =
            Misfit::Technique { method: self.method, subject: subject(&view, Receivers::Top, GroundKind::Plane) };
        let Settings { map_size, filter, smoothie_width_m, sun_samples } = self.settings;
        let (map_size, filter, silhouettes) = (map_size.ok_or(none), filter.ok_or(none), self.silhouettes.ok_or(none));
        let Some(gpu) = self.gpu() else {
            return Ok(match (self.method, view, tile) {
                (Method::RayCast, _, Some(tile)) => Box::new(RayCast::of_tile(scene, tile, sun_samples)),
                (Method::RayCast, view, None) => Box::new(RayCast::new(scene, view, sun_samples)),
                (Method::Projected, _, Some(tile)) => Box::new(Projected::new(&scene, tile)),
                (Method::SoftTexture, View::Camera(camera), _) => {
                    Box::new(SoftPicture::new(scene, camera, sun_samples.ok_or(none)?))
                }
                _ => return Err(none.into()),
            });
        };
        Ok(match (self.method, view) {
            (Method::Stencil, view) => Box::new(Stencil::new(gpu, scene, view, silhouettes?)?),
            (Method::Projected, View::Plan(grid)) => Box::new(ProjectedOnGpu::new(gpu, &scene, grid)?),
            (Method::ShadowMap, view) => Box::new(ShadowMap::new(gpu, &scene, view, map_size?, filter?)?),
            (Method::Hybrid, view) => Box::new(Hybrid::new(gpu, scene, view, silhouettes?, map_size?)?),
            (Method::Smoothie, view) => {
                let Silhouettes::OnProcessor(finder) = silhouettes? else { return Err(none.into()) };
                Box::new(Smoothie::new(gpu, scene, view, finder, map_size?, smoothie_width_m)?)
            }
            _ => return Err(none.into()),
        })
    }
}

/// The finder that was requested, otherwise the fastest for the adapter.
///
/// Measured (docs/benchmarks/silhouettes.md): on a software adapter the processor's hierarchy takes less time than a
/// shader's pass over all edges. On a real adapter that pass costs nothing beside the drawing, and saves the upload of
/// silhouettes.
fn silhouettes(row: &MethodRow, site: &Site, gpu: &Gpu) -> Silhouettes {
    let is_quicker = site.finder == Finder::Auto && !gpu.software();
    if row.finders.contains(&Finder::Gpu) && (site.finder == Finder::Gpu || is_quicker) {
        return Silhouettes::OnGpu;
    }
    match (site.finder, site.hextree_depth) {
        (Finder::Brute, _) => ProcessorFinder::BruteForce.into(),
        (Finder::Hextree, Some(depth)) => ProcessorFinder::Hextree { depth }.into(),
        _ => ProcessorFinder::Hierarchy.into(),
    }
}
