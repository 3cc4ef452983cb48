//! Who draws: technique, engine and finder as asked, or the fastest of them.

use super::{Event, OnEvent, StudyError, Wants, tell};
use crate::gpu::{Gpu, GpuError};
use crate::message::{Field, Message, message};
use crate::profile::{Drawn, DrawnSettings};
use crate::shadow::hybrid::Hybrid;
use crate::shadow::map;
use crate::shadow::projected::{Projected, ProjectedOnGpu};
use crate::shadow::ray_cast::RayCast;
use crate::shadow::shadow_map::{Filter, ShadowMap};
use crate::shadow::smoothie::Smoothie;
use crate::shadow::soft_picture::{self, SoftPicture};
use crate::shadow::stencil::Stencil;
use crate::shadow::{Scene, ShadowError, Silhouettes, Technique};
use crate::silhouette::Kind;
use crate::site::{Engine, Finder, Method, Pcf, Receivers, Settings, Site};
use crate::view::{Camera, Grid, Tile, View};
use std::sync::Arc;

/// A technique with all that it needs to be made for a view.
#[derive(Clone)]
pub(super) enum Machine {
    /// Rays on the processor, to so many points of the sun's disc, or its centre.
    RayCast { sun_samples: Option<u32> },
    /// Faces projected onto what a plan sees, on the processor.
    Projected(Grid),
    /// Textures of what a camera sees, with so many points of the sun's disc, on the processor.
    SoftPicture { camera: Camera, sun_samples: u32 },
    /// Anything else.
    OnGpu(Arc<Gpu>, Drawing),
}

/// A technique of the graphics adapter.
#[derive(Clone, Copy)]
pub(super) enum Drawing {
    Stencil(Silhouettes),
    /// On the ground of a plan alone.
    Projected(Grid),
    ShadowMap {
        size: u32,
        filter: Filter,
    },
    Hybrid {
        silhouettes: Silhouettes,
        map_size: u32,
    },
    Smoothie {
        finder: Kind,
        map_size: u32,
        width_m: Option<f64>,
    },
}

impl Drawing {
    /// A technique as a site asks for it; [`Method::Auto`] is the stencil.
    pub(super) fn of(method: Method, site: &Site, gpu: &Gpu) -> Drawing {
        let settings = &site.settings;
        let map_size = settings.map_size.unwrap_or(map::DEFAULT_SIZE);
        match method {
            Method::ShadowMap => Drawing::ShadowMap {
                size: map_size,
                filter: match settings.pcf {
                    Some(Pcf::None) => Filter::None,
                    Some(Pcf::TwoByTwo) => Filter::TwoByTwo,
                    Some(Pcf::FastTwoByTwo) | None => Filter::FastTwoByTwo,
                    Some(Pcf::FastFourByFour) => Filter::FastFourByFour,
                },
            },
            Method::Hybrid => Drawing::Hybrid { silhouettes: silhouettes(site, gpu), map_size },
            Method::Smoothie => Drawing::Smoothie { finder: kind(site), map_size, width_m: settings.smoothie_width_m },
            Method::Stencil | Method::Auto | Method::RayCast | Method::Projected | Method::SoftTexture => {
                Drawing::Stencil(silhouettes(site, gpu))
            }
        }
    }
}

impl Machine {
    /// On the adapter that is open already, else on one that is opened.
    fn open(site: &Site, gpu: Option<&Arc<Gpu>>) -> Result<Machine, GpuError> {
        let gpu = opened(gpu)?;
        let drawing = Drawing::of(site.method, site, &gpu);
        Ok(Machine::OnGpu(gpu, drawing))
    }

    pub(super) fn gpu(&self) -> Option<Arc<Gpu>> {
        match self {
            Machine::RayCast { .. } | Machine::Projected(_) | Machine::SoftPicture { .. } => None,
            Machine::OnGpu(gpu, _) => Some(Arc::clone(gpu)),
        }
    }

    pub(super) fn drawn(&self) -> Drawn {
        let found = |silhouettes: &Silhouettes| match silhouettes {
            Silhouettes::OnProcessor(Kind::BruteForce) => Finder::Brute.word(),
            Silhouettes::OnProcessor(Kind::Hextree { .. } | Kind::Hierarchy) => Finder::Hextree.word(),
            Silhouettes::OnGpu | Silhouettes::InVertexShader => Finder::Gpu.word(),
        };
        let (method, silhouette) = match self {
            Machine::RayCast { .. } => (Method::RayCast, None),
            Machine::Projected(_) => (Method::Projected, None),
            Machine::SoftPicture { .. } => (Method::SoftTexture, None),
            Machine::OnGpu(_, Drawing::Stencil(silhouettes)) => (Method::Stencil, Some(found(silhouettes))),
            Machine::OnGpu(_, Drawing::Projected(_)) => (Method::Projected, None),
            Machine::OnGpu(_, Drawing::ShadowMap { .. }) => (Method::ShadowMap, None),
            Machine::OnGpu(_, Drawing::Hybrid { silhouettes, .. }) => (Method::Hybrid, Some(found(silhouettes))),
            Machine::OnGpu(_, Drawing::Smoothie { finder, .. }) => (Method::Smoothie, Some(found(&(*finder).into()))),
        };
        let mut settings = DrawnSettings::default();
        match *self {
            Machine::RayCast { sun_samples } => settings.sun_samples = sun_samples,
            Machine::SoftPicture { sun_samples, .. } => settings.sun_samples = Some(sun_samples),
            Machine::Projected(_) | Machine::OnGpu(_, Drawing::Stencil(_) | Drawing::Projected(_)) => {}
            Machine::OnGpu(_, Drawing::ShadowMap { size, filter }) => {
                settings.map_size = Some(size);
                settings.pcf = Some(pcf(filter).word());
            }
            Machine::OnGpu(_, Drawing::Hybrid { map_size, .. }) => settings.map_size = Some(map_size),
            Machine::OnGpu(_, Drawing::Smoothie { map_size, width_m, .. }) => {
                settings.map_size = Some(map_size);
                settings.smoothie_width = width_m;
            }
        }
        let (engine, adapter) = match self {
            Machine::RayCast { .. } | Machine::Projected(_) | Machine::SoftPicture { .. } => (Engine::Cpu, None),
            Machine::OnGpu(gpu, _) => (Engine::Gpu, Some(gpu.name().to_owned())),
        };
        Drawn { technique: method.word(), silhouette, engine: engine.word(), adapter, settings }
    }

    /// What a cell of the plan takes at the most, bytes. Measured (docs/benchmarks/growth.md), and rounded up.
    pub(super) fn cell_bytes(&self, receivers: Receivers, wants: &Wants) -> u64 {
        let drawing = match (self, receivers) {
            // sums, and their copy while they are kept
            (Machine::Projected(_), Receivers::Ground) => 14,
            // what is seen, and the points that are judged, three times over while they are sorted
            (Machine::Projected(_), _) => 160,
            (Machine::RayCast { .. } | Machine::SoftPicture { .. }, _) => 36,
            // textures of what is seen, of the depth that is judged, of mask and sums; and what is read back
            (Machine::OnGpu(..), _) => 64,
        };
        // bits twice; fragments as they are added up, and as they are read
        drawing + u64::from(wants.bits) + if wants.statistics { 32 } else { 0 }
    }

    /// The most columns and rows that are drawn at once.
    pub(super) fn most_cells(&self) -> Option<u32> {
        self.gpu().map(|gpu| gpu.limits.max_texture_dimension_2d)
    }

    /// The technique for a tile of the plan.
    pub(super) fn technique_of(&self, scene: Scene, tile: Tile) -> Result<Box<dyn Technique>, ShadowError> {
        match self {
            Machine::RayCast { sun_samples } => Ok(Box::new(RayCast::of_tile(scene, tile, *sun_samples))),
            Machine::Projected(_) => Ok(Box::new(Projected::new(&scene, tile))),
            Machine::OnGpu(gpu, Drawing::Projected(_)) => {
                Machine::OnGpu(Arc::clone(gpu), Drawing::Projected(tile.grid()))
                    .technique(scene, View::Plan(tile.grid()))
            }
            Machine::SoftPicture { .. } | Machine::OnGpu(..) => self.technique(scene, View::Plan(tile.grid())),
        }
    }

    pub(super) fn technique(&self, scene: Scene, view: View) -> Result<Box<dyn Technique>, ShadowError> {
        let (gpu, drawing) = match self {
            Machine::RayCast { sun_samples } => return Ok(Box::new(RayCast::new(scene, view, *sun_samples))),
            Machine::Projected(grid) => return Ok(Box::new(Projected::new(&scene, *grid))),
            Machine::SoftPicture { camera, sun_samples } => {
                return Ok(Box::new(SoftPicture::new(scene, *camera, *sun_samples)));
            }
            Machine::OnGpu(gpu, drawing) => (Arc::clone(gpu), *drawing),
        };
        Ok(match drawing {
            Drawing::Stencil(silhouettes) => Box::new(Stencil::new(gpu, scene, view, silhouettes)?),
            Drawing::Projected(grid) => Box::new(ProjectedOnGpu::new(gpu, &scene, grid)?),
            Drawing::ShadowMap { size, filter } => Box::new(ShadowMap::new(gpu, &scene, view, size, filter)?),
            Drawing::Hybrid { silhouettes, map_size } => {
                Box::new(Hybrid::new(gpu, scene, view, silhouettes, map_size)?)
            }
            Drawing::Smoothie { finder, map_size, width_m } => {
                Box::new(Smoothie::new(gpu, scene, view, finder, map_size, width_m)?)
            }
        })
    }
}

/// The adapter that is open already, else one that is opened.
pub(super) fn opened(gpu: Option<&Arc<Gpu>>) -> Result<Arc<Gpu>, GpuError> {
    gpu.map_or_else(|| Gpu::open().map(Arc::new), |gpu| Ok(Arc::clone(gpu)))
}

/// The word of a filter.
fn pcf(filter: Filter) -> Pcf {
    match filter {
        Filter::None => Pcf::None,
        Filter::TwoByTwo => Pcf::TwoByTwo,
        Filter::FastTwoByTwo => Pcf::FastTwoByTwo,
        Filter::FastFourByFour => Pcf::FastFourByFour,
    }
}

/// Who finds silhouettes, as asked; else the fastest for the adapter.
///
/// Measured (docs/benchmarks/silhouettes.md): where the adapter is a program on the processor, the processor's hierarchy
/// takes less time than a shader's pass over all edges. A real adapter has that pass for nothing beside the drawing, and
/// is spared the upload of what is found.
fn silhouettes(site: &Site, gpu: &Gpu) -> Silhouettes {
    match site.finder {
        Finder::Gpu => Silhouettes::OnGpu,
        Finder::Auto if !gpu.software() => Silhouettes::OnGpu,
        _ => kind(site).into(),
    }
}

/// Which of the processor's finders, as asked; else the fastest.
fn kind(site: &Site) -> Kind {
    match (site.finder, site.hextree_depth) {
        (Finder::Brute, _) => Kind::BruteForce,
        (Finder::Hextree, Some(depth)) => Kind::Hextree { depth },
        _ => Kind::Hierarchy,
    }
}

/// Options that what was asked to draw does not use.
fn unused(site: &Site, method: Method) -> Result<(), StudyError> {
    use Method::{Hybrid, RayCast, ShadowMap, Smoothie, SoftTexture, Stencil};
    let Settings { map_size, pcf, smoothie_width_m, sun_samples } = site.settings;
    let finder = site.finder;
    let rules: [(bool, &[Method], Field, Message); 6] = [
        (
            map_size.is_some(),
            &[ShadowMap, Hybrid, Smoothie],
            Field::MapSize,
            message![
                "only the techniques shadow-map, hybrid and smoothie draw a map";
                "say ", Field::Technique, " with one of them, or leave it out"
            ],
        ),
        (
            pcf.is_some(),
            &[ShadowMap],
            Field::Pcf,
            message![
                "only the technique shadow-map filters so";
                "say ", (Field::Technique, "shadow-map"), ", or leave it out"
            ],
        ),
        (
            smoothie_width_m.is_some(),
            &[Smoothie],
            Field::SmoothieWidth,
            message![
                "only the technique smoothie has smoothies";
                "say ", (Field::Technique, "smoothie"), ", or leave it out"
            ],
        ),
        (
            sun_samples.is_some(),
            &[RayCast, SoftTexture],
            Field::SunSamples,
            message![
                "only ray casting and soft-texture take points of the sun's disc";
                "say ", (Field::Technique, "ray-cast"), ", or leave it out"
            ],
        ),
        (
            finder != Finder::Auto,
            &[Stencil, Hybrid, Smoothie],
            Field::Silhouette,
            message!["only the techniques stencil, hybrid and smoothie use silhouettes"; "leave the option out"],
        ),
        (
            finder == Finder::Gpu,
            &[Stencil, Hybrid],
            Field::Silhouette,
            message![
                "smoothies take their silhouettes from the processor";
                "say brute or hextree, or leave the option out"
            ],
        ),
    ];
    for (given, users, field, message) in rules {
        if given && !users.contains(&method) {
            return Err(StudyError::Conflict { field, message });
        }
    }
    Ok(())
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
    let conflict = |message| Err(StudyError::Conflict { field: Field::Engine, message });
    let other_technique = |message| Err(StudyError::Conflict { field: Field::Technique, message });
    let cast = Machine::RayCast { sun_samples: site.settings.sun_samples };
    let plan = match view {
        View::Plan(grid) => Some(*grid),
        View::Camera(_) | View::Elevation(_) => None,
    };
    if matches!(view, View::Elevation(_)) {
        if !matches!(site.method, Method::Auto | Method::RayCast) {
            return other_technique(message![
                "rays alone draw a side";
                "take ", (Field::Technique, "ray-cast"), ", or leave it out"
            ]);
        }
        if site.engine == Engine::Gpu {
            return conflict(message!["rays alone draw a side, on the cpu"; "leave the option out"]);
        }
        unused(site, Method::RayCast)?;
        return Ok(cast);
    }
    let is_plain = site.settings == Settings::default() && site.finder == Finder::Auto;
    let on_processor = match plan {
        Some(grid) if is_plain => Machine::Projected(grid),
        _ => cast.clone(),
    };
    let ground_alone = plan.is_some() && site.receivers == Receivers::Ground;
    if let (Method::Auto, true) = (site.method, is_plain)
        && (site.engine == Engine::Cpu || (site.engine == Engine::Auto && ground_alone))
    {
        return Ok(on_processor);
    }
    let machine = match (site.method, site.engine) {
        (Method::Projected, engine) => {
            unused(site, Method::Projected)?;
            let Some(grid) = plan else {
                return other_technique(message![
                    "projected draws the plan alone";
                    "leave ", (Field::View, "camera"), " out, or take another technique"
                ]);
            };
            match engine {
                Engine::Gpu if !ground_alone => {
                    return conflict(message![
                        "on the gpu projected draws on the ground alone";
                        "add ", (Field::Receivers, "ground"), ", or take ", (Field::Technique, "stencil")
                    ]);
                }
                Engine::Gpu => Machine::OnGpu(opened(gpu)?, Drawing::Projected(grid)),
                Engine::Auto | Engine::Cpu => Machine::Projected(grid),
            }
        }
        (Method::SoftTexture, engine) => {
            let View::Camera(camera) = view else {
                return other_technique(message![
                    "soft-texture is for flat patches";
                    "add ", (Field::Receivers, "surfaces"), ", or take another technique"
                ]);
            };
            if engine == Engine::Gpu {
                return conflict(message![
                    "a camera's picture by soft-texture is drawn on the cpu";
                    "leave the option out"
                ]);
            }
            unused(site, Method::SoftTexture)?;
            let sun_samples = site.settings.sun_samples.unwrap_or(soft_picture::DEFAULT_SUN_SAMPLES);
            Machine::SoftPicture { camera: *camera, sun_samples }
        }
        (Method::RayCast, Engine::Gpu) => {
            return conflict(message![
                "the technique ray-cast works on the cpu";
                "take ", (Field::Technique, "stencil"), " with gpu"
            ]);
        }
        (Method::RayCast, _) | (Method::Auto, Engine::Cpu) => {
            unused(site, Method::RayCast)?;
            cast
        }
        (Method::Auto, Engine::Gpu) => match plan {
            // measured (docs/benchmarks/instants.md): faces that are filled need no silhouette, and no count
            Some(grid) if is_plain && ground_alone => Machine::OnGpu(opened(gpu)?, Drawing::Projected(grid)),
            _ => {
                unused(site, Method::Stencil)?;
                Machine::open(site, gpu)?
            }
        },
        // silhouettes are asked, and only the stencil has them
        (Method::Auto, Engine::Auto) if site.finder != Finder::Auto => {
            unused(site, Method::Stencil)?;
            Machine::open(site, gpu)?
        }
        (Method::Auto, Engine::Auto) => {
            // what it will be does not depend on the machine's adapter alone: a setting of one technique names it
            unused(site, Method::Auto)?;
            match Machine::open(site, gpu) {
                // measured (docs/benchmarks): a stencil drawn in software is slower than either
                Ok(machine) if machine.gpu().is_some_and(|gpu| gpu.software()) => on_processor,
                Ok(machine) => machine,
                Err(error) => {
                    tell(on_event, Event::Note(format!("{}: drawing on the processor", error.why())))?;
                    on_processor
                }
            }
        }
        (_, Engine::Cpu) => {
            return conflict(message![
                "that technique draws on the gpu";
                "take ", (Field::Technique, "ray-cast"), " with cpu"
            ]);
        }
        (method, _) => {
            unused(site, method)?;
            Machine::open(site, gpu)?
        }
    };
    Ok(machine)
}

/// A technique that counts, as something asks what that took: as asked, else the stencil.
pub(super) fn counting(gpu: Option<&Arc<Gpu>>, site: &Site, view: &View, field: Field) -> Result<Machine, StudyError> {
    not_side(view, field)?;
    let method = match site.method {
        Method::Auto => Method::Stencil,
        method => method,
    };
    if !matches!(method, Method::Stencil | Method::Hybrid) || site.engine == Engine::Cpu {
        let message = message![
            "only the techniques stencil and hybrid count, on the gpu";
            "take ", (Field::Technique, "hybrid"), " without ", (Field::Engine, "cpu"), ", or leave it out"
        ];
        return Err(StudyError::Conflict { field, message });
    }
    unused(site, method)?;
    Ok(Machine::open(site, gpu)?)
}

/// The stencil, whose volumes and silhouettes are asked for: on a software adapter too.
pub(super) fn stencil_alone(gpu: Option<&Arc<Gpu>>, site: &Site, view: &View) -> Result<Machine, StudyError> {
    not_side(view, Field::Volumes)?;
    if !matches!(site.method, Method::Auto | Method::Stencil) || site.engine == Engine::Cpu {
        let message = message![
            "volumes and silhouette are drawn by the technique stencil on the gpu alone";
            "take ", (Field::Technique, "stencil"), " without ", (Field::Engine, "cpu"), ", or leave them out"
        ];
        return Err(StudyError::Conflict { field: Field::Volumes, message });
    }
    unused(site, Method::Stencil)?;
    let gpu = opened(gpu).map_err(|error| StudyError::NoVolumes(error.why()))?;
    let drawing = Drawing::of(Method::Stencil, site, &gpu);
    Ok(Machine::OnGpu(gpu, drawing))
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
