//! Wrong use of the command, as far as the command line tells it.

/// A mistake on the command line that only the command can see.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub(crate) struct WrongUse(pub(super) String);
