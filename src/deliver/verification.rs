//! The verification: every technique against ray casting on a site, as a table and in JSON.

use super::DeliverError;
use crate::export::verify as encode;
use crate::site::Site;
use crate::study::{self, OnEvent};

/// What came of a verification. It has no files.
#[derive(Clone, Debug)]
pub struct VerificationAnswer {
    /// A line a technique, for people.
    pub table: String,
    /// All in JSON.
    pub report: String,
    /// Which technique does not keep its promise, where one does not.
    pub failure: Option<String>,
}

/// Holds every technique against ray casting, at the site's instants.
///
/// # Errors
/// [`DeliverError`]; where there is no graphics adapter, or no sun, before anything is drawn.
pub fn verification(site: &Site, on_event: &mut OnEvent<'_>) -> Result<VerificationAnswer, DeliverError> {
    let found = study::verify::verify(site, on_event)?;
    Ok(VerificationAnswer {
        table: encode::table(&found, site),
        report: encode::json(&found, site)?,
        failure: encode::failure(&found),
    })
}
