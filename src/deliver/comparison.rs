//! The comparison: how a change of a site affects its sun, as a drawing, a raster and a report.

use super::parts::{DrawnView, figure_context, note, note_letters, report_context};
use super::profile::{ProfileRequest, StudyStore, find_kept};
use super::shelf::{self, Beside};
use super::sink::OpenSink;
use super::{DeliverError, Folder, Sink, WrittenFiles};
use crate::export::report::ReportContext;
use crate::export::{comparison, figure, raster};
use crate::profile::Provenance;
use crate::site::{Pair, Site};
use crate::study::{self, CompareOutcome, Event, OnEvent, Outcome, Stopwatch, StudyError, tell};
use std::path::{Path, PathBuf};

const DRAWING: &str = "compare.png";
const RASTER: &str = "shadow-hours-difference.tif";
const REPORT: &str = "compare.json";

/// The result of a comparison.
#[derive(Clone, Debug)]
pub struct ComparisonAnswer {
    /// The files that were written.
    pub written: WrittenFiles,
    /// `compare.json`
    pub report: String,
    /// What drew the state after.
    pub drawn: Provenance,
    /// The areas, in lines for people.
    pub table: String,
}

/// Compares two states of a site. The stopwatch must have been running since before they were read.
///
/// # Errors
/// [`DeliverError`]. Contradictory requests, and files that cannot be written, are refused before anything is drawn.
pub fn comparison(
    pair: &Pair,
    mut watch: Stopwatch,
    sink: Sink<'_>,
    on_event: &mut OnEvent<'_>,
) -> Result<ComparisonAnswer, DeliverError> {
    let open = sink.open(&names(), None)?;
    watch.lap("load");
    note(open.note(), on_event)?;
    note_drawn_letters(pair, on_event)?;
    let (outcome, stores) = find(pair, None, sink.folder(), false, on_event)?;
    watch.lap("shadows");
    let kept = || stores.iter().find_map(StudyStore::kept);
    let has_folder = sink.folder().is_some();
    let mut stage =
        |stage| tell(on_event, Event::Stage(stage)).inspect_err(|_| shelf::note_end(has_folder.then(kept), on_event));
    let answer = write(pair, &outcome, watch, &open, &mut stage)?;
    stores.iter().try_for_each(StudyStore::finish)?;
    Ok(answer)
}

/// Computes a comparison to be shown; the state before may already be known. If a study of one state is stopped, it is
/// kept in `shelf` (which keeps the newest ones), and continues when the same request is made again. Nothing is kept
/// while another study works there.
///
/// # Errors
/// As [`comparison()`].
pub fn find_comparison(
    pair: &Pair,
    before: Option<&Outcome>,
    shelf: Option<Folder<'_>>,
    on_event: &mut OnEvent<'_>,
) -> Result<CompareOutcome, DeliverError> {
    shelf::find(shelf, on_event, |folder, on_event| {
        let (outcome, stores) = find(pair, before.cloned(), folder, true, on_event)?;
        for store in stores {
            // what cannot be removed now will be removed when newer studies are kept
            let _ = store.finish();
        }
        Ok(outcome)
    })
}

/// Computes the comparison, and continues the stopped study of either state in the folder. If it `is_shown`, the folder
/// is a shelf, and the files have the states' names.
fn find<'a>(
    pair: &Pair,
    before: Option<Outcome>,
    folder: Option<&'a Path>,
    is_shown: bool,
    on_event: &mut OnEvent<'_>,
) -> Result<(CompareOutcome, Vec<StudyStore<'a>>), DeliverError> {
    study::not_patches(&pair.before)?;
    study::not_patches(&pair.after)?;
    let asked = ProfileRequest::of(Stopwatch::start());
    let mut stores: Vec<StudyStore<'a>> = Vec::new();
    let mut outcome = |when: &str, site: &Site, name: &str, beside: Beside<'_>| {
        note((!is_shown).then(|| format!("{when}: {name}")), on_event)?;
        let beside = if is_shown { Beside::Shelf } else { beside };
        let (hours, store) = find_kept(site, &asked, folder, beside, on_event)?;
        Ok::<_, DeliverError>((hours.into_outcome()?, store))
    };
    let before = match before {
        Some(before) => before,
        None => {
            // the study of the state after is only known when its machine is chosen
            let (before, store) = outcome("before", &pair.before, &pair.names[0], Beside::Unknown)?;
            stores.push(store);
            before
        }
    };
    let numbers: Vec<u64> = stores.iter().map(StudyStore::number).collect();
    let (after, store) = outcome("after", &pair.after, &pair.names[1], Beside::Studies(&numbers))?;
    stores.push(store);
    Ok((CompareOutcome::new(pair, before, after), stores))
}

/// Writes a comparison. The stopwatch continues from there.
///
/// # Errors
/// As [`comparison()`].
pub fn write_comparison(
    pair: &Pair,
    outcome: &CompareOutcome,
    watch: Stopwatch,
    sink: Sink<'_>,
    on_event: &mut OnEvent<'_>,
) -> Result<ComparisonAnswer, DeliverError> {
    let open = sink.open(&names(), None)?;
    note(open.note(), on_event)?;
    note_drawn_letters(pair, on_event)?;
    write(pair, outcome, watch, &open, &mut |stage| tell(on_event, Event::Stage(stage)))
}

/// Notes the letters in the drawing that no font has.
fn note_drawn_letters(pair: &Pair, on_event: &mut OnEvent<'_>) -> Result<(), StudyError> {
    note_letters([&pair.names[0], &pair.names[1], &pair.after.place.name].map(String::as_str), on_event)
}

/// The names of the files.
pub fn names() -> [PathBuf; 3] {
    [DRAWING, RASTER, REPORT].map(PathBuf::from)
}

fn write(
    pair: &Pair,
    outcome: &CompareOutcome,
    mut watch: Stopwatch,
    open: &OpenSink<'_>,
    stage: &mut dyn FnMut(&'static str) -> Result<(), StudyError>,
) -> Result<ComparisonAnswer, DeliverError> {
    let site = &pair.after;
    let scenes = [0, 1].map(|at| {
        let (mesh, surface, drawn) = (&outcome.meshes[at], &outcome.surfaces[at], &outcome.drawn[at]);
        figure_context(site, DrawnView { receivers: site.receivers, surface, mesh, drawn })
    });
    let change = &outcome.comparison;
    let picture = figure::difference(&scenes, &pair.names, change)?;
    watch.lap("picture");
    stage("picture")?;
    let raster = raster::difference_geotiff(change, &site.place)?;
    watch.lap("raster");
    stage("raster")?;
    let drawn = &outcome.drawn[1];
    let (timings, mut notes) = (&watch.timings(), pair.notes());
    // a note may be known from one state and new for the other
    let new = outcome.notes.iter().filter(|note| !notes.contains(note)).cloned().collect::<Vec<_>>();
    notes.extend(new);
    let notes = &notes;
    let told = ReportContext { notes, ..report_context(site, site.receivers, drawn, timings, None) };
    let report = comparison::json(change, &pair.names, &site.place, &site.track, &told)?;
    let [of_drawing, of_raster, of_report] = names();
    let files = vec![(of_drawing, picture), (of_raster, raster), (of_report, report.clone().into_bytes())];
    let written = open.write(files)?;
    Ok(ComparisonAnswer { written, report, drawn: drawn.clone(), table: comparison::table(change, &site.track) })
}
