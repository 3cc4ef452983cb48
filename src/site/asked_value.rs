//! A value of the study that is asked: set by a face, or a text of the site file.

use super::error::{FieldLocation, SiteError};
use super::typed::TypedError;
use super::written::WrittenSite;
use crate::message::Field;

/// A value of the study, and where it is asked. The file's text is read only when the value is needed, so that what
/// nobody uses is no mistake.
#[derive(Clone, Debug)]
pub(super) enum AskedValue<'a, T> {
    /// Set by a face.
    Set(T, Field),
    /// As the site file has it.
    Text(&'a str, FieldLocation),
}

impl<'a, T: Clone> AskedValue<'a, T> {
    /// What a face sets, or else what stands under the key in `[study]`.
    pub(super) fn of(
        written: &WrittenSite,
        (field, set): (Field, Option<T>),
        (key, text): (&str, Option<&'a str>),
    ) -> Option<Self> {
        let in_file = || Some(AskedValue::Text(text?, written.key("study", key)));
        set.map(|value| AskedValue::Set(value, field)).or_else(in_file)
    }

    /// Where it is asked.
    pub(super) fn at(&self) -> FieldLocation {
        match self {
            AskedValue::Set(_, field) => FieldLocation::Field(*field),
            AskedValue::Text(_, at) => at.clone(),
        }
    }

    /// The value.
    ///
    /// # Errors
    /// What the file's text says that is none.
    pub(super) fn read<E: Into<TypedError>>(&self, reader: impl Fn(&str) -> Result<T, E>) -> Result<T, SiteError> {
        match self {
            AskedValue::Set(value, _) => Ok(value.clone()),
            AskedValue::Text(text, at) => reader(text).map_err(|error| SiteError::typed(at.clone(), error)),
        }
    }
}
