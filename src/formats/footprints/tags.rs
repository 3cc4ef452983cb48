//! The attributes of a footprint by OpenStreetMap's keys, and lengths as people write them.

/// The assumed height of a storey, metres.
pub(super) const STOREY_M: f64 = 3.0;

/// The greatest accepted height, metres: no building is a kilometre high.
const MOST_M: f64 = 1000.0;

/// The attributes of a footprint as they are written. Keys are OpenStreetMap's, with `:` or `_`, in any case.
#[derive(Clone, Debug, Default)]
pub(super) struct FootprintTags {
    height: Option<String>,
    building_height: Option<String>,
    levels: Option<String>,
    min_height: Option<String>,
    min_level: Option<String>,
    part: Option<String>,
    building: Option<String>,
    location: Option<String>,
    street: Option<String>,
    house: Option<String>,
    /// Its usual name.
    pub name: Option<String>,
    /// The dwelling whose open space an area is; our own key, which OpenStreetMap lacks.
    pub dwelling: Option<String>,
    /// The file's own number for it.
    pub id: Option<String>,
}

/// The vertical extent of a block, metres above the foot of its outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rise {
    pub bottom_m: f64,
    pub top_m: f64,
    pub from: HeightSource,
    /// Whether the bottom is derived from levels.
    pub bottom_is_guessed: bool,
}

/// The source of a block's height.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum HeightSource {
    /// The height is in the file.
    Said,
    /// The height is derived from the storeys.
    Levels,
    /// The height is the user's, for all footprints without one.
    Default,
}

impl FootprintTags {
    /// Whether a key is read.
    pub(super) fn wants(key: &str) -> bool {
        key.len() <= 32 && FootprintTags::default().slot(&normal(key)).is_some() || normal(key) == "other_tags"
    }

    /// Stores the value of a key. Of several keys for the same thing the first counts.
    pub(super) fn set(&mut self, key: &str, value: &str) {
        let (key, value) = (normal(key), value.trim());
        if key == "other_tags" {
            self.set_others(value);
            return;
        }
        if let Some(slot) = self.slot(&key).filter(|slot| slot.is_none() && !value.is_empty()) {
            *slot = Some(value.to_owned());
        }
    }

    /// Reads the text in which GDAL puts OpenStreetMap's other keys: `"key"=>"value","key"=>"value"`.
    fn set_others(&mut self, text: &str) {
        let mut strings = QuotedStrings(text);
        while let (Some(key), Some(value)) = (strings.next(), strings.next()) {
            if normal(&key) != "other_tags" {
                self.set(&key, &value);
            }
        }
    }

    /// Where the value of a key is stored. dBASE cuts keys to ten letters.
    fn slot(&mut self, key: &str) -> Option<&mut Option<String>> {
        Some(match key {
            "height" => &mut self.height,
            "building_height" | "building_h" => &mut self.building_height,
            "levels" | "building_levels" | "building_l" => &mut self.levels,
            "min_height" | "building_min_height" => &mut self.min_height,
            "min_level" | "building_min_level" => &mut self.min_level,
            "building_part" | "building_p" => &mut self.part,
            "building" => &mut self.building,
            "location" => &mut self.location,
            "addr_street" | "addr_stree" => &mut self.street,
            "addr_housenumber" | "addr_house" => &mut self.house,
            "name" => &mut self.name,
            "dwelling" => &mut self.dwelling,
            "id" | "@id" | "osm_id" | "osm_way_id" | "gml_id" | "fid" => &mut self.id,
            _ => return None,
        })
    }

    pub(super) fn is_part(&self) -> bool {
        self.part.as_deref().is_some_and(|part| !is_no(part))
    }

    pub(super) fn is_building(&self) -> bool {
        self.building.as_deref().is_some_and(|building| !is_no(building))
    }

    pub(super) fn is_no_building(&self) -> bool {
        self.building.as_deref().is_some_and(is_no) && !self.is_part()
    }

    pub(super) fn is_underground(&self) -> bool {
        self.location.as_deref().is_some_and(|location| location.eq_ignore_ascii_case("underground"))
    }

    /// The kind of building, such as `apartments`.
    pub(super) fn kind(&self) -> Option<&str> {
        let kinds = [self.part.as_deref(), self.building.as_deref()].into_iter().flatten();
        let mut told = kinds.filter(|kind| !is_no(kind)).map(|kind| if is_yes(kind) { "building" } else { kind });
        let first = told.next();
        // a part usually says "yes", and its building something more specific
        if first == Some("building") { told.next().or(first) } else { first }
    }

    pub(super) fn address(&self) -> Option<String> {
        let street = self.street.as_ref()?;
        Some(self.house.as_ref().map_or_else(|| street.clone(), |house| format!("{street} {house}")))
    }

    /// The height that the file gives as a length or in storeys.
    pub(super) fn height_m(&self) -> Option<(f64, HeightSource)> {
        let said = [&self.height, &self.building_height].into_iter().flatten().find_map(|text| height(text));
        let guessed =
            || self.levels.as_deref().and_then(levels).map(|levels| (levels * STOREY_M, HeightSource::Levels));
        said.map(|metres| (metres, HeightSource::Said)).or_else(guessed)
    }

    /// Whether there is a height, as a length or in storeys, that cannot be read.
    pub(super) fn has_unread_height(&self) -> bool {
        let mut written = [&self.height, &self.building_height].into_iter().flatten();
        let is_unread = |text: &String| levels(text).is_none();
        written.any(|text| height(text).is_none()) || self.levels.as_ref().is_some_and(is_unread)
    }

    /// Whether there is a bottom that cannot be read. It is taken as the ground.
    pub(super) fn has_unread_bottom(&self) -> bool {
        let is_storey = |text: &String| levels(text).is_some() || number(text) == Some(0.0);
        self.min_height.as_ref().is_some_and(|text| bottom(text).is_none())
            || self.min_level.as_ref().is_some_and(|text| !is_storey(text))
    }

    /// The vertical extent; `None` without a height.
    pub(super) fn rise(&self, default_height_m: Option<f64>) -> Option<Rise> {
        let default = default_height_m.map(|metres| (metres, HeightSource::Default));
        let (top_m, from) = self.height_m().or(default)?;
        let said = self.min_height.as_deref().and_then(bottom);
        let guessed = || self.min_level.as_deref().and_then(levels).map(|levels| levels * STOREY_M);
        let bottom = said.or_else(guessed);
        let bottom_is_guessed = said.is_none() && bottom.is_some();
        Some(Rise { bottom_m: bottom.unwrap_or(0.0), top_m, from, bottom_is_guessed })
    }
}

fn normal(key: &str) -> String {
    key.trim().to_lowercase().replace([':', ' '], "_")
}

fn is_no(value: &str) -> bool {
    ["no", "false", "0"].iter().any(|no| value.eq_ignore_ascii_case(no))
}

fn is_yes(value: &str) -> bool {
    ["yes", "true", "1"].iter().any(|yes| value.eq_ignore_ascii_case(yes))
}

/// Reads a height that a building can have.
fn height(text: &str) -> Option<f64> {
    metres(text).filter(|&metres| metres > 0.0 && metres <= MOST_M)
}

/// Reads a bottom that a building can have above the ground.
fn bottom(text: &str) -> Option<f64> {
    metres(text).filter(|&metres| (0.0..=MOST_M).contains(&metres))
}

/// Reads a number of storeys.
fn levels(text: &str) -> Option<f64> {
    number(text).filter(|&levels| levels > 0.0 && levels * STOREY_M <= MOST_M)
}

/// Reads a length as people write it, in metres: `12`, `12 m`, `12,5`, `40'`, `40'6"`, `40 ft`.
pub(super) fn metres(text: &str) -> Option<f64> {
    const FOOT_M: f64 = 0.3048;
    let text = text.trim().to_lowercase().replace(['′', '’'], "'").replace('″', "\"").replace("''", "\"");
    if let Some((feet, inches)) = text.split_once('\'') {
        let inches = inches.trim().trim_end_matches('"').trim();
        let inches =
            if inches.is_empty() { 0.0 } else { number(inches).filter(|inches| (0.0..12.0).contains(inches))? };
        return Some((number(feet)? + inches / 12.0) * FOOT_M);
    }
    let split = text.find(|c: char| c.is_alphabetic() && c != 'e').unwrap_or(text.len());
    let (value, unit) = text.split_at(split);
    match unit.trim().trim_end_matches('.') {
        "" | "m" | "metre" | "metres" | "meter" | "meters" => number(value),
        "ft" | "foot" | "feet" => Some(number(value)? * FOOT_M),
        _ => None,
    }
}

/// Reads a finite number with a decimal point or comma. `1,200` is refused: it may be one or a thousand.
fn number(text: &str) -> Option<f64> {
    let text = text.trim();
    if is_ambiguous(text) {
        return None;
    }
    let text = if text.contains('.') { text.to_owned() } else { text.replacen(',', ".", 1) };
    text.parse().ok().filter(|number: &f64| number.is_finite())
}

/// Whether a comma may be a decimal or a thousands separator.
fn is_ambiguous(text: &str) -> bool {
    let Some((whole, decimals)) = text.split_once(',') else { return false };
    let is_number = |text: &str| text.bytes().all(|letter| letter.is_ascii_digit());
    let may_be_thousands = (1..=3).contains(&whole.len()) && !whole.starts_with('0');
    may_be_thousands && is_number(whole) && decimals.len() == 3 && is_number(decimals)
}

/// The quoted strings in a text; a backslash escapes the next character.
struct QuotedStrings<'a>(&'a str);

impl Iterator for QuotedStrings<'_> {
    type Item = String;

    fn next(&mut self) -> Option<String> {
        let (_, rest) = self.0.split_once('"')?;
        let mut found = String::new();
        let mut letters = rest.char_indices();
        while let Some((at, letter)) = letters.next() {
            match letter {
                '"' => {
                    self.0 = &rest[at + 1..];
                    return Some(found);
                }
                '\\' => found.extend(letters.next().map(|(_, letter)| letter)),
                letter => found.push(letter),
            }
        }
        None
    }
}
