//! What windows of components are called where nobody names them.

use crate::mesh::Component;
use rustc_hash::FxHashMap;

/// For each chosen component the name that tells it best from the other chosen ones, empty for the others: of its names
/// the one that the fewest of them share, and behind it, where several share that, the name that divides these best, such
/// as their storey. A component's own name goes before a group's that tells no more.
pub(super) fn telling_names(components: &[Component], chosen: &[bool]) -> Vec<String> {
    // its own name is first, so that it is taken among equals
    let names = |at: usize| {
        let component = &components[at];
        std::iter::once(&component.name).chain(&component.aliases).map(String::as_str)
    };
    let mut shared: FxHashMap<&str, Vec<usize>> = FxHashMap::default();
    for at in (0..components.len()).filter(|at| chosen[*at]) {
        names(at).for_each(|name| shared.entry(name).or_default().push(at));
    }
    let mut told = vec![String::new(); components.len()];
    for at in (0..components.len()).filter(|at| chosen[*at]) {
        let first = names(at).min_by_key(|name| shared[name].len()).unwrap_or_default();
        let alike = shared.get(first).map_or(&[][..], Vec::as_slice);
        let also = |name: &str| alike.iter().filter(|other| names(**other).any(|its| its == name)).count();
        // no second name is looked for among a crowd, which it would hardly divide
        let second = (2..=MOST_ALIKE).contains(&alike.len()).then(|| names(at).min_by_key(|name| also(name)));
        told[at] = match second.flatten().filter(|second| also(second) < alike.len()) {
            Some(second) => format!("{first}, {second}"),
            None => first.to_owned(),
        };
    }
    told
}

/// The most components of one name among which a second name is looked for.
const MOST_ALIKE: usize = 100;
