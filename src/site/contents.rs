//! The contents of a model file, as `gnomon check` lists them.

use super::file::Names;
use super::names::ComponentNames;
use crate::formats::{LeftOut, Model, PartKind, Up};
use crate::mesh::Component;
use rustc_hash::FxHashMap;
use std::cmp::Reverse;

/// The contents of a model file.
#[derive(Clone, Debug)]
pub struct ModelContents {
    /// The file, as the user named it.
    pub file: String,
    /// The name of its format.
    pub format: &'static str,
    /// The length of a unit in metres, if the file or its format says it.
    pub unit_m: Option<f64>,
    /// Its up axis.
    pub up: Up,
    /// Whether the file or its format says so.
    pub up_is_said: bool,
    /// The names by which `casts` and `receives` may select components: types, storeys, layers, groups, materials and
    /// their own names. The name that selects most comes first.
    pub groups: Vec<NameGroup>,
    /// The number of components of each kind that exists.
    pub kinds: Vec<(PartKind, usize)>,
    /// What the file contains but the model does not.
    pub left_out: Vec<LeftOut>,
}

/// A name, and the number of components that it selects.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NameGroup {
    /// The name, as `casts` takes it.
    pub name: String,
    /// The number of components that it selects, at least 1.
    pub components: usize,
}

/// What is kept of a model besides its parts.
#[derive(Clone, Debug)]
pub(super) struct ReadContents {
    format: &'static str,
    unit_m: Option<f64>,
    up: Up,
    up_is_said: bool,
    kinds: Vec<PartKind>,
    pub(super) left_out: Vec<LeftOut>,
}

impl ReadContents {
    pub(super) fn of(model: &Model) -> ReadContents {
        ReadContents {
            format: model.format,
            unit_m: model.unit_m,
            up: model.up,
            up_is_said: model.up_is_said,
            kinds: model.kinds.clone(),
            left_out: model.left_out.clone(),
        }
    }

    /// For each component, whether it is ground cover.
    pub(super) fn covers(&self, components: usize) -> impl Iterator<Item = bool> {
        (0..components).map(|part| self.kinds.get(part) == Some(&PartKind::GroundCover))
    }

    /// For each component, whether it casts. Ground cover casts only if it is named.
    pub(super) fn casts(&self, names: &Names, components: &[Component]) -> Vec<bool> {
        let is_terrain = components.iter().map(|component| component.is_terrain);
        let chosen = names.chosen(components);
        if self.kinds.is_empty() || names.means_only_named(components) {
            return chosen;
        }
        // a component named as terrain is not ground cover
        let covers = self.covers(components.len()).zip(is_terrain).map(|(covers, is_terrain)| covers && !is_terrain);
        chosen.into_iter().zip(covers).map(|(chosen, covers)| chosen && !covers).collect()
    }

    /// The contents as `gnomon check` lists them.
    pub(super) fn told(&self, file: &str, components: &[ComponentNames<'_>]) -> ModelContents {
        let kind = |part: usize| self.kinds.get(part).copied().unwrap_or_default();
        let count = |of: PartKind| (of, (0..components.len()).filter(|part| kind(*part) == of).count());
        let kinds = PartKind::ALL.map(count).into_iter().filter(|(_, count)| *count > 0).collect();
        let ReadContents { format, unit_m, up, up_is_said, left_out, .. } = self.clone();
        ModelContents {
            file: file.to_owned(),
            format,
            unit_m,
            up,
            up_is_said,
            groups: groups(components),
            kinds,
            left_out,
        }
    }
}

/// All names with the components that they select, most first. Of equal ones, names of groups come before components'
/// own.
fn groups(components: &[ComponentNames<'_>]) -> Vec<NameGroup> {
    let mut counts: FxHashMap<&str, (usize, bool)> = FxHashMap::default();
    for (name, aliases) in components {
        let (count, _) = counts.entry(name).or_insert((0, true));
        *count += 1;
        for (at, alias) in aliases.iter().enumerate() {
            // a component is counted once, even if it has the name twice
            if alias == name || aliases[..at].contains(alias) {
                continue;
            }
            let (count, is_own) = counts.entry(alias).or_default();
            *count += 1;
            *is_own = false;
        }
    }
    let mut groups: Vec<(&str, (usize, bool))> = counts.into_iter().collect();
    groups.sort_by_key(|&(name, (count, is_own))| (Reverse(count), is_own, name));
    groups.into_iter().map(|(name, (components, _))| NameGroup { name: name.to_owned(), components }).collect()
}
