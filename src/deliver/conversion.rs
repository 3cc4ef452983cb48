//! The conversion: a model file as it was read, written as glTF.

use super::{DeliverError, Sink, WrittenFiles};
use crate::export::model as encode;
use crate::message::Words;
use crate::site::PlacedModel;
use crate::study::{self, Event, OnEvent, tell};
use std::path::Path;

/// What came of it.
#[derive(Clone, Debug)]
pub struct ConversionAnswer {
    /// The model.
    pub written: WrittenFiles,
    /// All in JSON.
    pub report: String,
    /// What is in it, in a line.
    pub summary: String,
}

/// Writes a model into a file of that name; the summary is in the words of a face.
///
/// # Errors
/// [`DeliverError`]; what cannot be written, before anything is made.
pub fn convert(
    placed: &PlacedModel,
    name: &Path,
    words: &dyn Words,
    sink: Sink<'_>,
    on_event: &mut OnEvent<'_>,
) -> Result<ConversionAnswer, DeliverError> {
    let open = sink.open(&[name.to_owned()], None)?;
    study::note_models(&placed.notes, on_event)?;
    let bytes = encode::glb(placed)?;
    tell(on_event, Event::Stage("model"))?;
    let written = open.write(vec![(name.to_owned(), bytes)])?;
    Ok(ConversionAnswer { written, report: encode::json(placed, name)?, summary: encode::summary(placed, words) })
}
