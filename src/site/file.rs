//! The site file as written: TOML → [`SiteFile`]. [`crate::site::Site::load`] finds out what it means.

use super::error::{FieldLocation, SiteError};
use super::judged_tables::{AreaTable, BeforeTable, FacadeTable, PlotTable, WindowTable};
use super::keys;
use super::overrides::refuse;
use crate::formats::SceneName;
use crate::message::message;
use serde::de::{DeserializeOwned, Error as _};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use toml::{Table, Value};

/// A site file as written: nothing checked but keys and types.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct SiteFile {
    /// `[place]`
    pub place: Option<PlaceTable>,
    /// `[[model]]`, in their order.
    #[serde(skip_serializing_if = "is_default")]
    pub model: Vec<ModelTable>,
    /// `[ground]`
    #[serde(skip_serializing_if = "is_default")]
    pub ground: GroundTable,
    /// `[study]`
    #[serde(skip_serializing_if = "is_default")]
    pub study: StudyTable,
    /// `[plan]`
    #[serde(skip_serializing_if = "is_default")]
    pub plan: PlanTable,
    /// `[camera]`
    #[serde(skip_serializing_if = "is_default")]
    pub camera: CameraTable,
    /// `[[probe]]`, in their order.
    #[serde(skip_serializing_if = "is_default")]
    pub probe: Vec<ProbeTable>,
    /// `[[area]]`, in their order.
    #[serde(skip_serializing_if = "is_default")]
    pub area: Vec<AreaTable>,
    /// `[[window]]`, in their order.
    #[serde(skip_serializing_if = "is_default")]
    pub window: Vec<WindowTable>,
    /// `[[facade]]`, in their order.
    #[serde(skip_serializing_if = "is_default")]
    pub facade: Vec<FacadeTable>,
    /// `[plot]`
    pub plot: Option<PlotTable>,
    /// `[before]`
    pub before: Option<BeforeTable>,
}

/// `[place]`
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct PlaceTable {
    /// What people call it.
    pub name: Option<String>,
    /// Degrees, north positive.
    pub latitude: Option<f64>,
    /// Degrees, east positive.
    pub longitude: Option<f64>,
    /// Metres above sea level.
    pub elevation: Option<f64>,
    /// IANA name.
    pub time_zone: Option<String>,
    /// The model's file that proposed it, where one did; a text has it in a comment.
    #[serde(skip)]
    pub source: Option<PlaceSource>,
    /// The model's file that proposed the elevation alone, where one did.
    #[serde(skip)]
    pub elevation_source: Option<ElevationSource>,
}

/// Which file proposed an elevation.
#[derive(Clone, Debug, PartialEq)]
pub struct ElevationSource {
    /// The file, and what in it.
    pub said: String,
    /// The elevation that it proposed: another one is a person's.
    pub elevation: f64,
}

/// Which file proposed a place.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaceSource {
    /// The file, and what in it: `house.ifc, IfcSite`.
    pub said: String,
    /// The latitude and longitude that it proposed: other ones are a person's.
    pub at: [f64; 2],
}

/// `[[model]]`
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct ModelTable {
    /// Relative to the site file, or absolute.
    pub path: Option<String>,
    /// The scene that is read, of a file that has several.
    pub scene: Option<SceneName>,
    /// The axis that is up: `y` or `z`.
    pub up: Option<String>,
    /// Degrees clockwise from the model's north to true north.
    pub north: Option<f64>,
    /// Metres east, north, up.
    pub position: Option<[f64; 3]>,
    /// Metres per model unit.
    pub scale: Option<f64>,
    /// Metres from the ground to the roof of a footprint without a height.
    pub default_height: Option<f64>,
    /// How far a thinned terrain may lie from its heights, metres.
    pub terrain_error: Option<f64>,
    /// The classes of measured points that stand there beside the ground.
    pub classes: Option<Vec<String>>,
    /// Names of what is read of it; with a `!` before it of what is not.
    pub layers: Option<Vec<String>>,
    /// The reference system of its coordinates.
    pub crs: Option<String>,
    /// What casts.
    #[serde(default, skip_serializing_if = "is_default")]
    pub casts: Names,
    /// What receives.
    #[serde(default, skip_serializing_if = "is_default")]
    pub receives: Names,
    /// What is terrain; as the model's format says where it is absent.
    pub terrain: Option<Names>,
}

/// `[ground]`
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct GroundTable {
    /// Metres.
    pub level: Option<f64>,
}

/// `[study]`
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct StudyTable {
    /// Year-month-day.
    pub date: Option<Text>,
    /// The first and the last of several days.
    pub dates: Option<[Text; 2]>,
    /// First instant.
    pub from: Option<Text>,
    /// Last instant.
    pub to: Option<Text>,
    /// Duration.
    pub step: Option<String>,
    /// Duration, or `step`.
    pub resolution: Option<String>,
    /// A technique's name.
    pub technique: Option<String>,
}

/// `[plan]`
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct PlanTable {
    /// West, south, east, north, metres.
    pub region: Option<[f64; 4]>,
    /// Side of a cell, metres.
    pub cell: Option<f64>,
}

/// `[camera]`
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct CameraTable {
    /// Metres.
    pub eye: Option<[f64; 3]>,
    /// Metres.
    pub target: Option<[f64; 3]>,
    /// Any length but 0.
    pub up: Option<[f64; 3]>,
    /// Vertical, degrees.
    pub fov: Option<f64>,
    /// A side's name: this side is seen instead, along parallel rays.
    pub side: Option<String>,
}

/// `[[probe]]`
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct ProbeTable {
    /// What people call it.
    pub name: Option<String>,
    /// Metres.
    pub point: Option<[f64; 3]>,
    /// Any length but 0.
    pub normal: Option<[f64; 3]>,
}

/// Which components of a model: all, none, or those of some names.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Names {
    /// `true` or `false`.
    All(bool),
    /// Names of components, nodes, meshes or materials; with a `!` before it all but what has the name.
    Some(Vec<String>),
}

impl Default for Names {
    fn default() -> Self {
        Names::All(true)
    }
}

impl<'de> Deserialize<'de> for Names {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let wrong = || D::Error::custom("expected true, false or a list of names in quotes");
        match Value::deserialize(from)? {
            Value::Boolean(all) => Ok(Names::All(all)),
            Value::Array(names) => names
                .into_iter()
                .map(|name| match name {
                    Value::String(name) => Ok(name),
                    _ => Err(wrong()),
                })
                .collect::<Result<_, _>>()
                .map(Names::Some),
            _ => Err(wrong()),
        }
    }
}

impl<'de> Deserialize<'de> for SceneName {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let wrong = || D::Error::custom("expected a scene's name in quotes, or its number from 0");
        match Value::deserialize(from)? {
            Value::String(name) => Ok(SceneName::Name(name)),
            Value::Integer(number) => u64::try_from(number).map(SceneName::Number).map_err(|_| wrong()),
            _ => Err(wrong()),
        }
    }
}

/// A string, or one of TOML's dates and times as its text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Text(pub String);

impl Serialize for Text {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(&self.0)
    }
}

impl<'de> Deserialize<'de> for Text {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        match Value::deserialize(from)? {
            Value::String(text) => Ok(Text(text)),
            Value::Datetime(time) => Ok(Text(time.to_string())),
            other => Err(D::Error::custom(format!("expected text in quotes, not {}", other.type_str()))),
        }
    }
}

impl SiteFile {
    /// The text of a site file that reads as this one. Comments are no part of it.
    ///
    /// # Errors
    /// What TOML cannot hold.
    pub fn to_toml(&self) -> Result<String, SiteError> {
        toml::to_string(self).map_err(|error| SiteError::Unwritable { what: error.to_string() })
    }

    /// Reads a site file's text; `file` names it in errors.
    ///
    /// # Errors
    /// What is not TOML, unknown tables and keys, values of the wrong type.
    pub fn parse(file: &str, text: &str) -> Result<SiteFile, SiteError> {
        // A mark that Windows editors put first, and TOML does not know.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let root: Table = toml::from_str(text).map_err(|error| {
            let start = error.span().map_or(0, |span| span.start);
            let before = text.bytes().take(start).filter(|byte| *byte == b'\n');
            let line = before.count();
            let said = text.lines().nth(line).unwrap_or_default().trim();
            let mut what = error.message().to_owned();
            if said.split_once('"').is_some_and(|(_, quoted)| quoted.contains('\\')) {
                what.push_str(
                    "; in double quotes a backslash changes what follows it: write / between folders, or put the path in \
                     single quotes",
                );
            }
            SiteError::Toml { file: file.to_owned(), line: line + 1, text: said.to_owned(), what }
        })?;
        keys::check(file, &root)?;
        Ok(SiteFile {
            ground: table(file, &root, "ground")?.unwrap_or_default(),
            study: table(file, &root, "study")?.unwrap_or_default(),
            plan: table(file, &root, "plan")?.unwrap_or_default(),
            camera: table(file, &root, "camera")?.unwrap_or_default(),
            place: table(file, &root, "place")?,
            model: list(file, &root, "model")?,
            probe: list(file, &root, "probe")?,
            area: list(file, &root, "area")?,
            window: list(file, &root, "window")?,
            facade: list(file, &root, "facade")?,
            plot: table(file, &root, "plot")?,
            before: table(file, &root, "before")?,
        })
    }
}

/// What is not said is not written.
fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

fn list<T: DeserializeOwned>(file: &str, root: &Table, name: &str) -> Result<Vec<T>, SiteError> {
    let Some(Value::Array(tables)) = root.get(name) else { return Ok(Vec::new()) };
    let read = |(index, table)| typed(file, name, &keys::numbered(name, index, tables.len()), table);
    tables.iter().enumerate().map(read).collect()
}

fn table<T: DeserializeOwned>(file: &str, root: &Table, name: &str) -> Result<Option<T>, SiteError> {
    root.get(name).map(|value| typed(file, name, &keys::bracketed(name), value)).transpose()
}

/// A table's values in their types, or which key has the wrong one and how it is written.
fn typed<T: DeserializeOwned>(file: &str, name: &str, brackets: &str, value: &Value) -> Result<T, SiteError> {
    T::deserialize(value.clone()).map_err(|error| {
        // The library tells the key only in its own text: "… \nin `latitude`".
        let text = error.to_string();
        let key = text.rsplit_once("in `").map_or("", |(_, key)| key.trim_end().trim_end_matches('`'));
        let key = key.split(['.', '[']).next().unwrap_or_default();
        let what = error.message().replace("f64", "a number");
        let at = FieldLocation::Key { file: file.to_owned(), table: brackets.to_owned(), key: key.to_owned() };
        refuse(at, message![what; format!("write for example {}", keys::example(name, key))])
    })
}
