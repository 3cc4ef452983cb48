//! The verification: compares every technique with ray casting on a site, as a table and in JSON.

use super::DeliverError;
use crate::export::verify as encode;
use crate::site::Site;
use crate::study::{self, OnEvent};

/// The result of a verification. It has no files.
#[derive(Clone, Debug)]
pub struct VerificationAnswer {
    /// A table with one line per technique, for people.
    pub table: String,
    /// The report in JSON.
    pub report: String,
    /// The techniques that break their promise, if there are any.
    pub failure: Option<String>,
}

/// Compares every technique with ray casting, at the site's instants.
///
/// # Errors
/// [`DeliverError`]. A machine without a graphics adapter, or a study without a sun, is refused before anything is
/// drawn.
pub fn verification(site: &Site, on_event: &mut OnEvent<'_>) -> Result<VerificationAnswer, DeliverError> {
    let mut notes = site.notes.clone();
    let found = study::verify::verify(site, &mut |event| {
        study::gather(&event, &site.notes, &mut notes);
        on_event(event)
    })?;
    Ok(VerificationAnswer {
        table: encode::table(&found, site),
        report: encode::json(&found, site, &notes)?,
        failure: encode::failure(&found),
    })
}
