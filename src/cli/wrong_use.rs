//! Wrong use of the command that the command line alone reveals.

/// A mistake on the command line that only the command can see.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub(crate) struct WrongUse(pub(super) String);
