//! Existing files in output folders: the user's are never lost, and those of another study are never mistaken for one's
//! own.

mod inputs;
mod lock;
#[cfg(unix)]
mod stopped;

use std::path::Path;

/// A whole file, which must be there.
fn bytes(path: &Path) -> Vec<u8> {
    std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}
