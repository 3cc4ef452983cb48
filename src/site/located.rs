//! A request that has a place, perhaps from a model's file.

use super::Models;
use super::error::SiteError;
use super::written::WrittenSite;
use crate::message::Message;
use std::borrow::Cow;

/// Models that are read only when they are needed.
pub(super) type LazyModels<'a> = Box<dyn FnOnce() -> Result<Models, SiteError> + 'a>;

impl WrittenSite {
    /// Returns the request with a place: its own, or the one that a model's file proposes. To find that, the models are
    /// read first.
    ///
    /// # Errors
    /// Anything wrong with the models, or that nothing gives a place.
    pub(super) fn located<'a>(
        &'a self,
        models: impl FnOnce() -> Result<Models, SiteError> + 'a,
    ) -> Result<(Cow<'a, WrittenSite>, LazyModels<'a>), SiteError> {
        if self.point()?.is_some() {
            return Ok((Cow::Borrowed(self), Box::new(models)));
        }
        if self.site.model.is_empty() {
            return Err(self.no_place(&[]));
        }
        let models = models()?;
        let Some(place) = models.proposed_place() else { return Err(self.no_place(models.place_notes())) };
        let mut written = self.clone();
        written.site.place.get_or_insert_default().complete_with(place);
        if written.point()?.is_none() {
            return Err(self.no_place(models.place_notes()));
        }
        Ok((Cow::Owned(written), Box::new(move || Ok(models))))
    }

    /// The error that nothing gives a place. It says what files gave that is not a place.
    fn no_place(&self, said: &[Message]) -> SiteError {
        if self.is_bare_model() {
            let said = said.first().map(|said| Box::new(said.clone().of_bare_model()));
            return SiteError::NoPlaceForModel { path: self.file.clone(), said };
        }
        self.no_point("latitude = 48.8583 and longitude = 2.2945")
    }
}
