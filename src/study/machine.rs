//! Who draws: technique, engine and finder as asked, or the fastest of them.

use super::{Event, OnEvent, StudyError, Wants, judged, subject, tell};
use crate::choice::{Engine, Finder, Method, MethodRow, Misfit, Receivers, Settings, Subject};
use crate::gpu::{Gpu, GpuError};
use crate::message::{Field, message};
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
use crate::site::Site;
use crate::view::{Tile, View};
use std::sync::Arc;

/// A technique with all that it needs to be made for a view.
#[derive(Clone)]
pub(super) struct Machine {
    /// Never [`Method::Auto`].
    method: Method,
    /// The adapter that draws; the processor does where there is none.
    gpu: Option<Arc<Gpu>>,
    /// Who finds silhouettes, where the technique has any.
    silhouettes: Option<Silhouettes>,
    settings: Settings,
}

impl Machine {
    /// A technique as a site sets it, on the processor.
    pub(super) fn on_processor(method: Method, site: &Site) -> Machine {
        Machine { method, gpu: None, silhouettes: None, settings: method.row().set(&site.settings) }
    }

    /// A technique as a site sets it, on an adapter.
    pub(super) fn on(gpu: Arc<Gpu>, method: Method, site: &Site) -> Machine {
        let row = method.row();
        let silhouettes = (!row.finders.is_empty()).then(|| silhouettes(row, site, &gpu));
        Machine { method, silhouettes, settings: row.set(&site.settings), gpu: Some(gpu) }
    }

    /// Rays to so many points of the sun's disc, or to its centre.
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
            Silhouettes::OnGpu | Silhouettes::InVertexShader => Finder::Gpu,
        });
        Provenance {
            technique: self.method,
            finder,
            engine: if self.gpu.is_some() { Engine::Gpu } else { Engine::Cpu },
            adapter: self.gpu.as_ref().map(|gpu| gpu.name().to_owned()),
            settings: self.settings,
        }
    }

    /// What a cell of the plan takes at the most, bytes. Measured (docs/benchmarks/growth.md), and rounded up.
    pub(super) fn cell_bytes(&self, receivers: Receivers, wants: &Wants) -> u64 {
        let drawing = match (self.method, &self.gpu, receivers) {
            // sums, and their copy while they are kept
            (Method::Projected, None, Receivers::Ground) => 14,
            // what is seen, and the points that are judged, three times over while they are sorted
            (Method::Projected, None, _) => 160,
            (_, None, _) => 36,
            // textures of what is seen, of the depth that is judged, of mask and sums; and what is read back
            (_, Some(_), _) => 64,
        };
        // bits twice; fragments as they are added up, and as they are read
        drawing + u64::from(wants.bits) + if wants.statistics { 32 } else { 0 }
    }

    /// The most columns and rows that are drawn at once.
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

    /// Each technique is made here, in a line. What [`MethodRow::fit`] lets through has one; all else is no technique's.
    fn made(&self, scene: Scene, view: View, tile: Option<Tile>) -> Result<Box<dyn Technique>, StudyError> {
        let none = Misfit::Technique { method: self.method, subject: subject(&view, Receivers::Top) };
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

/// The adapter that is open already, else one that is opened.
pub(super) fn opened(gpu: Option<&Arc<Gpu>>) -> Result<Arc<Gpu>, GpuError> {
    gpu.map_or_else(|| Gpu::open().map(Arc::new), |gpu| Ok(Arc::clone(gpu)))
}

/// Who finds silhouettes, as asked; else the fastest for the adapter.
///
/// Measured (docs/benchmarks/silhouettes.md): where the adapter is a program on the processor, the processor's hierarchy
/// takes less time than a shader's pass over all edges. A real adapter has that pass for nothing beside the drawing, and
/// is spared the upload of what is found.
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

/// Technique and engine as asked; else projection on the plan, and ray casting for a camera, but on a real graphics adapter
/// the stencil, unless it is the ground alone that is judged.
///
/// A projected instant on the ground takes less time than opening an adapter does, so none is opened for it
/// (docs/benchmarks/peers.md). What draws on an adapter does so on the one that is open already, where there is one.
pub(super) fn choose(
    gpu: Option<&Arc<Gpu>>,
    site: &Site,
    view: &View,
    on_event: &mut OnEvent<'_>,
) -> Result<Machine, StudyError> {
    let subject = subject(view, judged(site, view));
    let method = if site.method == Method::Auto { automatic(site, subject) } else { site.method };
    let engine = method.row().fit(site.engine, subject)?;
    method.row().check(site.finder, &site.settings, subject)?;
    if method != Method::Auto {
        return Ok(match engine {
            Engine::Gpu => Machine::on(opened(gpu)?, method, site),
            Engine::Auto | Engine::Cpu => Machine::on_processor(method, site),
        });
    }
    match opened(gpu) {
        // measured (docs/benchmarks): a stencil drawn in software is slower than either
        Ok(gpu) if gpu.software() => {}
        Ok(gpu) => return Ok(Machine::on(gpu, Method::Stencil, site)),
        Err(error) => tell(on_event, Event::Note(format!("{}: drawing on the processor", error.why())))?,
    }
    Ok(Machine::on_processor(on_processor(site, subject), site))
}

/// What [`Method::Auto`] is; itself where that is for the machine's adapter to say.
fn automatic(site: &Site, subject: Subject) -> Method {
    let on_ground = subject == Subject::Ground && is_plain(site);
    match (site.engine, site.finder) {
        // rays alone draw it
        _ if subject == Subject::Side => Method::RayCast,
        (Engine::Cpu, _) => on_processor(site, subject),
        // measured (docs/benchmarks/instants.md): faces that are filled need no silhouette, and no count
        (Engine::Gpu | Engine::Auto, _) if on_ground => Method::Projected,
        // silhouettes are asked, and of the exact techniques only the stencil has them
        (Engine::Gpu, _) | (Engine::Auto, Finder::Brute | Finder::Hextree | Finder::Gpu) => Method::Stencil,
        // what it will be does not depend on the adapter alone: a setting of one technique names it
        (Engine::Auto, Finder::Auto) => Method::Auto,
    }
}

/// The fastest exact technique on the processor.
fn on_processor(site: &Site, subject: Subject) -> Method {
    let is_plan = matches!(subject, Subject::Top | Subject::Ground);
    if is_plan && is_plain(site) { Method::Projected } else { Method::RayCast }
}

/// Whether no option of a single technique is given.
fn is_plain(site: &Site) -> bool {
    site.settings == Settings::NONE && site.finder == Finder::Auto
}

/// A technique that counts, as something asks what that took: as asked, else the stencil.
pub(super) fn counting(gpu: Option<&Arc<Gpu>>, site: &Site, view: &View, field: Field) -> Result<Machine, StudyError> {
    not_side(view, field)?;
    let method = match site.method {
        Method::Auto => Method::Stencil,
        method => method,
    };
    if !method.row().counts || site.engine == Engine::Cpu {
        let message = message![
            "only techniques that count shadow volumes tell it, on the gpu";
            "take ", (Field::Technique, Method::Hybrid.word()), " without ", (Field::Engine, "cpu"), ", or leave it out"
        ];
        return Err(StudyError::Conflict { field, message });
    }
    method.row().check(site.finder, &site.settings, subject(view, judged(site, view)))?;
    Ok(Machine::on(opened(gpu)?, method, site))
}

/// The stencil, whose volumes and silhouettes are asked for: on a software adapter too.
pub(super) fn stencil_alone(gpu: Option<&Arc<Gpu>>, site: &Site, view: &View) -> Result<Machine, StudyError> {
    not_side(view, Field::Volumes)?;
    if !matches!(site.method, Method::Auto | Method::Stencil) || site.engine == Engine::Cpu {
        let message = message![
            "volumes and silhouette are drawn by the technique stencil on the gpu alone";
            "take ", (Field::Technique, Method::Stencil.word()), " without ", (Field::Engine, "cpu"), ", or leave them out"
        ];
        return Err(StudyError::Conflict { field: Field::Volumes, message });
    }
    Method::Stencil.row().check(site.finder, &site.settings, subject(view, judged(site, view)))?;
    let gpu = opened(gpu).map_err(|error| StudyError::NoVolumes(error.why()))?;
    Ok(Machine::on(gpu, Method::Stencil, site))
}

/// Volumes are drawn and counted in the plan and in perspective.
fn not_side(view: &View, field: Field) -> Result<(), StudyError> {
    if matches!(view, View::Elevation(_)) {
        let message = message![
            "rays alone draw a side, and there are no shadow volumes in it";
            "look from elsewhere, or leave it out"
        ];
        return Err(StudyError::Conflict { field, message });
    }
    Ok(())
}

/// Masks are of a plan or of a camera's picture.
pub(super) fn not_surfaces(site: &Site) -> Result<(), StudyError> {
    if site.receivers == Receivers::Surfaces {
        let message = message![
            "surfaces are judged by gnomon profile alone";
            "take top or ground, or leave it out"
        ];
        return Err(StudyError::Conflict { field: Field::Receivers, message });
    }
    Ok(())
}
