//! Reads the keys of a GeoTIFF or LAS file: the map of the coordinates, and the unit of the heights.
//!
//! OGC GeoTIFF 1.1 (19-008r4): the directory has four 16-bit numbers for each key: the key, the tag with its value, the
//! count, and the value or its index in that tag.

use crate::crs::vertical_unit_m;

/// The keys for position and height.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct MapKeys {
    /// The reference system, as `EPSG:25832`, or the name of one that has no number.
    pub crs: Option<String>,
    /// The length of a unit of height in metres, if the keys say it.
    pub height_unit_m: Option<f64>,
    /// The length of a unit of the map in metres, if the keys say it.
    pub map_unit_m: Option<f64>,
    /// Whether a sample is the height at a point, and not of a cell around it.
    pub is_point: bool,
}

/// The numbers of keys.
const MODEL_TYPE: u16 = 1024;
const RASTER_TYPE: u16 = 1025;
const CITATION: u16 = 1026;
const GEOGRAPHIC: u16 = 2048;
const PROJECTED: u16 = 3072;
const PROJECTED_CITATION: u16 = 3073;
const PROJECTED_UNIT: u16 = 3076;
const VERTICAL: u16 = 4096;
const VERTICAL_UNIT: u16 = 4099;
/// The tag with the texts.
const TEXTS: u16 = 34737;
/// The value for something that the file itself defines.
const USER_DEFINED: u16 = 32767;

impl MapKeys {
    /// Reads a directory with its texts.
    pub(super) fn of(directory: &[u16], texts: &str) -> MapKeys {
        let count = directory.get(3).copied().unwrap_or(0).into();
        let keys: Vec<[u16; 4]> =
            directory.get(4..).unwrap_or_default().as_chunks::<4>().0.iter().copied().take(count).collect();
        let short = |number: u16| keys.iter().find(|key| key[0] == number && key[1] == 0).map(|key| key[3]);
        let code = |number: u16| short(number).filter(|&code| code != 0 && code != USER_DEFINED);
        let text = |number: u16| {
            let [_, _, length, start] = *keys.iter().find(|key| key[0] == number && key[1] == TEXTS)?;
            let text = texts.get(usize::from(start)..usize::from(start) + usize::from(length))?;
            Some(text.trim_end_matches(['|', '\0']).trim().to_owned()).filter(|text| !text.is_empty())
        };
        let horizontal = match short(MODEL_TYPE) {
            Some(2) => code(GEOGRAPHIC),
            _ => code(PROJECTED).or_else(|| code(GEOGRAPHIC).filter(|_| short(PROJECTED).is_none())),
        };
        MapKeys {
            crs: horizontal
                .map(|code| format!("EPSG:{code}"))
                .or_else(|| text(PROJECTED_CITATION))
                .or_else(|| text(CITATION).filter(|_| short(MODEL_TYPE) == Some(1))),
            height_unit_m: short(VERTICAL_UNIT).and_then(unit_m).or_else(|| vertical_unit_m(code(VERTICAL)?.into())),
            map_unit_m: short(PROJECTED_UNIT).and_then(unit_m),
            is_point: short(RASTER_TYPE) == Some(2),
        }
    }
}

/// The metres of one of EPSG's units.
fn unit_m(code: u16) -> Option<f64> {
    match code {
        9001 => Some(1.0),
        9002 => Some(0.3048),
        9003 => Some(1200.0 / 3937.0),
        _ => None,
    }
}
