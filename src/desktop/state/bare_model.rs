//! One or several models without a site file; the window asks for their place.

use crate::desktop::state::words::PanelWords;
use crate::message::{Field, Worded};
use crate::site::typed::{self, TypedError};
use crate::site::{FieldLocation, SiteError};
use std::ops::RangeInclusive;
use std::path::PathBuf;

/// Degrees by which a model may be turned.
pub(in crate::desktop) const NORTH: RangeInclusive<f64> = -360.0..=360.0;

/// A model that says not where it stands.
#[derive(Clone, Debug)]
pub(in crate::desktop) struct BareModel {
    /// The model's file.
    pub(in crate::desktop) path: PathBuf,
    /// Further models, which stand in the same site.
    pub(in crate::desktop) beside: Vec<PathBuf>,
    /// What was answered so far, as typed.
    pub(in crate::desktop) place: String,
    /// Degrees clockwise from the model's north to true north, as typed.
    pub(in crate::desktop) north: String,
    /// Why what was typed for each of the two is not taken.
    pub(in crate::desktop) faults: [Option<String>; 2],
}

impl BareModel {
    /// Nothing is answered yet.
    pub(in crate::desktop) fn new(paths: Vec<PathBuf>) -> BareModel {
        let mut paths = paths.into_iter();
        let path = paths.next().unwrap_or_default();
        BareModel { path, beside: paths.collect(), place: String::new(), north: "0".to_owned(), faults: [None, None] }
    }

    /// Latitude and longitude, degrees.
    ///
    /// # Errors
    /// What is no place.
    pub(in crate::desktop) fn place(&self) -> Result<[f64; 2], SiteError> {
        typed::place(&self.place).map_err(|error| SiteError::typed(FieldLocation::Field(Field::Place), error))
    }

    /// Degrees clockwise from the model's north to true north.
    ///
    /// # Errors
    /// What is no number, or not within a turn.
    pub(in crate::desktop) fn north(&self) -> Result<f64, TypedError> {
        match self.north.trim() {
            "" => Ok(0.0),
            text => typed::within(text.trim_end_matches('°'), NORTH, "degrees"),
        }
    }

    /// Whether all that was typed can be read; what cannot be is told beside its field.
    pub(in crate::desktop) fn is_read(&mut self) -> bool {
        let words = |error: TypedError| error.in_words(&PanelWords);
        self.faults = [typed::place(&self.place).err().map(words), self.north().err().map(words)];
        self.faults.iter().all(Option::is_none)
    }
}
