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
        *names = written(names.take(), &component.name, &wanted, components);
    }
    if *before == BeforeTable::default() {
        site.before = None;
    }
}

/// Names that choose the wanted components: the same with one name more or less if that does, otherwise the name of each.
fn written(names: Option<WrittenNames>, name: &str, wanted: &[bool], components: &[Component]) -> Option<WrittenNames> {
    if !wanted.contains(&true) {
        return None;
    }
    let old = names.map_or(Vec::new(), |names| names.0);
    let with = [old.clone(), vec![name.to_owned()]].concat();
    let without: Vec<String> = old.iter().filter(|other| *other != name).cloned().collect();
    let mut each: Vec<String> = Vec::new();
    for (component, _) in components.iter().zip(wanted).filter(|(_, wanted)| **wanted) {
        if !each.contains(&component.name) {
            each.push(component.name.clone());
        }
    }
    let does =
        |names: &Vec<String>| !names.is_empty() && chosen(Some(&WrittenNames(names.clone())), components) == wanted;
    Some(WrittenNames([old, without, with].into_iter().find(does).unwrap_or(each)))
}

/// For each component, whether names choose it; no names choose none.
fn chosen(names: Option<&WrittenNames>, components: &[Component]) -> Vec<bool> {
    match names {
        Some(names) => Names::Some(names.0.clone()).chosen(components),
        None => vec![false; components.len()],
    }
}
