//! One model file as it was read, upright and in metres, to be written as another file.

use super::contents::{ModelContents, ReadContents};
use super::error::SiteError;
use super::overrides::Overrides;
use super::placement::Placement;
use crate::formats::{Coordinates, Model, ModelError, on_disk};
use crate::message::{Message, message};
use glam::DVec3;
use rayon::prelude::*;
use std::path::Path;

/// A model file that was read.
#[derive(Clone, Debug)]
pub struct PlacedModel {
    /// What people call the file.
    pub name: String,
    /// In metres, z up, around the file's own zero, or in the coordinates of its map.
    pub model: Model,
    /// How many metres a unit of the file was taken for.
    pub scale_m: f64,
    /// What the user should know of how it was read, each a sentence without its stop that names it.
    pub notes: Vec<Message>,
    /// What it holds.
    pub contents: ModelContents,
}

/// Farther up than this stands nothing on a map, metres: such coordinates are Earth-centred.
const HIGHEST_M: f64 = 100_000.0;

/// Reads a model file; of what is asked that takes axis, heights, words and the way of reading.
///
/// # Errors
/// What is wrong with the file, and coordinates that are not of a flat map.
pub fn load_model(path: &Path, asked: &Overrides) -> Result<PlacedModel, SiteError> {
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let placement = Placement { up: asked.up, default_height_m: asked.default_height, ..Placement::default() };
    let model = asked.reading.read(&on_disk(path), &placement.read_options())?;
    let scale_m = model.unit_m.unwrap_or(1.0);
    let model = placement.place(model);
    if let Some(what) = not_flat(&model) {
        let fault = message![what; "place it in a site file, which turns it to the place"].into();
        return Err(ModelError { file: path.to_owned(), fault }.into());
    }
    let notes = model.notes.iter().map(|note| note.clone().about(&name)).collect();
    let names: Vec<_> = model.parts.iter().map(|part| (part.name.as_str(), part.aliases.as_slice())).collect();
    let contents = ReadContents::of(&model).told(&name, &names);
    Ok(PlacedModel { contents, name, scale_m, notes, model })
}

/// Why coordinates of a map are no metres east, north and up.
fn not_flat(model: &Model) -> Option<&'static str> {
    if model.coordinates == Coordinates::Local {
        return None;
    }
    let corners = || model.parts.par_iter().flat_map(|part| &part.positions);
    let is_degrees = |at: &DVec3| at.x.abs() <= 360.0 && at.y.abs() <= 90.0;
    if corners().all(is_degrees) {
        return Some("has its coordinates in degrees, which are no metres");
    }
    let is_far_up = |at: &DVec3| at.z.abs() > HIGHEST_M;
    corners().any(is_far_up).then_some("has Earth-centred coordinates, in which no axis is up")
}
