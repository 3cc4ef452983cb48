//! Chooses the technique, the engine and the finder: those of the request, or the fastest.

use super::machine::Machine;
use super::{Event, OnEvent, StudyError, subject_of, tell};
use crate::choice::{Engine, Finder, Method, MethodRow, Receivers, Settings, Subject, TABLE, listed};
use crate::gpu::{Gpu, GpuError};
use crate::message::{Field, message};
use crate::site::Site;
use crate::view::View;
use std::sync::Arc;

/// Returns the adapter that is open, or opens one.
pub(super) fn opened(gpu: Option<&Arc<Gpu>>) -> Result<Arc<Gpu>, GpuError> {
    gpu.map_or_else(|| Gpu::open().map(Arc::new), |gpu| Ok(Arc::clone(gpu)))
}

/// Technique and engine as requested. By default: projection for the plan, and ray casting for a camera; but on a real
/// graphics adapter the stencil, unless only the ground's plane is judged.
///
/// Projecting an instant onto the plane takes less time than opening an adapter, so none is opened for that
/// (docs/benchmarks/peers.md). A technique on the adapter uses the one that is open, if there is one.
pub(super) fn choose(
    gpu: Option<&Arc<Gpu>>,
    site: &Site,
    view: &View,
    on_event: &mut OnEvent<'_>,
) -> Result<Machine, StudyError> {
    let subject = subject_of(site, view);
    let method = if site.method == Method::Auto { automatic(site, subject) } else { site.method };
    let engine = method.row().fit(site.engine, subject).map_err(|misfit| StudyError::of_site(site, misfit))?;
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

/// What [`Method::Auto`] stands for; itself if that depends on the machine's adapter.
fn automatic(site: &Site, subject: Subject) -> Method {
    let on_ground = subject == Subject::Ground && is_plain(site);
    match (site.engine, site.finder) {
        // only ray casting draws a side
        _ if subject == Subject::Side => Method::RayCast,
        (Engine::Cpu, _) => on_processor(site, subject),
        // measured (docs/benchmarks/instants.md): filling faces needs neither silhouettes nor counting
        (Engine::Gpu | Engine::Auto, _) if on_ground => Method::Projected,
        // a finder is requested, and of the exact techniques only the stencil uses one
        (Engine::Gpu, _) | (Engine::Auto, Finder::Brute | Finder::Hextree | Finder::Gpu) => Method::Stencil,
        // the adapter is not all that decides: a setting of a single technique names it
        (Engine::Auto, Finder::Auto) => Method::Auto,
    }
}

/// The fastest exact technique on the processor.
fn on_processor(site: &Site, subject: Subject) -> Method {
    let is_plan = matches!(subject, Subject::Top | Subject::Ground | Subject::Terrain);
    if is_plan && is_plain(site) { Method::Projected } else { Method::RayCast }
}

/// Whether no setting of a single technique is given.
fn is_plain(site: &Site) -> bool {
    site.settings == Settings::NONE && site.finder == Finder::Auto
}

/// A technique that counts, for a request that needs its counts: the requested one, otherwise the stencil.
pub(super) fn counting(gpu: Option<&Arc<Gpu>>, site: &Site, view: &View, field: Field) -> Result<Machine, StudyError> {
    not_side(view, field)?;
    let method = match site.method {
        Method::Auto => Method::Stencil,
        method => method,
    };
    if !method.row().counts || site.engine == Engine::Cpu {
        let message = message![
            "only techniques that count shadow volumes report it, on the gpu";
            "take ", (Field::Technique, listed(&tellers(field), "or")), " without ", (Field::Engine, "cpu"), ", or leave it out"
        ];
        return Err(StudyError::Conflict { field, message });
    }
    method.row().check(site.finder, &site.settings, site.engine, subject_of(site, view))?;
    Ok(Machine::on(opened(gpu)?, method, site))
}

/// The words of the techniques that report what a field asks for.
fn tellers(field: Field) -> Vec<&'static str> {
    let tells = |row: &&MethodRow| if field == Field::MaskDiagram { row.shows_mask } else { row.counts };
    TABLE.iter().filter(tells).map(|row| row.word).collect()
}

/// The technique that draws volumes and silhouette; a software adapter will do.
pub(super) fn of_volumes(gpu: Option<&Arc<Gpu>>, site: &Site, view: &View) -> Result<Machine, StudyError> {
    not_side(view, Field::Volumes)?;
    let allowed = |method: &Method| matches!(site.method, Method::Auto) || site.method == *method;
    let Some(method) = Method::of_volumes().filter(allowed).filter(|_| site.engine != Engine::Cpu) else {
        let word = Method::of_volumes().map_or("", Method::word);
        let message = message![
            format!("only the technique {word} on the gpu draws volumes and silhouette");
            "take ", (Field::Technique, word), " without ", (Field::Engine, "cpu"), ", or leave them out"
        ];
        return Err(StudyError::Conflict { field: Field::Volumes, message });
    };
    method.row().check(site.finder, &site.settings, site.engine, subject_of(site, view))?;
    let gpu = opened(gpu).map_err(|error| StudyError::NoVolumes(error.why()))?;
    Ok(Machine::on(gpu, method, site))
}

/// Refuses a side: volumes are drawn and counted only in the plan and in perspective.
fn not_side(view: &View, field: Field) -> Result<(), StudyError> {
    if matches!(view, View::Elevation(_)) {
        let message = message![
            "a side is drawn by ray casting, which has no shadow volumes";
            "choose another view, or leave it out"
        ];
        return Err(StudyError::Conflict { field, message });
    }
    Ok(())
}

/// Refuses patches: masks are for plans and cameras' pictures.
pub(crate) fn not_patches(site: &Site) -> Result<(), StudyError> {
    if site.receivers == Receivers::Patches {
        let message = message![
            "only a study's profile judges surfaces";
            "take top or ground, or leave it out"
        ];
        return Err(StudyError::Conflict { field: Field::Receivers, message });
    }
    Ok(())
}
