//! Reads whole files, and the files beside them.

use super::{ModelFault, on_disk};
use crate::message::message;
use std::fs::File;
use std::io::Read as _;
use std::path::{Component as Step, Path, PathBuf};

/// The largest file that is read.
pub(super) const MOST_BYTES: u64 = 4 << 30;

/// All bytes of a file.
pub(super) fn whole_file(path: &Path) -> Result<Vec<u8>, ModelFault> {
    // checked before opening: opening a pipe would wait for its writer
    let metadata = std::fs::metadata(path).map_err(ModelFault::unreadable)?;
    if !metadata.is_file() {
        return Err(message!["is not a file"; "name a model file"].into());
    }
    if metadata.len() > MOST_BYTES {
        let what = format!("has {} bytes, but a file may have at most 4 GiB", metadata.len());
        return Err(message![what; "export it in parts"].into());
    }
    let mut bytes = Vec::with_capacity(usize::try_from(metadata.len()).unwrap_or(0));
    let file = File::open(path).map_err(ModelFault::unreadable)?;
    file.take(MOST_BYTES).read_to_end(&mut bytes).map_err(ModelFault::unreadable)?;
    Ok(bytes)
}

/// Whether a link leads from a folder to a file outside of it. A model must not make the program read files that its
/// user does not mean to share.
pub(super) fn leads_out(folder: &Path, path: &Path) -> bool {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    match (folder.canonicalize(), path.canonicalize()) {
        (Ok(folder), Ok(file)) => !file.starts_with(folder),
        // a missing file is reported when it is read
        _ => false,
    }
}

/// All bytes of a file that another one refers to. It must lie in that folder or below it, also after following links.
pub(super) fn whole_named_file(folder: &Path, path: &Path) -> Result<Vec<u8>, ModelFault> {
    if leads_out(folder, path) {
        return Err(message!["is a link that leads out of the model's folder"; "copy the file itself there"].into());
    }
    whole_file(path)
}

/// All bytes of the file beside a model with a different ending, if there is one.
pub(super) fn sidecar(model: &Path, ending: &str) -> Result<Option<Vec<u8>>, ModelFault> {
    let Some(path) = sibling(model, ending) else { return Ok(None) };
    let bytes = whole_named_file(model.parent().unwrap_or(Path::new("")), &path);
    bytes.map(Some).map_err(|fault| message![format!("has a .{ending} beside it that {fault}")].into())
}

/// Text without a byte-order mark.
pub(super) fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes)
}

/// The file beside another with a different ending, in lower or upper case.
pub(super) fn sibling(path: &Path, ending: &str) -> Option<PathBuf> {
    let mut each = [ending.to_lowercase(), ending.to_uppercase()].into_iter().map(|ending| path.with_extension(ending));
    each.find(|path| path.is_file())
}

/// The path of a file that another one refers to, if it is in the other's folder or below it.
pub(super) fn below(folder: &Path, named: &str) -> Option<PathBuf> {
    let named = Path::new(named);
    let stays = named.components().all(|step| matches!(step, Step::Normal(_) | Step::CurDir));
    let has_scheme = named.to_str().is_none_or(|named| named.contains("://") || named.starts_with("data:"));
    (stays && !has_scheme && !named.as_os_str().is_empty()).then(|| on_disk(&folder.join(named)))
}
