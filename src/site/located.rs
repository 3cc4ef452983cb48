//! A request with a place, which a model's file may propose.

use super::Models;
use super::error::SiteError;
use super::written::WrittenSite;
use crate::message::Message;
use std::borrow::Cow;

/// Models that are read where they are asked for.
pub(super) type LazyModels<'a> = Box<dyn FnOnce() -> Result<Models, SiteError> + 'a>;

impl WrittenSite {
    /// The request with a place: its own, or that which a model's file proposes, for which the models are read first.
    ///
    /// # Errors
    /// Everything that can be wrong with the models, and that nobody says a place.
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

    /// That nobody says a place; and what files say of one that is none.
    fn no_place(&self, said: &[Message]) -> SiteError {
        if self.is_bare_model() {
            let said = said.first().map(|said| Box::new(said.clone().of_bare_model()));
            return SiteError::NoPlaceForModel { path: self.file.clone(), said };
        }
        self.no_point("latitude = 48.8583 and longitude = 2.2945")
    }
}
