//! Chooses who draws: technique, engine and finder of the request, or the fastest of them.

use super::machine::Machine;
use super::{Event, OnEvent, StudyError, subject_of, tell};
use crate::choice::{Engine, Finder, Method, MethodRow, Receivers, Settings, Subject, TABLE, listed};
use crate::gpu::{Gpu, GpuError};
use crate::message::{Field, message};
use crate::site::Site;
use crate::view::View;
use std::sync::Arc;

/// The adapter that is open already, else one that is opened.
pub(super) fn opened(gpu: Option<&Arc<Gpu>>) -> Result<Arc<Gpu>, GpuError> {
    gpu.map_or_else(|| Gpu::open().map(Arc::new), |gpu| Ok(Arc::clone(gpu)))
}

/// Technique and engine as asked; else projection on the plan, and ray casting for a camera, but on a real graphics
/// adapter the stencil, unless it is the ground's plane alone that is judged.
///
/// A projected instant on the plane takes less time than opening an adapter does, so none is opened for it
/// (docs/benchmarks/peers.md). What draws on an adapter does so on the one that is open already, where there is one.
pub(super) fn choose(
    gpu: Option<&Arc<Gpu>>,
    site: &Site,
    view: &View,
    on_event: &mut OnEvent<'_>,
) -> Result<Machine, StudyError> {
    let subject = subject_of(site, view);
    let method = if site.method == Method::Auto { automatic(site, subject) } else { site.method };
    let engine = method.row().fit(site.engine, subject)?;
    method.row().check(site.finder, &site.settings, site.engine, subject)?;
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
        Err(error) => tell(on_event, Event::Note(format!("{}: drawing on the processor", error.why()).into()))?,
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
    let is_plan = matches!(subject, Subject::Top | Subject::Ground | Subject::Terrain);
    if is_plan && is_plain(site) { Method::Projected } else { Method::RayCast }
}

/// Whether no option of a single technique is given.
fn is_plain(site: &Site) -> bool {
    site.settings == Settings::NONE && site.finder == Finder::Auto
}

/// A technique that counts, as something asks what that took: as asked, otherwise the stencil.
pub(super) fn counting(gpu: Option<&Arc<Gpu>>, site: &Site, view: &View, field: Field) -> Result<Machine, StudyError> {
    not_side(view, field)?;
    let method = match site.method {
        Method::Auto => Method::Stencil,
        method => method,
    };
    if !method.row().counts || site.engine == Engine::Cpu {
        let message = message![
            "only techniques that count shadow volumes tell it, on the gpu";
            "take ", (Field::Technique, listed(&tellers(field), "or")), " without ", (Field::Engine, "cpu"), ", or leave it out"
        ];
        return Err(StudyError::Conflict { field, message });
    }
    method.row().check(site.finder, &site.settings, site.engine, subject_of(site, view))?;
    Ok(Machine::on(opened(gpu)?, method, site))
}

/// The words of the techniques that tell what a field asks of counting.
fn tellers(field: Field) -> Vec<&'static str> {
    let tells = |row: &&MethodRow| if field == Field::MaskDiagram { row.shows_mask } else { row.counts };
    TABLE.iter().filter(tells).map(|row| row.word).collect()
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
    Method::Stencil.row().check(site.finder, &site.settings, site.engine, subject_of(site, view))?;
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
pub(crate) fn not_patches(site: &Site) -> Result<(), StudyError> {
    if site.receivers == Receivers::Patches {
        let message = message![
            "surfaces are judged in a study's profile alone";
            "take top or ground, or leave it out"
        ];
        return Err(StudyError::Conflict { field: Field::Receivers, message });
    }
    Ok(())
}
