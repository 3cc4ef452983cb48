//! Notes on a model's keys: those that its format does not use, and those that override what its file says.

use super::file::ModelTable;
use super::placement::Placement;
use crate::formats::{Model, Up, keys_of};
use crate::message::{Message, message};

/// Units whose ratio differs from 1 by less than this are the same.
const ONE_UNIT: f64 = 1e-6;

/// Returns the notes on the keys of one of the models. Their subject is the model.
pub(super) fn of(tables: &[ModelTable], index: usize, placement: &Placement, model: &Model) -> Vec<Message> {
    let unused = tables.get(index).map(|table| unused(table, tables, model)).unwrap_or_default();
    unused.into_iter().chain(of_unit(placement, model)).chain(of_axis(placement, model)).collect()
}

fn unused(table: &ModelTable, tables: &[ModelTable], model: &Model) -> Vec<Message> {
    let Some(used) = keys_of(model.format) else { return Vec::new() };
    // a height that the command line sets for all of several models is meant for those that have footprints
    let is_for_all = tables.len() > 1 && tables.iter().all(|other| other.default_height == table.default_height);
    let written = [
        ("scene", table.scene.is_some()),
        ("terrain_error", table.terrain_error.is_some()),
        ("classes", table.classes.is_some()),
        ("default_height", table.default_height.is_some() && !is_for_all),
    ];
    let is_unused = |(key, is_written): &(&str, bool)| *is_written && !used.contains(key);
    let note = |(key, _)| message![format!("has no use for `{key}`, as it is {}", model.format); "leave it out"];
    written.into_iter().filter(is_unused).map(note).collect()
}

fn of_unit(placement: &Placement, model: &Model) -> Option<Message> {
    let (scale, unit_m) = placement.scale.zip(model.unit_m)?;
    let differs = (scale / unit_m - 1.0).abs() > ONE_UNIT;
    differs.then(|| message![format!("has a unit of {scale} m by `scale`, and of {unit_m} m by its file")])
}

fn of_axis(placement: &Placement, model: &Model) -> Option<Message> {
    let up = placement.up.filter(|up| model.up_is_said && *up != model.up)?;
    let word = |up: Up| up.word();
    Some(message![format!("has {} up by `up`, and {} by its file", word(up), word(model.up))])
}
