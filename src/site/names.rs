//! Names, of components and of files: é is one character or an e with an accent behind it, and means the same.
//!
//! Names are compared in Unicode's normal form C, in which letters are composed as far as they can be.

use super::file::Names;
use crate::choice::nearest;
use crate::mesh::Component;
use rustc_hash::{FxHashMap, FxHashSet};
use std::borrow::Cow;
use std::path::{Component as Step, Path, PathBuf};
use unicode_normalization::{IsNormalized, UnicodeNormalization, is_nfc_quick};

/// A name in normal form C.
pub(super) fn composed(name: &str) -> Cow<'_, str> {
    if name.is_ascii() || is_nfc_quick(name.chars()) == IsNormalized::Yes {
        Cow::Borrowed(name)
    } else {
        Cow::Owned(name.nfc().collect())
    }
}

/// Where a file lies that a person has named: there, or where the folder holds none of that very name, under the name
/// that means the same.
pub(super) fn on_disk(path: &Path) -> PathBuf {
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

/// The name in a folder that means the same as another; of several the first in the order of their bytes.
fn same_name(folder: &Path, name: &str) -> Option<String> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let entries = folder.read_dir().ok()?.filter_map(Result::ok);
    let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
    names.filter(|other| composed(other) == composed(name)).min()
}

/// Things for a message: the first of them, and how many more there are. `a`, `a and b`, `a, b and 7 more`.
pub(super) fn few(mut items: Vec<String>) -> String {
    const MOST: usize = 5;
    // never one more, where that one fits
    if items.len() > MOST {
        let more = items.len() - (MOST - 1);
        items.truncate(MOST - 1);
        items.push(format!("{more} more"));
    }
    match items.as_slice() {
        [all @ .., last] if !all.is_empty() => format!("{} and {last}", all.join(", ")),
        _ => items.concat(),
    }
}

/// A list of names, once it is known which of them there are.
struct NameList<'a> {
    /// Those that are meant; where there are none, all are.
    wanted: FxHashSet<Cow<'a, str>>,
    /// Those that are not.
    unwanted: FxHashSet<Cow<'a, str>>,
    /// Whether nothing is meant but what is wanted.
    is_closed: bool,
    /// The first that no component has.
    unknown: Option<&'a str>,
}

impl Names {
    /// Per component whether it is meant: all, none, or those of a list. A component has the names of its node, mesh and
    /// material, too.
    ///
    /// A list's names mean what has them; `!glass` leaves out what is named glass, also of what other names mean, and a
    /// list of such names alone means all else. Where something is named `!glass` itself, that is meant. What no component
    /// is named means nothing.
    pub fn chosen(&self, components: &[Component]) -> Vec<bool> {
        let names = match self {
            Names::All(all) => return vec![*all; components.len()],
            Names::Some(names) => names,
        };
        let NameList { wanted, unwanted, is_closed, .. } = list(names, components);
        let has = |of: &Component, names: &FxHashSet<Cow<str>>| {
            !names.is_empty() && all_names(of).any(|name| names.contains(&composed(name)))
        };
        components.iter().map(|of| (!is_closed || has(of, &wanted)) && !has(of, &unwanted)).collect()
    }

    /// The first of the names that no component has, and the nearest that one has.
    pub(super) fn unknown(&self, components: &[Component]) -> Option<(String, String)> {
        let Names::Some(names) = self else { return None };
        let unknown = list(names, components).unknown?;
        let (mark, name) = unknown.strip_prefix('!').map_or(("", unknown), |name| ("!", name));
        let nearest = nearest(name, components.iter().flat_map(all_names)).unwrap_or_default();
        Some((unknown.to_owned(), format!("{mark}{nearest}")))
    }
}

fn list<'a>(names: &'a [String], components: &[Component]) -> NameList<'a> {
    let texts: Vec<Cow<str>> = names.iter().map(|name| composed(name)).collect();
    let negated = |text: &Cow<'a, str>| text.strip_prefix('!').map(|name| Cow::Owned(name.to_owned()));
    // whether there is a component of that name
    let mut there: FxHashMap<Cow<str>, bool> = FxHashMap::default();
    for text in &texts {
        there.extend(negated(text).into_iter().chain([text.clone()]).map(|name| (name, false)));
    }
    for name in components.iter().flat_map(all_names) {
        if let Some(is_there) = there.get_mut(&composed(name)) {
            *is_there = true;
        }
    }
    let is_there = |name: &Cow<str>| there.get(name) == Some(&true);
    let (mut wanted, mut unwanted) = (FxHashSet::default(), FxHashSet::default());
    let (mut is_closed, mut unknown) = (names.is_empty(), None);
    for (name, text) in names.iter().zip(texts) {
        let without = negated(&text);
        if is_there(&text) {
            wanted.insert(text);
            is_closed = true;
        } else if let Some(without) = without.clone().filter(is_there) {
            unwanted.insert(without);
        } else {
            is_closed |= without.is_none();
            unknown = unknown.or(Some(name.as_str()));
        }
    }
    NameList { wanted, unwanted, is_closed, unknown }
}

/// All names by which a component may be meant.
fn all_names(component: &Component) -> impl Iterator<Item = &str> {
    component.aliases.iter().chain([&component.name]).map(String::as_str)
}
