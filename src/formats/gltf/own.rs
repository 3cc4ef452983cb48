//! What this program itself writes about a component, where glTF has no word for it: under `gnomon` in a node's `extras`.

use crate::formats::{PartKind, composed};
use serde::{Deserialize, Deserializer};
use serde_json::Value;

/// Each component of the node has them: so many are taken, and no longer ones.
const MOST_ALIASES: usize = 64;
const LONGEST: usize = 1000;

/// A component's further names, and its kind.
#[derive(Debug, Default)]
pub(super) struct OwnExtras {
    pub aliases: Vec<String>,
    pub kind: PartKind,
}

/// Reads them; what others write there is theirs.
pub(super) fn read<'de, D: Deserializer<'de>>(from: D) -> Result<OwnExtras, D::Error> {
    let extras = Value::deserialize(from)?;
    let Some(ours) = extras.get("gnomon") else { return Ok(OwnExtras::default()) };
    let aliases = ours.get("aliases").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_str);
    let aliases = aliases.filter(|alias| (1..=LONGEST).contains(&alias.len())).take(MOST_ALIASES);
    let kind = ours.get("kind").and_then(Value::as_str);
    Ok(OwnExtras {
        aliases: aliases.map(|alias| composed(alias).into_owned()).collect(),
        kind: PartKind::ALL.into_iter().find(|known| Some(known.word()) == kind).unwrap_or_default(),
    })
}
