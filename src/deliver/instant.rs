//! The shadows at one instant: as a drawing, and as a bare mask.

use super::parts::{DrawnView, figure_context, note, note_letters, report_context};
use super::{DeliverError, Sink, WrittenFiles};
use crate::export::figure::{self, Diagram, PictureExtras};
use crate::export::raster;
use crate::export::report::{self, ReportContext};
use crate::profile::{Provenance, Statistics};
use crate::site::Site;
use crate::study::{self, CountingPurpose, Event, InstantOutcome, InstantWants, OnEvent, Stopwatch, tell};
use crate::view::{Surface, View};
use std::path::PathBuf;

/// The request for the first instant of a site's study.
#[derive(Clone, Debug)]
pub struct InstantRequest {
    /// The view from which the shadows are seen.
    pub view: View,
    /// The name of the drawing; `None` for no drawing.
    pub drawing: Option<PathBuf>,
    /// The name of the mask; `None` for no mask.
    pub mask: Option<PathBuf>,
    /// What the drawing shows besides sun and shadow.
    pub show: Show,
    /// Whether statistics of counting shadow volumes are wanted.
    pub statistics: bool,
    /// A stopwatch that has been running since before the site was read.
    pub watch: Stopwatch,
}

/// What a drawing of an instant shows besides sun and shadow, or instead of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Show {
    /// The shadow volumes, on a camera's picture.
    pub volumes: bool,
    /// The silhouette, on a camera's picture.
    pub silhouette: bool,
    /// Components in their own colours.
    pub components: bool,
    /// The work of counting, instead of sun and shadow.
    pub diagram: Option<Diagram>,
}

/// The result of an instant.
#[derive(Clone, Debug)]
pub struct InstantAnswer {
    /// The files that were written.
    pub written: WrittenFiles,
    /// The report in JSON.
    pub report: String,
    /// What drew the shadows.
    pub drawn: Provenance,
    /// The statistics of counting, if they were requested and there is a sun.
    pub statistics: Option<Statistics>,
}

/// Draws the first instant of the site's study.
///
/// # Errors
/// [`DeliverError`]. Contradictory requests, and files that cannot be written, are refused before anything is drawn.
pub fn instant(
    site: &Site,
    asked: &InstantRequest,
    sink: Sink<'_>,
    on_event: &mut OnEvent<'_>,
) -> Result<InstantAnswer, DeliverError> {
    let names: Vec<PathBuf> = [&asked.drawing, &asked.mask].into_iter().flatten().cloned().collect();
    let open = sink.open(&names, None)?;
    note(open.note(), on_event)?;
    let mut watch = asked.watch.clone();
    watch.lap("load");
    if asked.drawing.is_some() {
        let parts = site.mesh.components.iter().filter(|_| asked.show.components).map(|part| part.name.as_str());
        note_letters([site.place.name.as_str()].into_iter().chain(parts), on_event)?;
    }
    let mut notes = site.notes.clone();
    let outcome = study::instant(site, asked.view, &asked.wants(), &mut |event| {
        study::gather(&event, &site.notes, &mut notes);
        on_event(event)
    })?;
    watch.laps(outcome.timings.clone());

    let mut ready = Vec::new();
    if let (Some(name), Some(surface)) = (&asked.drawing, &outcome.surface) {
        let bytes = draw(site, asked, &outcome, surface)?;
        tell(on_event, Event::Stage("picture"))?;
        ready.push(open.ready((name.clone(), bytes))?);
        watch.lap("picture");
    }
    if let Some(name) = &asked.mask {
        ready.push(open.ready((name.clone(), raster::mask_png(&outcome.mask)?))?);
        watch.lap("mask");
    }
    let written = open.put(ready)?;
    let statistics = outcome.counted.as_ref().filter(|_| asked.statistics).map(Statistics::of);
    let receivers = study::judged(site, &asked.view);
    let (timings, counted) = (&watch.timings(), statistics.as_ref());
    let told = ReportContext { notes: &notes, ..report_context(site, receivers, &outcome.drawn, timings, counted) };
    let report = report::shadow_json(&asked.view, &site.place, &site.track, &told)?;
    Ok(InstantAnswer { written, report, drawn: outcome.drawn, statistics })
}

fn draw(
    site: &Site,
    asked: &InstantRequest,
    outcome: &InstantOutcome,
    surface: &Surface,
) -> Result<Vec<u8>, DeliverError> {
    let InstantOutcome { mask, surface_mesh: mesh, drawn, overlay, counted, .. } = outcome;
    let scene = figure_context(site, DrawnView { receivers: study::judged(site, &asked.view), surface, mesh, drawn });
    let casts = seen_casts(site);
    let shown = PictureExtras {
        overlay: overlay.as_ref(),
        casts: asked.show.components.then_some(casts.as_slice()),
        counted: counted.as_ref().zip(asked.show.diagram),
    };
    Ok(figure::instant(&scene, &asked.view, mask, &shown)?)
}

/// For each component of a drawing's mesh, which has only the visible ones, whether it casts.
pub(crate) fn seen_casts(site: &Site) -> Vec<bool> {
    site.casts.iter().zip(&site.receives).filter(|(_, seen)| **seen).map(|(casts, _)| *casts).collect()
}

impl InstantRequest {
    fn wants(&self) -> InstantWants {
        let Show { volumes, silhouette, diagram, .. } = self.show;
        let counted = match diagram {
            Some(Diagram::Mask) => Some(CountingPurpose::Mask),
            Some(Diagram::Overdraw) => Some(CountingPurpose::Overdraw),
            None => self.statistics.then_some(CountingPurpose::Statistics),
        };
        InstantWants { surface: self.drawing.is_some(), volumes, silhouette, counted }
    }
}
