//! What all deliverables share: the contexts of drawings and reports, and notes.

use crate::choice::Receivers;
use crate::export::figure;
use crate::export::report::ReportContext;
use crate::mesh::Mesh;
use crate::message::Message;
use crate::profile::{Provenance, Statistics, Timings};
use crate::site::Site;
use crate::study::{Event, OnEvent, StudyError, tell};

/// A drawn view of a site.
#[derive(Clone, Copy)]
pub struct DrawnView<'a, S> {
    /// What was judged.
    pub receivers: Receivers,
    /// What each cell sees.
    pub surface: &'a S,
    /// The mesh that its face indices refer to.
    pub mesh: &'a Mesh,
    /// What drew the answer.
    pub drawn: &'a Provenance,
}

/// The context of a drawing of a site.
pub fn figure_context<'a, S>(site: &'a Site, seen: DrawnView<'a, S>) -> figure::FigureContext<'a, S> {
    let DrawnView { receivers, surface, mesh, drawn } = seen;
    figure::FigureContext {
        place: &site.place,
        track: &site.track,
        mesh,
        surface,
        receivers,
        ground: site.ground,
        drawn,
    }
}

/// The context of a report of a site.
pub(super) fn report_context<'a>(
    site: &'a Site,
    receivers: Receivers,
    drawn: &'a Provenance,
    timings: &'a Timings,
    statistics: Option<&'a Statistics>,
) -> ReportContext<'a> {
    ReportContext { receivers, ground: site.ground, drawn, timings, statistics, notes: &site.notes, words: site.words }
}

/// Notes characters in drawn texts that no font has.
pub(super) fn note_letters<'a>(
    texts: impl IntoIterator<Item = &'a str>,
    on_event: &mut OnEvent<'_>,
) -> Result<(), StudyError> {
    let missing = texts.into_iter().map(|text| (text, figure::without_face(text)));
    match missing.into_iter().find(|(_, letters)| !letters.is_empty()) {
        Some((text, letters)) => note(
            Some(format!(
                "no font has the letters {letters} of \"{text}\", so boxes are drawn instead; install a font that has them, or \
                 use other letters"
            )),
            on_event,
        ),
        None => Ok(()),
    }
}

/// Reports a note if there is one.
pub(super) fn note(note: Option<impl Into<Message>>, on_event: &mut OnEvent<'_>) -> Result<(), StudyError> {
    note.map_or(Ok(()), |note| tell(on_event, Event::Note(note.into())))
}
