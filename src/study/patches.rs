//! The study on patches: hours of sun on every flat patch of the receivers.

use super::again::persist;
use super::chooser::opened;
use super::event::{gather, note_instants_alone};
use super::gaps::Gaps;
use super::patch_sum::PatchSum;
use super::{Event, OnEvent, Stopwatch, StudyError, day_and_night, fingerprint, note_site, tell};
use crate::choice::{Engine, Method, Misfit, Settings, Subject};
use crate::gpu::Gpu;
use crate::mesh::Mesh;
use crate::mesh::patches::{MOST_TEXELS, Patches};
use crate::message::{Message, message, setting};
use crate::profile::{Provenance, Timings, Unfinished};
use crate::shadow::ray_cast::RayCast;
use crate::shadow::soft_texture::{Choice, Fill, Painter, PatchJudgements, SoftTexture};
use crate::shadow::{JUDGED_ABOVE_M, Scene, Technique};
use crate::site::Site;
use crate::sunlight::PatchHours;
use crate::view::Surface;
use std::cell::RefCell;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The result of a study on patches.
#[derive(Clone, Debug)]
pub struct PatchOutcome {
    /// The patches of those components of [`Site::mesh`] that receive.
    pub patches: Arc<Patches>,
    /// Their time in the sun.
    pub hours: PatchHours,
    /// How many judgements were made, and how.
    pub judged: PatchJudgements,
    /// What judged them.
    pub drawn: Provenance,
    /// The graphics adapter's memory that was used, bytes; 0 without an adapter.
    pub gpu_bytes: u64,
    /// Notes besides [`Site::notes`].
    pub notes: Vec<Message>,
    /// The stages `prepare` and `shadows`.
    pub timings: Timings,
}

/// Finds the hours of sun on patches, with texels of `cell` metres. If there would be too many, the texels are larger,
/// and a note says so. The state is not kept.
///
/// # Errors
/// As [`patches_kept`].
#[cfg(feature = "test-hooks")]
pub fn patches(site: &Site, cell: f64, on_event: &mut OnEvent<'_>) -> Result<PatchOutcome, StudyError> {
    patches_kept(site, cell, None, on_event)
}

/// Finds the hours of sun on patches, with texels of `cell` metres. If there would be too many, the texels are larger,
/// and a note says so.
///
/// At each instant the sun's centre, or with [`Settings::sun_samples`] that many points of its disc, count with the
/// instant's weight. Nothing below the ground's plane sees the sun.
///
/// A caller that keeps the state can supply it at [`Event::Prepared`], and gets it in [`Event::Kept`] at intervals and
/// when the work is ended. The sums are the same to the bit; [`PatchOutcome::judged`] counts only this run.
///
/// # Errors
/// [`StudyError`]. Contradictory choices and windows that are too long are refused before anything is drawn.
pub(crate) fn patches_kept(
    site: &Site,
    cell: f64,
    keep_every: Option<Duration>,
    on_event: &mut OnEvent<'_>,
) -> Result<PatchOutcome, StudyError> {
    let watch = Stopwatch::start();
    let samples = site.settings.sun_samples.unwrap_or(1);
    let (day_secs, _) = day_and_night(&site.track);
    let most_secs = u32::MAX / samples;
    if day_secs > most_secs {
        return Err(StudyError::TooLong { day_secs, most_secs });
    }
    note_site(site, on_event)?;
    let mut notes = Vec::new();
    let hear: &mut OnEvent<'_> = &mut |event| {
        gather(&event, &site.notes, &mut notes);
        on_event(event)
    };
    let choice = choice(site)?;
    let mut patches = Patches::of(&site.mesh, &site.receives, cell, MOST_TEXELS);
    patches.leave_out_shared(&site.mesh, &site.casts, &site.receives);
    let patches = Arc::new(patches);
    note_patches(site, &patches, hear)?;
    note_instants_alone(site, resolution_secs(site), hear)?;
    let outcome = persist(site, true, hear, &mut |site, gpu, on_event| {
        let painter = painter(gpu, site, choice, on_event)?;
        light(site, choice, &patches, painter, keep_every, watch.clone(), on_event)
    })?;
    Ok(PatchOutcome { notes, ..outcome })
}

/// Computes the sunlight on the patches, on one machine.
fn light(
    site: &Site,
    choice: Choice,
    patches: &Arc<Patches>,
    painter: Painter,
    keep_every: Option<Duration>,
    mut watch: Stopwatch,
    on_event: &mut OnEvent<'_>,
) -> Result<PatchOutcome, StudyError> {
    let (day_secs, night_secs) = day_and_night(&site.track);
    let drawn = provenance(site, choice, &painter);
    let keeping = keep_every.map(|every| KeepSchedule { every, number: number(site, &drawn, choice, patches) });
    let casters = site.mesh.of_components(&site.casts);
    let mut texture = SoftTexture::new(casters, Arc::clone(patches), painter, choice)?;
    watch.lap("prepare");
    let sum = PatchSum::new(site, drawn.resolution_secs, &mut texture);
    add_instants(site, sum, keeping, patches.texels.len(), on_event)?;
    let (judged, gpu_bytes) = (texture.judged(), texture.gpu_bytes());
    let mut lit = texture.finish()?;
    darken_underground(patches, site.ground.level, &mut lit);
    watch.lap("shadows");

    let samples = site.settings.sun_samples.unwrap_or(1);
    let hours = PatchHours { lit, samples, day_secs, night_secs };
    let (patches, timings) = (Arc::clone(patches), watch.stages);
    Ok(PatchOutcome { patches, hours, judged, drawn, gpu_bytes, notes: Vec::new(), timings })
}

/// How often the state is kept, and the study's fingerprint.
#[derive(Clone, Copy)]
struct KeepSchedule {
    every: Duration,
    number: u64,
}

/// Adds the track's instants, from where the study was stopped.
fn add_instants(
    site: &Site,
    mut sum: PatchSum<'_>,
    keeping: Option<KeepSchedule>,
    texels: usize,
    on_event: &mut OnEvent<'_>,
) -> Result<(), StudyError> {
    let count = site.track.instants.len();
    let begun = RefCell::new(None);
    if let Some(KeepSchedule { number, .. }) = keeping {
        tell(on_event, Event::Prepared { number, begun: &begun })?;
    }
    let is_of = |begun: &Unfinished| {
        keeping.is_some_and(|keeping| keeping.number == begun.study)
            && (begun.tiles, begun.statistics) == (1, None)
            && begun.done <= count
    };
    let begun = begun.into_inner().filter(is_of);
    let sums = begun.as_ref().and_then(|begun| begun.shaded.in_one_word()).filter(|sums| sums.len() == texels);
    let done = begun.as_ref().filter(|_| sums.is_some()).map_or(0, |begun| begun.done);
    tell(on_event, Event::Started { instants: count, tiles: 1 })?;
    if let Some(sums) = sums {
        sum.begin_with(sums);
        tell(on_event, Event::GoesOn { done })?;
    }
    let (mut kept, mut was_kept) = (Instant::now(), done > 0);
    for (index, instant) in site.track.instants.iter().enumerate().skip(done) {
        // the sums of a gap that is left in its midst are of no use
        let keeps = keeping.filter(|_| sum.searches_before(index));
        let before_gap = keeps.map(|_| sum.so_far()).transpose()?;
        let added = sum.add(index, on_event);
        if let (Err(StudyError::Interrupted), Some(sums), Some(KeepSchedule { number, .. })) =
            (&added, before_gap, keeping)
        {
            let (study, shaded) = (number, sums.into());
            let unfinished = Unfinished { study, tiles: 1, done: index, shaded, statistics: None };
            tell(on_event, Event::Kept(&unfinished))?;
        }
        added?;
        let told = tell(on_event, Event::Drawn { index, count, time: instant.time, mask: None, bits: None });
        let is_last = index + 1 == count && was_kept;
        if let Some(KeepSchedule { every, number }) = keeping
            && (told.is_err() || is_last || kept.elapsed() >= every)
        {
            let shaded = sum.so_far()?.into();
            let unfinished = Unfinished { study: number, tiles: 1, done: index + 1, shaded, statistics: None };
            tell(on_event, Event::Kept(&unfinished))?;
            (kept, was_kept) = (Instant::now(), true);
        }
        told?;
    }
    Ok(())
}

/// What draws.
fn provenance(site: &Site, choice: Choice, painter: &Painter) -> Provenance {
    Provenance {
        technique: match choice {
            Choice::Rays => Method::RayCast,
            Choice::Texture | Choice::Auto => Method::SoftTexture,
        },
        finder: None,
        engine: if matches!(painter, Painter::OnGpu(_)) { Engine::Gpu } else { Engine::Cpu },
        adapter: match painter {
            Painter::OnGpu(gpu) => Some(gpu.name().to_owned()),
            Painter::OnProcessor(_) => None,
        },
        settings: Settings { sun_samples: site.settings.sun_samples, ..Settings::NONE },
        resolution_secs: resolution_secs(site),
    }
}

/// The precision of times of change; 0 for a disc, whose light has none.
fn resolution_secs(site: &Site) -> u32 {
    let finds = site.method.row().finds_changes(Subject::Patches, site.settings.sun_samples);
    if finds { site.track.resolution_secs } else { 0 }
}

/// The study's fingerprint.
fn number(site: &Site, drawn: &Provenance, choice: Choice, patches: &Patches) -> u64 {
    let choice = match choice {
        Choice::Texture => "texture",
        Choice::Rays => "rays",
        Choice::Auto => "auto",
    };
    fingerprint::of_patches(site, drawn, choice, (patches.cell, patches.texels.len()))
}

/// What the site's camera sees of the receivers, for a drawing of the patches, and the mesh that its face indices refer
/// to.
///
/// # Errors
/// [`StudyError`].
pub(crate) fn seen_receivers(site: &Site) -> Result<(Mesh, Surface), StudyError> {
    let receivers = site.mesh.of_components(&site.receives);
    let scene =
        Scene { casters: site.mesh.of_components(&[]), receivers: receivers.clone(), ground: site.ground.level };
    let surface = RayCast::new(scene, site.picture(), None).surface()?;
    Ok((receivers, surface))
}

/// The technique that judges patches.
fn choice(site: &Site) -> Result<Choice, StudyError> {
    let (method, subject) = (site.method, Subject::Patches);
    method.row().fit(site.engine, subject).map_err(|misfit| StudyError::of_site(site, misfit))?;
    // both techniques that `auto` may choose use the same options
    let row = if method == Method::Auto { Method::SoftTexture.row() } else { method.row() };
    row.check(site.finder, &site.settings, site.engine, subject)?;
    Ok(way_of(method)?)
}

/// How a technique judges patches.
pub(super) fn way_of(method: Method) -> Result<Choice, Misfit> {
    match method {
        Method::Auto => Ok(Choice::Auto),
        Method::SoftTexture => Ok(Choice::Texture),
        Method::RayCast => Ok(Choice::Rays),
        // a technique that judges patches has a line above
        method => Err(Misfit::Technique { method, subject: Subject::Patches }),
    }
}

/// The engine that fills textures: the requested one, otherwise a real graphics adapter. On a software adapter, and for
/// times of change, the processor is faster: the adapter would draw every moment between two instants, while the
/// processor examines few texels at each.
///
/// Measured (docs/benchmarks/receivers.md).
fn painter(
    gpu: Option<&Arc<Gpu>>,
    site: &Site,
    choice: Choice,
    on_event: &mut OnEvent<'_>,
) -> Result<Painter, StudyError> {
    let on_processor = Painter::OnProcessor(Fill::Silhouettes);
    match site.engine {
        _ if choice == Choice::Rays => Ok(on_processor),
        Engine::Cpu => Ok(on_processor),
        Engine::Gpu => Ok(Painter::OnGpu(opened(gpu)?)),
        Engine::Auto if Gaps::new(site, resolution_secs(site)).any() => Ok(on_processor),
        Engine::Auto => match Gpu::open() {
            Ok(gpu) if gpu.software() => Ok(on_processor),
            Ok(gpu) => Ok(Painter::OnGpu(Arc::new(gpu))),
            Err(error) => {
                tell(on_event, Event::Note(format!("{}: drawing on the processor", error.why()).into()))?;
                Ok(on_processor)
            }
        },
    }
}

/// Notes coarser texels than requested, areas that do not count, and patches whose outer side is unknown.
fn note_patches(site: &Site, patches: &Patches, on_event: &mut OnEvent<'_>) -> Result<(), StudyError> {
    if patches.list.is_empty() {
        let message = message![
            "no component that receives has a surface";
            "see ", setting("[[model]]", "receives", "`receives` under [[model]]")
        ];
        return Err(StudyError::NoPatch(site.by_file.worded(message)));
    }
    if patches.cell > patches.asked_cell {
        let (cell, asked) = (patches.cell, patches.asked_cell);
        let note = message![
            format!("surfaces have texels of {cell:.3} m instead of {asked:?} m, which would be too many");
            "leave components out with ", setting("[[model]]", "receives", "`receives` under [[model]]"), " to have finer ones"
        ];
        tell(on_event, Event::Note(site.by_file.worded(note)))?;
    }
    let left_out = [
        (patches.left_out.doubled_m2, "exist twice and count once"),
        (
            patches.left_out.touching_m2,
            "lie between parts that touch, which the sun cannot reach, and are left out of areas and means",
        ),
    ];
    for (area_m2, why) in left_out.into_iter().filter(|(area_m2, _)| *area_m2 > 0.0) {
        tell(on_event, Event::Note(format!("{area_m2:.0} m² of the surfaces {why}").into()))?;
    }
    let two_sided = || patches.list.iter().filter(|patch| patch.two_sided);
    if two_sided().next().is_some() {
        let count = two_sided().count();
        let note = format!(
            "{count} of {} patches ({:.0} m²) {} no known outer side: the side that faces the sun is judged",
            patches.list.len(),
            two_sided().map(|patch| patch.area_m2).sum::<f64>(),
            if count == 1 { "has" } else { "have" }
        );
        tell(on_event, Event::Note(note.into()))?;
    }
    Ok(())
}

/// Removes the sun from texels below the ground's plane.
fn darken_underground(patches: &Patches, ground: f64, lit: &mut [u32]) {
    for patch in &patches.list {
        let texels = patch.texels.start as usize..patch.texels.end as usize;
        for (lit, texel) in lit[texels.clone()].iter_mut().zip(&patches.texels[texels]) {
            let judged_z = patches.point(patch, *texel).z + patch.normal().z * JUDGED_ABOVE_M;
            if judged_z + patches.origin.z < ground {
                *lit = 0;
            }
        }
    }
}
