//! Models without a site file. The window asks for their place.

use crate::desktop::state::words::PanelWords;
use crate::message::{Field, Worded};
use crate::site::typed::{self, TypedError};
use crate::site::{FieldLocation, SiteError};
use std::ops::RangeInclusive;
use std::path::PathBuf;

/// The angles by which a model may be turned, degrees.
pub(in crate::desktop) const NORTH: RangeInclusive<f64> = -360.0..=360.0;

/// Models without a place.
#[derive(Clone, Debug)]
pub(in crate::desktop) struct BareModel {
    /// The model's file.
    pub(in crate::desktop) path: PathBuf,
    /// Further models of the same site.
    pub(in crate::desktop) beside: Vec<PathBuf>,
    /// The typed place.
    pub(in crate::desktop) place: String,
    /// The typed angle: degrees clockwise from the model's north to true north.
    pub(in crate::desktop) north: String,
    /// Why each of the two texts is refused.
    pub(in crate::desktop) faults: [Option<String>; 2],
}

impl BareModel {
    /// No text is typed yet.
    pub(in crate::desktop) fn new(paths: Vec<PathBuf>) -> BareModel {
        let mut paths = paths.into_iter();
        let path = paths.next().unwrap_or_default();
        BareModel { path, beside: paths.collect(), place: String::new(), north: "0".to_owned(), faults: [None, None] }
    }

    /// Latitude and longitude, degrees.
    ///
    /// # Errors
    /// Text that is not a place.
    pub(in crate::desktop) fn place(&self) -> Result<[f64; 2], SiteError> {
        typed::place(&self.place).map_err(|error| SiteError::typed(FieldLocation::Field(Field::Place), error))
    }

    /// Degrees clockwise from the model's north to true north.
    ///
    /// # Errors
    /// Text that is not a number, or a number beyond a full turn.
    pub(in crate::desktop) fn north(&self) -> Result<f64, TypedError> {
        match self.north.trim() {
            "" => Ok(0.0),
            text => typed::within(text.trim_end_matches('°'), NORTH, "degrees"),
        }
    }

    /// Whether both texts can be read. Errors are shown beside the fields.
    pub(in crate::desktop) fn is_read(&mut self) -> bool {
        let words = |error: TypedError| error.in_words(&PanelWords);
        self.faults = [typed::place(&self.place).err().map(words), self.north().err().map(words)];
        self.faults.iter().all(Option::is_none)
    }
}
