//! The conversion: a model file as it was read, written as glTF.

use super::{DeliverError, Sink, WrittenFiles};
use crate::export::model as encode;
use crate::message::Words;
use crate::site::PlacedModel;
use crate::study::{self, Event, OnEvent, tell};
use std::path::Path;

/// The result of a conversion.
#[derive(Clone, Debug)]
pub struct ConversionAnswer {
    /// The model that was written.
    pub written: WrittenFiles,
    /// The report in JSON.
    pub report: String,
    /// A line on what the model contains.
    pub summary: String,
}

/// Writes a model into a file of that name. The summary is in the words of a face.
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
