//! Data that this program writes because glTF cannot express it: `gnomon` in the `extras` of a node and of a scene.

use crate::formats::{Anchor, AnchorPoint, PartKind, composed};
use serde::{Deserialize, Deserializer};
use serde_json::Value;

/// The most names for each component of a node, which are all copied into it.
const MOST_ALIASES: usize = 64;
const LONGEST: usize = 1000;

/// A component's other names, its kind, and whether its heights are measured from the ground.
#[derive(Debug, Default)]
pub(super) struct OwnExtras {
    pub aliases: Option<Vec<String>>,
    pub kind: PartKind,
    pub is_from_ground: bool,
}

/// A scene's data: where its origin lies, and what was known before it was converted to glTF.
#[derive(Clone, Debug, Default)]
pub(super) struct OwnScene {
    pub anchor: Option<Anchor>,
    /// The length of a unit in metres, if it was given.
    pub unit_m: Option<f64>,
    /// Whether the up axis was given.
    pub up_is_said: bool,
}

/// Reads a node's data, and ignores that of other programs.
pub(super) fn read<'de, D: Deserializer<'de>>(from: D) -> Result<OwnExtras, D::Error> {
    let extras = Value::deserialize(from)?;
    let Some(ours) = extras.get("gnomon") else { return Ok(OwnExtras::default()) };
    let kind = ours.get("kind").and_then(Value::as_str);
    Ok(OwnExtras {
        aliases: ours.get("aliases").and_then(Value::as_array).map(|list| aliases(list)),
        kind: PartKind::ALL.into_iter().find(|known| Some(known.word()) == kind).unwrap_or_default(),
        is_from_ground: ours["from_ground"] == true,
    })
}

fn aliases(list: &[Value]) -> Vec<String> {
    let texts = list.iter().filter_map(Value::as_str).filter(|alias| (1..=LONGEST).contains(&alias.len()));
    texts.take(MOST_ALIASES).map(|alias| composed(alias).into_owned()).collect()
}

/// Reads a scene's data.
pub(super) fn read_scene<'de, D: Deserializer<'de>>(from: D) -> Result<OwnScene, D::Error> {
    let extras = Value::deserialize(from)?;
    let Some(ours) = extras.get("gnomon") else { return Ok(OwnScene::default()) };
    Ok(OwnScene {
        anchor: anchor(ours),
        // glTF has no other unit
        unit_m: ours["unit_m"].as_f64().filter(|unit| *unit == 1.0),
        up_is_said: ours["up"] == "y",
    })
}

/// Where the scene's origin lies. The caller checks whether that place exists.
fn anchor(ours: &Value) -> Option<Anchor> {
    let number = |key: &str| ours.get(key).and_then(Value::as_f64);
    let north_rad = number("north").map(f64::to_radians);
    let at = match number("latitude").zip(number("longitude")) {
        Some((latitude_deg, longitude_deg)) => {
            AnchorPoint::Geographic { latitude_deg, longitude_deg, elevation_m: number("elevation") }
        }
        None if north_rad.is_some() => AnchorPoint::Nowhere,
        None => return None,
    };
    Some(Anchor { said_by: "gnomon", at, north_rad })
}
