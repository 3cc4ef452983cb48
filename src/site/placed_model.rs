//! A model file, read, upright and in metres, ready to be written as another file.

use super::anchored_zero::true_north;
use super::contents::{ModelContents, ReadContents};
use super::error::SiteError;
use super::georeference::{Georeference, Reference, StandFault};
use super::metres;
use super::overrides::Overrides;
use super::place_doubts::degrees;
use super::placement::Placement;
use super::stand::{ProposedPoint, SiteFrame, proposal, stand};
use crate::crs::{GeodeticPoint, LocalFrame};
use crate::formats::{Anchor, AnchorPoint, Coordinates, Model, ModelError, Up, on_disk};
use crate::message::{Message, message};
use std::path::Path;

/// A model file that was read.
#[derive(Clone, Debug)]
pub struct PlacedModel {
    /// The file's name in messages.
    pub name: String,
    /// The model in metres, z up, around the file's own origin; around the place in its middle if it is in map
    /// coordinates.
    pub model: Model,
    /// Where that origin lies on Earth, and where true north is, as far as they are known.
    pub zero: Option<Anchor>,
    /// The length of the file's unit that was used, metres.
    pub scale_m: f64,
    /// Whether the file, its format or its map gives that unit.
    pub unit_is_said: bool,
    /// Whether the file, its format, its map or the user gives the up axis.
    pub up_is_said: bool,
    /// Notes on how it was read, each a sentence without a full stop that names the file.
    pub notes: Vec<Message>,
    /// Its contents.
    pub contents: ModelContents,
}

/// Reads a model file. Of `asked` only the axis, heights, words and the way of reading are used.
///
/// # Errors
/// Anything wrong with the file, or coordinates in an unknown map.
pub fn load_model(path: &Path, asked: &Overrides) -> Result<PlacedModel, SiteError> {
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let placement = Placement { up: asked.up, default_height_m: asked.default_height, ..Placement::default() };
    let mut model = asked.reading.read(&on_disk(path), &placement.read_options())?;
    if matches!(model.coordinates, Coordinates::Map(_)) {
        // a map's third coordinate is the height, whatever the format's axes are
        (model.up, model.up_is_said) = (Up::Z, true);
    }
    let refused = |fault: StandFault| {
        let mut fault = fault.into_message();
        // there is no key that could be written here
        fault.hint = message![""; "export the file in another map, for example EPSG:25832"].hint;
        SiteError::from(ModelError { file: path.to_owned(), fault: fault.into() })
    };
    let said = Georeference::of(&model, &placement).map_err(refused)?;
    let is_of_map = matches!(said.reference, Reference::Map { .. });
    let (scale_m, unit_is_said) = (model.unit_m.unwrap_or(1.0), model.unit_m.is_some() || is_of_map);
    let up_is_said = asked.up.is_some() || model.up_is_said;
    let mut notes = [model.notes.as_slice(), said.notes.as_slice()].concat();
    let (model, zero) = match &said.reference {
        Reference::Map { .. } => {
            let (model, zero, note) = around_its_middle(model, &placement, said).map_err(refused)?;
            notes.push(note);
            (model, Some(zero))
        }
        reference => {
            let zero = zero(reference);
            (placement.place(model), zero)
        }
    };
    let notes = notes.into_iter().map(|note| note.of_bare_model().about(&name)).collect();
    let names: Vec<_> = model.parts.iter().map(|part| (part.name.as_str(), part.aliases.as_slice())).collect();
    let contents = ReadContents::of(&model).told(&name, &names);
    Ok(PlacedModel { contents, name, zero, scale_m, unit_is_said, up_is_said, notes, model })
}

/// Converts a model in a map corner by corner to the frame of the place that it proposes. Returns that place, too.
fn around_its_middle(
    model: Model,
    placement: &Placement,
    said: Georeference,
) -> Result<(Model, Anchor, Message), StandFault> {
    let around = |ProposedPoint { at, has_elevation }| {
        let at = GeodeticPoint { height_m: if has_elevation { at.height_m } else { 0.0 }, ..at };
        Some((at, SiteFrame { local: LocalFrame::around(at)?, has_elevation, is_of: None }))
    };
    let (at, frame) = proposal(&model, &said)
        .and_then(around)
        .ok_or_else(|| StandFault::File(message!["has coordinates where its map does not reach"]))?;
    let mut model = stand(model, placement, said, Some(&frame))?.model;
    // the anchors are about the file's own origin
    model.anchors.clear();
    model.coordinates = Coordinates::Local;
    // heights from the ground say nothing about the place's elevation
    let elevation_m = (!model.stands_on_ground()).then_some(at.height_m);
    let height = elevation_m.map(|height| format!(", {} above the sea", metres(height))).unwrap_or_default();
    let note = message![format!(
        "was in map coordinates, and is written in metres east, north and up of {}{height}, with true north",
        degrees(at)
    )];
    let point = AnchorPoint::Geographic { latitude_deg: at.latitude_deg, longitude_deg: at.longitude_deg, elevation_m };
    Ok((model, Anchor { said_by: "gnomon", at: point, north_rad: Some(0.0) }, note))
}

/// Where the file's own origin lies, by the anchor that is used.
fn zero(reference: &Reference) -> Option<Anchor> {
    let Reference::Anchor(zero) = reference else { return None };
    let north_rad = true_north(zero);
    let at = zero.at.map(|at| AnchorPoint::Geographic {
        latitude_deg: at.latitude_deg,
        longitude_deg: at.longitude_deg,
        elevation_m: zero.has_height.then_some(at.height_m),
    });
    (at.is_some() || north_rad.is_some()).then(|| Anchor {
        said_by: "gnomon",
        at: at.unwrap_or(AnchorPoint::Nowhere),
        north_rad,
    })
}
