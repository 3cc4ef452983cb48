//! What lies in the folders that are written to: nothing of the user's is lost there, and nothing of another study's is
//! taken for one's own.

mod inputs;
mod lock;
#[cfg(unix)]
mod stopped;

use std::path::Path;

/// A whole file, which must be there.
fn bytes(path: &Path) -> Vec<u8> {
    std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}
