//! Wrong use of the command that can be seen from the command line alone.

/// A mistake on the command line that only the command can see.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub(crate) struct WrongUse(pub(super) String);
