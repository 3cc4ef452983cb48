//! Finds the components that a list of names selects.

use super::file::Names;
use crate::choice::nearest;
use crate::formats::composed;
use crate::mesh::Component;
use rustc_hash::{FxHashMap, FxHashSet};
use std::borrow::Cow;

/// A component's name, and all other names that select it.
pub(super) type ComponentNames<'a> = (&'a str, &'a [String]);

/// The names of components.
pub(super) fn names_of(components: &[Component]) -> Vec<ComponentNames<'_>> {
    components.iter().map(|component| (component.name.as_str(), component.aliases.as_slice())).collect()
}

/// A list of names, with `!` resolved against the names that exist.
struct NameList<'a> {
    /// The names that select; if there are none, everything is selected.
    wanted: FxHashSet<Cow<'a, str>>,
    /// The names that exclude.
    unwanted: FxHashSet<Cow<'a, str>>,
    /// Whether only `wanted` names select.
    is_closed: bool,
    /// The first name that no component has.
    unknown: Option<&'a str>,
}

impl Names {
    /// For each component, whether it is chosen: all, none, or those of a list. A component also has the names of its
    /// groups.
    ///
    /// A name in a list chooses the components that have it. `!glass` leaves out those that are named glass, even if
    /// other names choose them, and a list of such names alone chooses all others. If something is itself named
    /// `!glass`, the name chooses that. A name that no component has chooses nothing.
    pub fn chosen(&self, components: &[Component]) -> Vec<bool> {
        self.chosen_of(&names_of(components))
    }

    /// The same for parts that are not components yet.
    pub(super) fn chosen_of(&self, components: &[ComponentNames<'_>]) -> Vec<bool> {
        let names = match self {
            Names::All(all) => return vec![*all; components.len()],
            Names::Some(names) => names,
        };
        let NameList { wanted, unwanted, is_closed, .. } = list(names, components);
        let has = |of: &ComponentNames, names: &FxHashSet<Cow<str>>| {
            !names.is_empty() && all_names(of).any(|name| names.contains(&composed(name)))
        };
        components.iter().map(|of| (!is_closed || has(of, &wanted)) && !has(of, &unwanted)).collect()
    }

    /// Whether only what the list names is selected.
    pub(super) fn means_only_named(&self, components: &[Component]) -> bool {
        match self {
            Names::All(all) => !all,
            Names::Some(names) => list(names, &names_of(components)).is_closed,
        }
    }

    /// The first name that no component has, and the nearest one that exists.
    pub(super) fn unknown(&self, components: &[ComponentNames<'_>]) -> Option<(String, String)> {
        let Names::Some(names) = self else { return None };
        let unknown = list(names, components).unknown?;
        let (mark, name) = unknown.strip_prefix('!').map_or(("", unknown), |name| ("!", name));
        let nearest = nearest(name, components.iter().flat_map(all_names)).unwrap_or_default();
        Some((unknown.to_owned(), format!("{mark}{nearest}")))
    }
}

fn list<'a>(names: &'a [String], components: &[ComponentNames<'_>]) -> NameList<'a> {
    let texts: Vec<Cow<str>> = names.iter().map(|name| composed(name)).collect();
    let negated = |text: &Cow<'a, str>| text.strip_prefix('!').map(|name| Cow::Owned(name.to_owned()));
    // whether a component of that name exists
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

/// All names that select a component.
fn all_names<'a>((name, aliases): &ComponentNames<'a>) -> impl Iterator<Item = &'a str> {
    aliases.iter().map(String::as_str).chain([*name])
}
