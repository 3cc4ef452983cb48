//! Reads a file's bytes at once, and files beside it.

use super::{ModelFault, on_disk};
use crate::message::message;
use std::fs::File;
use std::io::Read as _;
use std::path::{Component as Step, Path, PathBuf};

/// The largest file that is read at once.
const MOST_BYTES: u64 = 4 << 30;

/// All bytes of a file.
pub(super) fn whole_file(path: &Path) -> Result<Vec<u8>, ModelFault> {
    // asked before opening: opening a pipe would wait for its writer
    let metadata = std::fs::metadata(path).map_err(ModelFault::unreadable)?;
    if !metadata.is_file() {
        return Err(message!["is not a file"; "name a model file"].into());
    }
    if metadata.len() > MOST_BYTES {
        let what = format!("has {} bytes, and a file may have 4 GiB", metadata.len());
        return Err(message![what; "export it in parts"].into());
    }
    let mut bytes = Vec::with_capacity(usize::try_from(metadata.len()).unwrap_or(0));
    let file = File::open(path).map_err(ModelFault::unreadable)?;
    file.take(MOST_BYTES).read_to_end(&mut bytes).map_err(ModelFault::unreadable)?;
    Ok(bytes)
}

/// A text's bytes without the mark that some editors begin it with.
pub(super) fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes)
}

/// The file beside another whose name ends otherwise, in small or in capital letters.
pub(super) fn sibling(path: &Path, ending: &str) -> Option<PathBuf> {
    let mut each = [ending.to_lowercase(), ending.to_uppercase()].into_iter().map(|ending| path.with_extension(ending));
    each.find(|path| path.is_file())
}

/// Where a file lies that another names, if that is in the other's folder or below it.
pub(super) fn below(folder: &Path, named: &str) -> Option<PathBuf> {
    let named = Path::new(named);
    let stays = named.components().all(|step| matches!(step, Step::Normal(_) | Step::CurDir));
    let has_scheme = named.to_str().is_none_or(|named| named.contains("://") || named.starts_with("data:"));
    (stays && !has_scheme && !named.as_os_str().is_empty()).then(|| on_disk(&folder.join(named)))
}
