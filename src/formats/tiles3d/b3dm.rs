//! A batched 3D model: tables of its features, and a glTF.

use crate::formats::gltf::batch_names;
use crate::message::{Message, message};
use glam::DVec3;
use serde::Deserialize;

/// The first bytes of the file.
pub(super) const MAGIC: &[u8] = b"b3dm";

/// The bytes before the tables: magic, version, length, and the lengths of both tables' JSON and binary.
const HEADER_BYTES: usize = 28;

/// The glTF of a content, the origin of its coordinates, and the names of its features.
pub(super) struct TileGltf<'a> {
    pub gltf: &'a [u8],
    pub center: DVec3,
    pub names: Vec<String>,
}

#[derive(Default, Deserialize)]
#[serde(default)]
struct FeatureTable {
    #[serde(rename = "RTC_CENTER")]
    center: Option<TileCenter>,
}

/// Numbers, or their position in the table's binary.
#[derive(Deserialize)]
#[serde(untagged)]
enum TileCenter {
    Numbers([f64; 3]),
    Binary {
        #[serde(rename = "byteOffset")]
        offset: usize,
    },
}

/// Finds the glTF in a batched 3D model.
pub(super) fn opened(bytes: &[u8]) -> Result<TileGltf<'_>, Message> {
    let cut_off = || message!["is cut off or damaged"; "copy or export it again"];
    let number = |at: usize| {
        let bytes = bytes.get(at..at + 4)?.try_into().ok()?;
        Some(u32::from_le_bytes(bytes) as usize)
    };
    let numbers: Option<Vec<usize>> = (1..7).map(|word| number(4 * word)).collect();
    let Some([version, length, json, binary, batch_json, batch_binary]) = numbers.as_deref() else {
        return Err(cut_off());
    };
    if *version != 1 {
        return Err(message![format!("is a batched 3D model of version {version}, but Gnomon reads 1");
            "export it as 3D Tiles 1.0 or 1.1"]);
    }
    let body = bytes.get(HEADER_BYTES..*length).ok_or_else(cut_off)?;
    let (table, rest) = body.split_at_checked(*json).ok_or_else(cut_off)?;
    let (table_binary, rest) = rest.split_at_checked(*binary).ok_or_else(cut_off)?;
    let (batch, rest) = rest.split_at_checked(*batch_json).ok_or_else(cut_off)?;
    let gltf = rest.get(*batch_binary..).ok_or_else(cut_off)?;
    let center = center(table, table_binary).ok_or_else(cut_off)?;
    Ok(TileGltf { gltf, center, names: batch_names(batch) })
}

/// `RTC_CENTER`; zero if the table has none.
fn center(table: &[u8], binary: &[u8]) -> Option<DVec3> {
    if table.trim_ascii().is_empty() {
        return Some(DVec3::ZERO);
    }
    let table: FeatureTable = serde_json::from_slice(table).ok()?;
    match table.center {
        None => Some(DVec3::ZERO),
        Some(TileCenter::Numbers(numbers)) => Some(DVec3::from(numbers)),
        Some(TileCenter::Binary { offset }) => {
            let bytes = binary.get(offset..)?.get(..12)?;
            let number = |at: usize| Some(f64::from(f32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?)));
            Some(DVec3::new(number(0)?, number(4)?, number(8)?))
        }
    }
}

/// `CESIUM_RTC` of a glTF: a point in the tile's coordinates, which is not turned with the model.
pub(super) fn cesium_center(json: &[u8]) -> DVec3 {
    #[derive(Default, Deserialize)]
    #[serde(default)]
    struct RtcDocument {
        extensions: RtcExtensions,
    }
    #[derive(Default, Deserialize)]
    #[serde(default)]
    struct RtcExtensions {
        #[serde(rename = "CESIUM_RTC")]
        rtc: Option<RtcPoint>,
    }
    #[derive(Deserialize)]
    struct RtcPoint {
        center: [f64; 3],
    }
    let extended = serde_json::from_slice::<RtcDocument>(json).unwrap_or_default();
    extended.extensions.rtc.map_or(DVec3::ZERO, |rtc| DVec3::from(rtc.center))
}
