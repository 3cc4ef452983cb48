//! Which components stand before, after, or in both states, as `[before]` says it.

use crate::mesh::Component;
use crate::site::file::{Names, SiteFile};
use crate::site::judged_tables::{BeforeTable, WrittenNames};

/// In which states a component stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::desktop) enum ComponentState {
    /// Before and after.
    Existing,
    /// Not before.
    Proposed,
    /// Before alone.
    Demolished,
}

impl ComponentState {
    /// All of them, with their names and what they mean.
    pub(in crate::desktop) const ALL: [(ComponentState, &'static str, &'static str); 3] = [
        (ComponentState::Existing, "Existing", "It stands before and after"),
        (ComponentState::Proposed, "Proposed", "It does not stand before"),
        (ComponentState::Demolished, "Demolished", "It stands before alone, and is in no picture and no study"),
    ];

    /// Its mark behind a name; none for what simply stands.
    pub(in crate::desktop) fn mark(self) -> &'static str {
        match self {
            ComponentState::Existing => "",
            ComponentState::Proposed => " (proposed)",
            ComponentState::Demolished => " (demolished)",
        }
    }
}

/// The state of each component, by a site file.
pub(in crate::desktop) fn states(site: &SiteFile, components: &[Component]) -> Vec<ComponentState> {
    let before = site.before.as_ref();
    let absent = chosen(before.and_then(|before| before.absent.as_ref()), components);
    let demolished = chosen(before.and_then(|before| before.demolished.as_ref()), components);
    let state = |(absent, demolished)| match (absent, demolished) {
        (_, true) => ComponentState::Demolished,
        (true, false) => ComponentState::Proposed,
        (false, false) => ComponentState::Existing,
    };
    absent.into_iter().zip(demolished).map(state).collect()
}

/// Sets the state of a component, and of those that share its name. What another file says of the state before is left
/// as it is.
pub(in crate::desktop) fn set(site: &mut SiteFile, components: &[Component], (index, state): (usize, ComponentState)) {
    let Some(component) = components.get(index) else { return };
    let before = site.before.get_or_insert_default();
    if before.site.is_some() {
        return;
    }
    let BeforeTable { absent, demolished, .. } = before;
    for (names, of) in [(absent, ComponentState::Proposed), (demolished, ComponentState::Demolished)] {
        let mut wanted = chosen(names.as_ref(), components);
        let of_name = components.iter().zip(&mut wanted).filter(|(other, _)| other.name == component.name);
        of_name.for_each(|(_, wanted)| *wanted = state == of);
        let old = names.take().map_or(Vec::new(), |names| names.0);
        let with = [old.clone(), vec![component.name.clone()]].concat();
        let without = old.iter().filter(|name| **name != component.name).cloned().collect();
        *names = naming(&wanted, components, [old, without, with]);
    }
    if *before == BeforeTable::default() {
        site.before = None;
    }
}

/// Names that choose the wanted components and no others: the first of some lists that does, otherwise the name of each.
pub(in crate::desktop) fn naming(
    wanted: &[bool],
    components: &[Component],
    tried: impl IntoIterator<Item = Vec<String>>,
) -> Option<WrittenNames> {
    if !wanted.contains(&true) {
        return None;
    }
    let mut each: Vec<String> = Vec::new();
    for (component, _) in components.iter().zip(wanted).filter(|(_, wanted)| **wanted) {
        if !each.contains(&component.name) {
            each.push(component.name.clone());
        }
    }
    let does = |names: &WrittenNames| !names.0.is_empty() && chosen(Some(names), components) == wanted;
    let found = tried.into_iter().map(WrittenNames).find(does);
    Some(found.unwrap_or(WrittenNames(each)))
}

/// For each component, whether names choose it; no names choose none.
pub(in crate::desktop) fn chosen(names: Option<&WrittenNames>, components: &[Component]) -> Vec<bool> {
    match names {
        Some(names) => Names::Some(names.0.clone()).chosen(components),
        None => vec![false; components.len()],
    }
}
