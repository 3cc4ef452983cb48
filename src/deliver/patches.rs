//! The hours of sun on the models' surfaces, as a drawing, a model, a table and a report.

use super::parts::{DrawnView, figure_context, note, note_letters, report_context};
use super::shelf::{self, Beside, PatchStore};
use super::sink::OpenSink;
use super::{DeliverError, Folder, NamedFile, Sink, WrittenFiles};
use crate::choice::Receivers;
use crate::export::figure;
use crate::export::patches::{self, PatchContext};
use crate::export::report::{self, ReportContext};
use crate::profile::Provenance;
use crate::site::Site;
use crate::study::{self, Event, OnEvent, PatchOutcome, Stopwatch, StudyError, tell};
use std::path::{Path, PathBuf};

const DRAWING: &str = "surfaces.png";
const MODEL: &str = "surfaces.glb";
const TABLE: &str = "surfaces.csv";
const REPORT: &str = "profile.json";

/// The request for a study on patches.
#[derive(Clone, Debug)]
pub struct PatchesRequest {
    /// `surfaces.png`
    pub drawing: bool,
    /// `surfaces.glb`
    pub model: bool,
    /// `surfaces.csv`
    pub table: bool,
    /// `profile.json`
    pub report: bool,
    /// A stopwatch that has been running since before the site was read.
    pub watch: Stopwatch,
}

/// The result of a study on patches.
#[derive(Clone, Debug)]
pub struct PatchesAnswer {
    /// The files that were written.
    pub written: WrittenFiles,
    /// The contents of `profile.json`, whether it was written or not.
    pub report: String,
    /// What drew the answer.
    pub drawn: Provenance,
    /// The hours of each component, in lines for people.
    pub summary: String,
}

/// Computes the hours of sun on the patches of a site, and writes the requested files.
///
/// # Errors
/// [`DeliverError`]. Contradictory requests, and files that cannot be written, are refused before anything is drawn.
pub fn patches(
    site: &Site,
    asked: &PatchesRequest,
    sink: Sink<'_>,
    on_event: &mut OnEvent<'_>,
) -> Result<PatchesAnswer, DeliverError> {
    let open = sink.open(&asked.names(), None)?;
    let mut watch = asked.watch.clone();
    watch.lap("load");
    note(open.note(), on_event)?;
    note_letters(asked.drawing.then_some(site.place.name.as_str()), on_event)?;
    let (outcome, store) = find(site, sink.folder(), Beside::Studies(&[]), on_event)?;
    watch.laps(outcome.timings.clone());
    let asked = PatchesRequest { watch, ..asked.clone() };
    let mut stage =
        |stage| tell(on_event, Event::Stage(stage)).inspect_err(|_| shelf::note_end(store.kept(), on_event));
    let answer = write(site, &outcome, &asked, &open, &mut stage)?;
    store.finish()?;
    Ok(answer)
}

/// Computes the hours of sun on the site's patches to be shown. If a study is stopped, it is kept in `shelf` (which
/// keeps the newest ones), and continues when the same request is made again. Nothing is kept while another study works
/// there.
///
/// # Errors
/// As [`patches()`].
pub fn find_patches(
    site: &Site,
    shelf: Option<Folder<'_>>,
    on_event: &mut OnEvent<'_>,
) -> Result<PatchOutcome, DeliverError> {
    shelf::find(shelf, on_event, |folder, on_event| {
        let (outcome, store) = find(site, folder, Beside::Shelf, on_event)?;
        // what cannot be removed now will be removed when newer studies are kept
        let _ = store.finish();
        Ok(outcome)
    })
}

/// Computes the hours, and continues the folder's stopped study if it is the same.
fn find<'a>(
    site: &Site,
    folder: Option<&'a Path>,
    beside: Beside<'a>,
    on_event: &mut OnEvent<'_>,
) -> Result<(PatchOutcome, PatchStore<'a>), DeliverError> {
    let mut store = PatchStore::new(folder, beside);
    let found =
        study::patches_kept(site, site.patch_cell, store.keep_every(), &mut |event| store.hear(event, on_event));
    let found = store.take_fault().map_or(found.map_err(DeliverError::from), Err);
    let outcome = found.inspect_err(|_| shelf::note_kept(store.kept().flatten(), on_event))?;
    Ok((outcome, store))
}

/// Writes the requested files of computed hours. The request's stopwatch continues from [`PatchOutcome::timings`].
///
/// # Errors
/// As [`patches()`].
pub fn write_patches(
    site: &Site,
    outcome: &PatchOutcome,
    asked: &PatchesRequest,
    sink: Sink<'_>,
    on_event: &mut OnEvent<'_>,
) -> Result<PatchesAnswer, DeliverError> {
    let open = sink.open(&asked.names(), None)?;
    note(open.note(), on_event)?;
    note_letters(asked.drawing.then_some(site.place.name.as_str()), on_event)?;
    write(site, outcome, asked, &open, &mut |stage| tell(on_event, Event::Stage(stage)))
}

/// The hours of a site's patches in the form that drawings and tables use.
pub fn answer<'a>(site: &'a Site, outcome: &'a PatchOutcome) -> PatchContext<'a> {
    let Site { place, track, mesh, receives, .. } = site;
    PatchContext { place, track, mesh, receives, patches: &outcome.patches, hours: &outcome.hours }
}

fn write(
    site: &Site,
    outcome: &PatchOutcome,
    asked: &PatchesRequest,
    open: &OpenSink<'_>,
    stage: &mut dyn FnMut(&'static str) -> Result<(), StudyError>,
) -> Result<PatchesAnswer, DeliverError> {
    let mut watch = asked.watch.clone();
    let (drawn, receivers) = (&outcome.drawn, Receivers::Patches);
    let answer = answer(site, outcome);
    let mut files: Vec<NamedFile> = Vec::new();
    let mut stage = |watch: &mut Stopwatch, name| {
        watch.lap(name);
        stage(name)
    };
    if asked.drawing {
        let (mesh, surface) = &study::seen_receivers(site)?;
        let scene = figure_context(site, DrawnView { receivers, surface, mesh, drawn });
        files.push((DRAWING.into(), figure::patches(&scene, &site.picture(), &answer)?));
        stage(&mut watch, "picture")?;
    }
    if asked.model {
        files.push((MODEL.into(), patches::glb(&answer)?));
        stage(&mut watch, "model")?;
    }
    if asked.table {
        files.push((TABLE.into(), patches::csv(&answer).into_bytes()));
    }
    let (timings, notes) = (&watch.timings(), &[&site.notes[..], &outcome.notes].concat());
    let told = ReportContext { notes, ..report_context(site, receivers, drawn, timings, None) };
    let report = report::patches_json(&answer, &told)?;
    if asked.report {
        files.push((REPORT.into(), report.clone().into_bytes()));
    }
    let written = open.write(files)?;
    Ok(PatchesAnswer { written, report, drawn: drawn.clone(), summary: patches::summary(&answer) })
}

impl PatchesRequest {
    /// A request for all files.
    pub fn all(watch: Stopwatch) -> PatchesRequest {
        PatchesRequest { drawing: true, model: true, table: true, report: true, watch }
    }

    /// The names of its files.
    pub fn names(&self) -> Vec<PathBuf> {
        let kinds = [(self.drawing, DRAWING), (self.model, MODEL), (self.table, TABLE), (self.report, REPORT)];
        kinds.into_iter().filter(|(asked, _)| *asked).map(|(_, name)| PathBuf::from(name)).collect()
    }
}
