//! What a change of a site does to its sun: as a drawing, a raster and a report.

use super::parts::{DrawnView, figure_context, note, note_letters, report_context};
use super::sink::OpenSink;
use super::{DeliverError, Sink, WrittenFiles};
use crate::export::report::ReportContext;
use crate::export::{comparison, figure, raster};
use crate::profile::Provenance;
use crate::site::Pair;
use crate::study::{self, CompareOutcome, Event, OnEvent, Stopwatch, tell};
use std::path::PathBuf;

const DRAWING: &str = "compare.png";
const RASTER: &str = "shadow-hours-difference.tif";
const REPORT: &str = "compare.json";

/// What came of a comparison.
#[derive(Clone, Debug)]
pub struct ComparisonAnswer {
    /// The files.
    pub written: WrittenFiles,
    /// `compare.json`
    pub report: String,
    /// What drew the state after.
    pub drawn: Provenance,
    /// The areas, in lines for people.
    pub table: String,
}

/// Compares two states of a site. The stopwatch runs since before they were read.
///
/// # Errors
/// [`DeliverError`]; what does not go together, and what cannot be written, before anything is drawn.
pub fn comparison(
    pair: &Pair,
    mut watch: Stopwatch,
    sink: Sink<'_>,
    on_event: &mut OnEvent<'_>,
) -> Result<ComparisonAnswer, DeliverError> {
    let open = sink.open(&names(), None)?;
    watch.lap("load");
    note(open.note(), on_event)?;
    note_letters([&pair.names[0], &pair.names[1], &pair.after.place.name].map(String::as_str), on_event)?;
    let outcome = study::compare(pair, on_event)?;
    watch.lap("shadows");
    write(pair, &outcome, watch, &open, on_event)
}

/// Writes a comparison that was found. The stopwatch runs on from that.
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
    write(pair, outcome, watch, &open, on_event)
}

/// What the files are called.
pub fn names() -> [PathBuf; 3] {
    [DRAWING, RASTER, REPORT].map(PathBuf::from)
}

fn write(
    pair: &Pair,
    outcome: &CompareOutcome,
    mut watch: Stopwatch,
    open: &OpenSink<'_>,
    on_event: &mut OnEvent<'_>,
) -> Result<ComparisonAnswer, DeliverError> {
    let site = &pair.after;
    let scenes = [0, 1].map(|at| {
        let (mesh, surface, drawn) = (&outcome.meshes[at], &outcome.surfaces[at], &outcome.drawn[at]);
        figure_context(site, DrawnView { receivers: site.receivers, surface, mesh, drawn })
    });
    let change = &outcome.comparison;
    let picture = figure::difference(&scenes, &pair.names, change)?;
    watch.lap("picture");
    tell(on_event, Event::Stage("picture"))?;
    let raster = raster::difference_geotiff(change, &site.place)?;
    watch.lap("raster");
    tell(on_event, Event::Stage("raster"))?;
    let drawn = &outcome.drawn[1];
    let (timings, notes) = (&watch.timings(), &pair.notes());
    let told = ReportContext { notes, ..report_context(site, site.receivers, drawn, timings, None) };
    let report = comparison::json(change, &pair.names, &site.place, &site.track, &told)?;
    let [of_drawing, of_raster, of_report] = names();
    let files = vec![(of_drawing, picture), (of_raster, raster), (of_report, report.clone().into_bytes())];
    let written = open.write(files)?;
    Ok(ComparisonAnswer { written, report, drawn: drawn.clone(), table: comparison::table(change, &site.track) })
}
