//! Names of components and of files. An é may be one character, or an e followed by an accent; both mean the same.
//!
//! Names are compared in Unicode's normalization form C (NFC), in which letters are composed as far as they can be.

use std::borrow::Cow;
use std::path::{Component as Step, Path, PathBuf};
use unicode_normalization::{IsNormalized, UnicodeNormalization, is_nfc_quick};

/// A name in normal form C.
pub(crate) fn composed(name: &str) -> Cow<'_, str> {
    if name.is_ascii() || is_nfc_quick(name.chars()) == IsNormalized::Yes {
        Cow::Borrowed(name)
    } else {
        Cow::Owned(name.nfc().collect())
    }
}

/// The path of a file that a person named: as written, or, if the folder does not have exactly that name, under an
/// equivalent spelling.
pub(crate) fn on_disk(path: &Path) -> PathBuf {
    if path.to_str().is_none_or(str::is_ascii) || path.exists() {
        return path.to_owned();
    }
    let mut found = PathBuf::new();
    for step in path.components() {
        let exact = found.join(step);
        found = match step {
            Step::Normal(name) if !exact.exists() => match name.to_str().and_then(|name| same_name(&found, name)) {
                Some(same) => found.join(same),
                None => return path.to_owned(),
            },
            _ => exact,
        };
    }
    found
}

/// An equivalent name in a folder; of several the first in byte order.
fn same_name(folder: &Path, name: &str) -> Option<String> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let entries = folder.read_dir().ok()?.filter_map(Result::ok);
    let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
    names.filter(|other| composed(other) == composed(name)).min()
}
