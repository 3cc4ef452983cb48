//! Files → bytes, with a bound on their size.

use super::ModelFault;
use crate::message::message;
use std::fs::File;
use std::io::Read as _;
use std::path::Path;

/// The largest file that is read whole, bytes.
const MOST: u64 = 4 << 30;

/// All of a regular file of at most 4 GiB.
pub(super) fn of_file(path: &Path) -> Result<Vec<u8>, ModelFault> {
    // Asked before opening: opening a pipe would wait for its writer.
    let metadata = std::fs::metadata(path).map_err(ModelFault::unreadable)?;
    if !metadata.is_file() {
        return Err(message!["is not a file"; "name a model file"].into());
    }
    if metadata.len() > MOST {
        let what = format!("has {} bytes, and a model may have 4 GiB", metadata.len());
        return Err(message![what; "export it in parts or with less detail"].into());
    }
    let mut bytes = Vec::with_capacity(usize::try_from(metadata.len()).unwrap_or(0));
    let file = File::open(path).map_err(ModelFault::unreadable)?;
    file.take(MOST).read_to_end(&mut bytes).map_err(ModelFault::unreadable)?;
    Ok(bytes)
}

/// What people call a file: its name without the ending.
pub(super) fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}
