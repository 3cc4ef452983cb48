//! Wrong use that only the command can detect.

/// A mistake on the command line that only the command can detect.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub(crate) struct WrongUse(pub(super) String);
