//! Reads only some layers of a model: the parts that have the given names, as if the file contained no others.

use super::error::{FieldLocation, SiteError};
use super::file::Names;
use super::names::ComponentNames;
use super::overrides::refuse;
use crate::formats::{LeftOut, Model, PartKind};
use crate::message::message;

/// Removes all other parts from a model; `at` is where the names were given.
///
/// # Errors
/// A name that no part has, or names that no part remains for.
pub(super) fn keep(model: &mut Model, names: &Names, at: impl Fn() -> FieldLocation) -> Result<(), SiteError> {
    let of_parts: Vec<ComponentNames> =
        model.parts.iter().map(|part| (part.name.as_str(), part.aliases.as_slice())).collect();
    if let Some((name, nearest)) = names.unknown(&of_parts) {
        return Err(SiteError::UnknownName { at: at(), name, nearest });
    }
    let chosen = names.chosen_of(&of_parts);
    let kept = chosen.iter().filter(|chosen| **chosen).count();
    if kept == 0 {
        return Err(refuse(
            at(),
            message!["leaves nothing of the model"; "name what should be read, or leave the key out"],
        ));
    }
    let left_out = (chosen.len() - kept) as u64;
    if left_out == 0 {
        return Ok(());
    }
    let kinds: Vec<PartKind> = (0..chosen.len()).map(|part| model.kind(part)).collect();
    let stays = |of: usize| chosen.get(of).copied().unwrap_or_default();
    // the index of each part among those that remain
    let number = |next: &mut usize, stays: &bool| {
        let number = *next;
        *next += usize::from(*stays);
        Some(number)
    };
    let numbers: Vec<usize> = chosen.iter().scan(0, number).collect();
    model.kinds = kinds.into_iter().enumerate().filter(|(part, _)| stays(*part)).map(|(_, kind)| kind).collect();
    if !model.from_ground.is_empty() {
        let mut of_part = chosen.iter();
        model.from_ground.retain(|_| of_part.next().copied().unwrap_or_default());
        // no remaining part may be measured from the ground
        if !model.from_ground.contains(&true) {
            model.from_ground.clear();
        }
    }
    let mut part = 0;
    model.parts.retain(|_| {
        part += 1;
        stays(part - 1)
    });
    for material in &mut model.see_through {
        material.parts.retain(|part| stays(*part));
        material.parts.iter_mut().for_each(|part| *part = numbers[*part]);
    }
    model.see_through.retain(|material| !material.parts.is_empty());
    let why = "`layers` does not name them".to_owned();
    model.left_out.push(LeftOut { what: "components".to_owned(), count: left_out, why });
    Ok(())
}
