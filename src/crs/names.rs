//! The names of reference systems: codes of the EPSG dataset in all spellings, and the dataset's names.

use super::definition::{Definition, shortened, unknown};
use super::heights::vertical_unit_m;
use crate::message::Message;
use rustc_hash::FxHashMap;
use std::sync::LazyLock;

/// Codes of other authorities for systems of the EPSG dataset.
const OTHERS: &[(u32, u16)] = &[(900_913, 3857), (102_100, 3857), (102_113, 3857), (102_067, 5514)];

/// Names that the dataset does not have, in normalised form.
const ALIASES: &[(&str, u16)] = &[
    // several systems have these names; in files they mean longitudes and latitudes
    ("wgs84", 4326),
    ("etrs89", 4258),
    ("nad83", 4269),
    ("webmercator", 3857),
    ("pseudomercator", 3857),
    ("wgs84webmercatorauxiliarysphere", 3857),
    ("osgb36britishnationalgrid", 27700),
    ("osgb1936britishnationalgrid", 27700),
    ("ch1903lv95", 2056),
    ("ch1903lv03", 21781),
    ("sjtskkrovakeastnorth", 5514),
];

/// The dataset's names in normalised form, whole and after their last slash, with their codes; `None` for names of
/// several systems.
static NAMES: LazyLock<FxHashMap<String, Option<u16>>> = LazyLock::new(|| {
    let mut names: FxHashMap<String, Option<u16>> = FxHashMap::default();
    let mut add = |name: &str, code: u16, proj: &str| {
        let known = names.entry(compared(name)).or_insert(Some(code));
        let is_same = known.and_then(crs_definitions::from_code).is_some_and(|other| other.proj4 == proj);
        if !is_same {
            *known = None;
        }
    };
    for definition in (0..=u16::MAX).filter_map(crs_definitions::from_code) {
        let name = title(definition.wkt);
        add(name, definition.code, definition.proj4);
        if let Some((_, behind)) = name.rsplit_once('/') {
            add(behind, definition.code, definition.proj4);
        }
    }
    names
});

/// Finds the system that a text other than WKT names.
///
/// # Errors
/// A text that is not a name, or an unknown system.
pub(super) fn definition(text: &str) -> Result<Definition, Message> {
    let lower = text.to_lowercase();
    let codes = codes(&lower);
    if let Some(&code) = codes.first() {
        let found = by_code(code).ok_or_else(|| unknown(&format!("EPSG:{code}")))?;
        // a second code of a horizontal system has no unit of heights
        let second = codes.get(1).filter(|&&code| by_code(code).is_none());
        let height_unit_m = second.and_then(|code| vertical_unit_m(*code));
        return Ok(Definition { height_unit_m, ..found });
    }
    if lower.contains("crs84") || lower == "crs:84" {
        return by_code(4326)
            .map(|found| Definition { name: "OGC:CRS84".to_owned(), ..found })
            .ok_or_else(|| unknown(text));
    }
    if lower.contains("+proj=") {
        return Ok(Definition { name: shortened(text), proj: text.to_owned(), height_unit_m: None, doubt: None });
    }
    by_name(text).ok_or_else(|| unknown(text))
}

/// A system by a name of its own.
pub(super) fn by_name(text: &str) -> Option<Definition> {
    let name = compared(text);
    let alias = || ALIASES.iter().find(|(alias, _)| *alias == name).map(|(_, code)| *code);
    let code = NAMES.get(&name).copied().flatten().or_else(alias).or_else(|| of_surveys(&name))?;
    by_code(code.into())
}

/// Names of the German surveying offices: `urn:adv:crs:ETRS89_UTM32*DE_DHHN2016_NH`, `DE_DHDN_3GK3`.
fn of_surveys(name: &str) -> Option<u16> {
    let zone = |mark: &str, digits: usize| {
        let (_, behind) = name.split_once(mark)?;
        behind.get(..digits)?.parse::<u16>().ok()
    };
    zone("etrs89utm", 2).filter(|zone| (28..=38).contains(zone)).map(|zone| 25800 + zone).or_else(|| {
        let zone = zone("dedhdn3gk", 1).filter(|zone| (2..=5).contains(zone))?;
        Some(31464 + zone)
    })
}

/// A system by its code.
pub(super) fn by_code(code: u32) -> Option<Definition> {
    let others = OTHERS.iter().find(|(other, _)| *other == code).map(|(_, code)| *code);
    let code = others.or_else(|| code.try_into().ok())?;
    let found = crs_definitions::from_code(code)?;
    Some(Definition {
        name: format!("EPSG:{code} ({})", title(found.wkt)),
        proj: found.proj4.to_owned(),
        height_unit_m: None,
        doubt: None,
    })
}

/// The codes after `EPSG` or `ESRI` in lower-case text, or a number alone: first the horizontal system, then the
/// vertical one.
fn codes(lower: &str) -> Vec<u32> {
    if !lower.is_empty() && lower.bytes().all(|byte| byte.is_ascii_digit()) {
        return lower.parse().into_iter().collect();
    }
    let marked = ["epsg", "esri"].into_iter().flat_map(|mark| lower.match_indices(mark));
    let mut found: Vec<(usize, Vec<u32>)> =
        marked.map(|(at, mark)| (at, codes_behind(&lower[at + mark.len()..]))).collect();
    found.sort_by_key(|(at, _)| *at);
    found.into_iter().flat_map(|(_, codes)| codes).collect()
}

/// The code after a prefix, and a second one after a plus: `:25832`, `::25832`, `/0/7415`, `:6.12:25832`, `.xml#4326`,
/// `:25832+7837`.
fn codes_behind(behind: &str) -> Vec<u32> {
    let behind = behind.strip_prefix(".xml").unwrap_or(behind);
    let is_part = |letter: char| letter.is_ascii_digit() || ":/#._-+".contains(letter);
    let end = behind.find(|letter| !is_part(letter)).unwrap_or(behind.len());
    let code = |part: &str| {
        let digits = part.rsplit(|letter: char| !letter.is_ascii_digit()).find(|digits| !digits.is_empty())?;
        digits.parse().ok()
    };
    behind[..end].split('+').filter_map(code).collect()
}

/// The first quoted text of WKT: the system's name.
fn title(wkt: &str) -> &str {
    wkt.split('"').nth(1).unwrap_or_default()
}

/// Normalises a name: letters and digits only, with years as in the dataset.
fn compared(name: &str) -> String {
    let plain: String = name.chars().filter(|letter| letter.is_alphanumeric()).flat_map(char::to_lowercase).collect();
    plain.replace("etrs1989", "etrs89").replace("wgs1984", "wgs84").replace("nad1983", "nad83")
}
