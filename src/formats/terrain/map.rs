//! The map of a terrain, and the units of its heights and its plan.

use crate::crs::{Crs, CrsKind};
use crate::formats::ReadOptions;
use crate::message::{Message, message};

/// The ratio by which two units must differ to be distinct; it separates the metre and the two feet.
const ONE_UNIT: f64 = 1e-3;
const FOOT_M: f64 = 0.3048;

/// What is known about a terrain's map.
pub(super) struct TerrainMap {
    /// The reference system as the file gives it.
    pub crs: Option<String>,
    /// The length of the file's unit of height, metres.
    pub height_unit_m: f64,
    /// The length of the model's unit, metres: with a map that of heights, otherwise that of all three coordinates, if
    /// known.
    pub unit_m: Option<f64>,
    /// The unit of eastings and northings, for a message.
    pub plan_unit: &'static str,
}

impl TerrainMap {
    /// Heights are in the unit that the file gives, otherwise in the reference system's unit for heights, otherwise in
    /// that of eastings and northings, with a note. `plan_unit_m` is the file's unit for the latter besides its
    /// reference system.
    pub(super) fn of(
        crs: Option<String>,
        said_m: Option<f64>,
        plan_unit_m: Option<f64>,
        notes: &mut Vec<Message>,
    ) -> TerrainMap {
        let known = crs.as_deref().and_then(|text| Crs::read(text).ok());
        let of_system = known.as_ref().and_then(Crs::height_unit_m);
        let is_in_degrees = known.as_ref().is_some_and(|crs| crs.kind() == CrsKind::Geographic);
        let plan_m = known.filter(|crs| crs.kind() == CrsKind::Projected).map(|crs| crs.unit_m()).or(plan_unit_m);
        let height_unit_m = said_m.or(of_system).unwrap_or_else(|| {
            notes.push(unsaid(crs.is_some(), plan_m));
            plan_m.unwrap_or(1.0)
        });
        let unit_m = if crs.is_some() { Some(height_unit_m) } else { plan_unit_m };
        let plan_unit = match plan_m {
            _ if is_in_degrees => "degrees",
            Some(plan_m) if is_near(plan_m, 1.0) => "m",
            Some(plan_m) if is_near(plan_m, FOOT_M) => "ft",
            None if crs.is_none() => "units",
            _ => "units of its map",
        };
        TerrainMap { crs, height_unit_m, unit_m, plan_unit }
    }

    /// How far a thinned sheet may lie from its heights while these are metres by the file's own unit: `scale` makes them
    /// longer or shorter afterwards.
    pub(super) fn error_m(&self, options: &ReadOptions) -> f64 {
        options.terrain_error_m / options.scale.map_or(1.0, |scale| scale * self.of_a_metre())
    }

    /// The model's units in a metre of height.
    pub(super) fn of_a_metre(&self) -> f64 {
        1.0 / self.unit_m.unwrap_or(1.0)
    }
}

fn is_near(plan_m: f64, unit_m: f64) -> bool {
    (plan_m / unit_m - 1.0).abs() < ONE_UNIT
}

/// A note that the unit of heights is an assumption.
fn unsaid(is_of_map: bool, plan_m: Option<f64>) -> Message {
    let taken = match plan_m {
        Some(plan_m) if is_near(plan_m, FOOT_M) => "feet, as its coordinates are".to_owned(),
        Some(plan_m) if !is_near(plan_m, 1.0) => format!("units of {plan_m} m, as its coordinates are"),
        None if !is_of_map => "metres, or as being in the unit of the map that `crs` names".to_owned(),
        _ => "metres".to_owned(),
    };
    message![format!("does not say the unit of its heights; they are taken as {taken}")]
}
