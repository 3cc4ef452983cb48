//! Who draws: technique, engine and finder as asked, or the fastest of them.

use super::{Event, OnEvent, StudyError, tell};
use crate::gpu::{Gpu, GpuError};
use crate::profile::Drawn;
use crate::shadow::ray_cast::RayCast;
use crate::shadow::stencil::Stencil;
use crate::shadow::{Scene, ShadowError, Silhouettes, Technique};
use crate::silhouette::Kind;
use crate::site::{Engine, Finder, Method, Site};
use crate::view::View;
use std::sync::Arc;

/// The stencil on the graphics adapter, with who finds its silhouettes; or ray casting on the processor.
pub(super) struct Machine {
    stencil: Option<(Arc<Gpu>, Silhouettes)>,
}

impl Machine {
    const RAY_CASTING: Machine = Machine { stencil: None };

    fn stencil(gpu: Gpu, site: &Site) -> Machine {
        let silhouettes = silhouettes(site, &gpu);
        Machine { stencil: Some((Arc::new(gpu), silhouettes)) }
    }

    pub(super) fn gpu(&self) -> Option<Arc<Gpu>> {
        self.stencil.as_ref().map(|(gpu, _)| Arc::clone(gpu))
    }

    pub(super) fn drawn(&self) -> Drawn {
        match &self.stencil {
            Some((gpu, silhouettes)) => Drawn {
                technique: Method::Stencil.word(),
                silhouette: Some(match silhouettes {
                    Silhouettes::OnProcessor(Kind::BruteForce) => Finder::Brute.word(),
                    Silhouettes::OnProcessor(Kind::Hextree { .. } | Kind::Hierarchy) => Finder::Hextree.word(),
                    Silhouettes::OnGpu | Silhouettes::InVertexShader => Finder::Gpu.word(),
                }),
                engine: Engine::Gpu.word(),
                adapter: Some(gpu.name().to_owned()),
            },
            None => {
                Drawn { technique: Method::RayCast.word(), silhouette: None, engine: Engine::Cpu.word(), adapter: None }
            }
        }
    }

    pub(super) fn technique(&self, scene: Scene, view: View) -> Result<Box<dyn Technique>, ShadowError> {
        Ok(match &self.stencil {
            Some((gpu, silhouettes)) => Box::new(Stencil::new(Arc::clone(gpu), scene, view, *silhouettes)?),
            None => Box::new(RayCast::new(scene, view)),
        })
    }
}

/// Who finds silhouettes, as asked; else the fastest for the adapter.
///
/// Measured (docs/benchmarks/silhouettes.md): where the adapter is a program on the processor, the processor's hierarchy
/// takes less time than a shader's pass over all edges. A real adapter has that pass for nothing beside the drawing, and
/// is spared the upload of what is found.
fn silhouettes(site: &Site, gpu: &Gpu) -> Silhouettes {
    match (site.finder, site.hextree_depth) {
        (Finder::Brute, _) => Kind::BruteForce.into(),
        (Finder::Hextree, Some(depth)) => Kind::Hextree { depth }.into(),
        (Finder::Hextree, None) => Kind::Hierarchy.into(),
        (Finder::Gpu, _) => Silhouettes::OnGpu,
        (Finder::Auto, _) if gpu.software() => Kind::Hierarchy.into(),
        (Finder::Auto, _) => Silhouettes::OnGpu,
    }
}

/// Technique and engine as asked; else the stencil on a real graphics adapter, and ray casting on the processor.
pub(super) fn choose(site: &Site, on_event: &mut OnEvent<'_>) -> Result<Machine, StudyError> {
    let conflict = |option, what| Err(StudyError::Conflict { option, what });
    let open = || Gpu::open().map(|gpu| Machine::stencil(gpu, site));
    let machine = match (site.method, site.engine) {
        (Method::Stencil, Engine::Cpu) => {
            return conflict("--engine", "the technique stencil draws on the gpu; take --technique ray-cast with cpu");
        }
        (Method::RayCast, Engine::Gpu) => {
            return conflict("--engine", "the technique ray-cast works on the cpu; take --technique stencil with gpu");
        }
        (Method::RayCast, _) | (Method::Auto, Engine::Cpu) => Machine::RAY_CASTING,
        (Method::Stencil, _) | (Method::Auto, Engine::Gpu) => open()?,
        // silhouettes are asked, and only the stencil has them
        (Method::Auto, Engine::Auto) if site.finder != Finder::Auto => open()?,
        (Method::Auto, Engine::Auto) => match open() {
            // measured (docs/benchmarks): a stencil drawn in software is slower than casting the rays outright
            Ok(machine) if machine.gpu().is_some_and(|gpu| gpu.software()) => Machine::RAY_CASTING,
            Ok(machine) => machine,
            Err(error) => {
                tell(on_event, Event::Note(format!("{}: drawing on the processor", why_none(error))))?;
                Machine::RAY_CASTING
            }
        },
    };
    if machine.stencil.is_none() && site.finder != Finder::Auto {
        return conflict("--silhouette", "ray casting on the processor uses no silhouettes; leave the option out");
    }
    Ok(machine)
}

/// The stencil, whose volumes and silhouettes are asked for: on a software adapter too.
pub(super) fn stencil_alone(site: &Site) -> Result<Machine, StudyError> {
    if !matches!(site.method, Method::Auto | Method::Stencil) || site.engine == Engine::Cpu {
        let what = "volumes and silhouette are drawn by the technique stencil on the gpu alone; \
                    take --technique stencil without --engine cpu, or leave them out";
        return Err(StudyError::Conflict { option: "--show", what });
    }
    let gpu = Gpu::open().map_err(|error| StudyError::NoVolumes(why_none(error)))?;
    Ok(Machine::stencil(gpu, site))
}

/// Why no graphics adapter draws.
fn why_none(error: GpuError) -> String {
    match error {
        GpuError::NoAdapter => "no graphics adapter was found".to_owned(),
        GpuError::Unusable { adapter, reason } | GpuError::Failed { adapter, reason } => {
            format!("the graphics adapter '{adapter}' cannot be used ({reason})")
        }
    }
}
