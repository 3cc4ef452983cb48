//! The conversion: writes a model file, as it was read, as glTF.

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
    /// A line on the model's contents.
    pub summary: String,
}

/// Writes a model to a file of that name. The summary uses the words of a face.
///
/// # Errors
/// [`DeliverError`]. A file that cannot be written is refused before anything is made.
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
