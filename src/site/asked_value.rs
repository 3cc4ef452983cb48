//! A value of the study that a face sets or the site file gives.

use super::error::{FieldLocation, SiteError};
use super::typed::TypedError;
use super::written::WrittenSite;
use crate::message::Field;

/// A value of the study, and where it was given. The site file's text is read only when the value is needed, so that a
/// value that nothing uses cannot be an error.
#[derive(Clone, Debug)]
pub(super) enum AskedValue<'a, T> {
    /// Set by a face.
    Set(T, Field),
    /// The site file's text.
    Text(&'a str, FieldLocation),
}

impl<'a, T: Clone> AskedValue<'a, T> {
    /// The value that a face sets, otherwise the one under the key in `[study]`.
    pub(super) fn of(
        written: &WrittenSite,
        (field, set): (Field, Option<T>),
        (key, text): (&str, Option<&'a str>),
    ) -> Option<Self> {
        let in_file = || Some(AskedValue::Text(text?, written.key("study", key)));
        set.map(|value| AskedValue::Set(value, field)).or_else(in_file)
    }

    /// Where the value was given.
    pub(super) fn at(&self) -> FieldLocation {
        match self {
            AskedValue::Set(_, field) => FieldLocation::Field(*field),
            AskedValue::Text(_, at) => at.clone(),
        }
    }

    /// Reads the value.
    ///
    /// # Errors
    /// A text that is not such a value.
    pub(super) fn read<E: Into<TypedError>>(&self, reader: impl Fn(&str) -> Result<T, E>) -> Result<T, SiteError> {
        match self {
            AskedValue::Set(value, _) => Ok(value.clone()),
            AskedValue::Text(text, at) => reader(text).map_err(|error| SiteError::typed(at.clone(), error)),
        }
    }
}
