//! The intervals in which points lie in the sun, as a drawing and tables.

use super::parts::note_letters;
use super::{DeliverError, Sink, WrittenFiles};
use crate::export::totals::totals as encode_totals;
use crate::export::{figure, probe as encode};
use crate::message::{Message, Words};
use crate::site::ProbeSite;
use crate::study::{self, Event, OnEvent, tell};
use crate::sunlight::Sunlight;
use std::path::PathBuf;

/// What is requested besides the answer itself.
#[derive(Clone, Debug, Default)]
pub struct ProbeRequest {
    /// The name of the drawing: time of day across, days down. `None` for no drawing.
    pub drawing: Option<PathBuf>,
    /// The name of the table with one line per interval. `None` for no table.
    pub table: Option<PathBuf>,
    /// The name of the table of totals by day, month and year. `None` for no table.
    pub totals: Option<PathBuf>,
    /// The face's words, for the fields that the drawing mentions.
    pub words: &'static dyn Words,
}

/// The result of a search.
#[derive(Clone, Debug)]
pub struct ProbeAnswer {
    /// When each point lies in the sun.
    pub sunlight: Sunlight,
    /// Notes on the models and on the search.
    pub notes: Vec<Message>,
    /// The files that were written.
    pub written: WrittenFiles,
}

/// Finds when points lie in the sun.
///
/// # Errors
/// [`DeliverError`]. Files that cannot be written are refused before anything is searched.
pub fn probe(
    probing: &ProbeSite,
    asked: &ProbeRequest,
    sink: Sink<'_>,
    on_event: &mut OnEvent<'_>,
) -> Result<ProbeAnswer, DeliverError> {
    let names: Vec<PathBuf> = [&asked.drawing, &asked.table, &asked.totals].into_iter().flatten().cloned().collect();
    let open = sink.open(&names, None)?;
    if asked.drawing.is_some() {
        let all = probing.probes.iter().chain(probing.laid.iter().filter_map(|sides| sides.first()));
        let probes = all.map(|probe| probe.name.as_str());
        note_letters([probing.place.name.as_str()].into_iter().chain(probes), on_event)?;
    }
    let mut notes = probing.notes.clone();
    let sunlight = study::probe::probe(probing, &mut |event| {
        study::gather(&event, &probing.notes, &mut notes);
        on_event(event)
    })?;
    let mut files = Vec::new();
    if let Some(name) = &asked.table {
        files.push((name.clone(), encode::csv(&sunlight).into_bytes()));
    }
    if let Some(name) = &asked.totals {
        files.push((name.clone(), encode_totals(&sunlight).into_bytes()));
    }
    if let Some(name) = &asked.drawing {
        files.push((name.clone(), figure::strips(&sunlight, &probing.place, &probing.ground, asked.words)?));
    }
    tell(on_event, Event::Stage("picture"))?;
    Ok(ProbeAnswer { written: open.write(files)?, sunlight, notes })
}
