//! An error and its causes on one line, in the words of a face.

use crate::choice::Misfit;
use crate::deliver::DeliverError;
use crate::deliver::lines::LinesError;
use crate::export::ExportError;
use crate::formats::ModelError;
use crate::gpu::GpuError;
use crate::message::{Worded, Words};
use crate::shadow::ShadowError;
use crate::site::SiteError;
use crate::site::typed::TypedError;
use crate::study::StudyError;
use crate::sun::SunError;
use std::error::Error;

/// Views an error as one that names fields, if it is one.
type AsWorded = for<'a> fn(&'a (dyn Error + 'static)) -> Option<&'a dyn Worded>;

/// Every error type that names fields.
const WORDED: &[AsWorded] = &[
    worded::<Misfit>,
    worded::<SunError>,
    worded::<TypedError>,
    worded::<ModelError>,
    worded::<SiteError>,
    worded::<GpuError>,
    worded::<ShadowError>,
    worded::<StudyError>,
    worded::<ExportError>,
    worded::<DeliverError>,
    worded::<LinesError>,
];

fn worded<'a, E: Worded + Error + 'static>(error: &'a (dyn Error + 'static)) -> Option<&'a dyn Worded> {
    error.downcast_ref::<E>().map(|error| error as &dyn Worded)
}

/// An error and its causes on one line. A cause that the message already contains is not repeated.
pub fn line(error: &(dyn Error + 'static), words: &dyn Words) -> String {
    let mut line = String::new();
    let mut next = Some(error);
    while let Some(error) = next {
        let cause = said(error, words);
        next = error.source();
        if line.is_empty() {
            line = cause;
        } else if !line.contains(&cause) {
            line = format!("{line}: {cause}");
        }
    }
    line
}

/// An error without its causes and without line breaks.
fn said(error: &(dyn Error + 'static), words: &dyn Words) -> String {
    let worded = WORDED.iter().find_map(|as_worded| as_worded(error));
    let text = worded.map_or_else(|| error.to_string(), |error| error.in_words(words));
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
