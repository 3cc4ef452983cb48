//! The result of every reader: parts in the file's own coordinates, the meaning of these coordinates, and what was left
//! out.

use super::exact::{self, option as exact_option};
use super::gltf;
use crate::mesh::Part;
use crate::message::{Message, Worded, message, plain_display};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::PathBuf;

/// The contents of a model file.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// The name of the file's format, which [`super::read`] sets.
    pub format: &'static str,
    /// The parts in the file's order. Positions are in the file's own units, axes and coordinates, and so are the steps
    /// of coarse numbers.
    pub parts: Vec<Part>,
    /// The kind of each part, as many as there are parts; empty if all are [`PartKind::Building`].
    pub kinds: Vec<PartKind>,
    /// The up axis of the format.
    pub up: Up,
    /// Whether the file or its format defines it; otherwise it is a convention, which may be wrong.
    pub up_is_said: bool,
    /// The length of a unit in metres, if the file or its format says it.
    pub unit_m: Option<f64>,
    /// The meaning of the coordinates.
    pub coordinates: Coordinates,
    /// For each part, whether its heights are measured from the ground, whose height the file does not know. Such parts
    /// stand on the terrain below, if there is any. Empty if there are no such parts.
    pub from_ground: Vec<bool>,
    /// Where the file says that its own origin lies, the most exact anchor first. All are shown if they disagree.
    pub anchors: Vec<Anchor>,
    /// The unit, in metres, that an anchor's easting and northing are assumed to be in because the file does not give
    /// it. The map may have a different unit.
    pub assumed_map_unit_m: Option<f64>,
    /// What the file contains but the model does not.
    pub left_out: Vec<LeftOut>,
    /// Other notes on how the file was read: sentences without a full stop whose subject is the file.
    pub notes: Vec<Message>,
    /// See-through materials, each name once. They cast as if they were solid.
    pub see_through: Vec<SeeThrough>,
}

/// The kind of a part, which determines its defaults.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum PartKind {
    /// It casts and receives.
    #[default]
    Building,
    /// The measured ground. It casts and receives, and it is "the ground".
    Terrain,
    /// A sheet on the ground, such as a site, a road or water. It receives and does not cast.
    GroundCover,
}

impl PartKind {
    /// All kinds.
    pub const ALL: [PartKind; 3] = [PartKind::Building, PartKind::Terrain, PartKind::GroundCover];

    /// Its word.
    pub fn word(self) -> &'static str {
        match self {
            PartKind::Building => "building",
            PartKind::Terrain => "terrain",
            PartKind::GroundCover => "ground cover",
        }
    }
}

/// The meaning of a file's coordinates.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Coordinates {
    /// Coordinates of a drawing, without a relation to the Earth.
    #[default]
    Local,
    /// Coordinates in a map, or on the Earth: x is the easting or longitude, y the northing or latitude, z the height;
    /// geocentric ones are x, y, z. The text is the file's name for the reference system: `EPSG:25832`, a name, WKT or
    /// PROJ's text. Eastings and northings are in the system's unit, longitudes and latitudes in degrees. Heights are
    /// in the unit `unit_m`; without it in the unit that a compound system has for heights, otherwise in metres.
    Map(String),
}

/// A statement of where the origin of a file's coordinates lies.
#[derive(Clone, Debug, PartialEq)]
pub struct Anchor {
    /// The file's own term for the source of the statement: `IfcMapConversion`.
    pub said_by: &'static str,
    /// The point where the origin lies.
    pub at: AnchorPoint,
    /// Radians clockwise from the file's own north (+y if z is up) to the anchor's north: the map's for a point in a
    /// map, otherwise true north. `None` if the file does not give it.
    pub north_rad: Option<f64>,
}

/// A point in a map, or on the Earth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum AnchorPoint {
    /// A point in a map.
    Map {
        /// As in [`Coordinates::Map`]; empty if the file does not name it.
        crs: String,
        /// Metres.
        #[serde(with = "exact")]
        easting: f64,
        /// Metres.
        #[serde(with = "exact")]
        northing: f64,
        /// Metres, if the file gives it.
        #[serde(with = "exact_option")]
        height: Option<f64>,
        /// Metres in the map for a metre of the file.
        #[serde(with = "exact")]
        scale: f64,
    },
    /// A point on the Earth, in WGS 84.
    Geographic {
        /// Degrees, north positive.
        #[serde(with = "exact")]
        latitude_deg: f64,
        /// Degrees, east positive.
        #[serde(with = "exact")]
        longitude_deg: f64,
        /// Metres, if the file gives it.
        #[serde(with = "exact_option")]
        elevation_m: Option<f64>,
    },
    /// No point: the file only says which way north is.
    Nowhere,
}

/// Things of a kind that were left out.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct LeftOut {
    /// The thing, in the file's own terms: `IfcSpace`, `3DSOLID`.
    pub what: String,
    /// Their number.
    pub count: u64,
    /// The reason, in words that fit singular and plural: "not built".
    pub why: String,
}

/// A material that is cut out or translucent.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SeeThrough {
    /// Its name, by which `casts` can select it.
    pub material: String,
    /// The indices of the parts that have it, at least one.
    pub parts: Vec<usize>,
}

/// The up axis of a model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Up {
    /// y is up, as in glTF: x is east, and −z north.
    #[default]
    Y,
    /// z is up, as in drawings and maps: x is east, and y north.
    Z,
}

/// A scene of a model.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(untagged)]
pub enum SceneName {
    /// The scene with this name.
    Name(String),
    /// The scene with this index in the file, from 0.
    Number(u64),
}

impl fmt::Display for SceneName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SceneName::Name(name) => write!(f, "\"{name}\""),
            SceneName::Number(number) => write!(f, "{number}"),
        }
    }
}

/// Options for reading a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReadOptions {
    /// The scene; by default the file's default scene.
    pub scene: Option<SceneName>,
    /// Metres a unit of the file, where the user says so; by default as the file says.
    #[serde(with = "exact_option")]
    pub scale: Option<f64>,
    /// Metres from the ground to the roof of a footprint whose file says no height.
    #[serde(with = "exact_option")]
    pub default_height_m: Option<f64>,
    /// The greatest error of a thinned terrain, metres.
    #[serde(with = "exact")]
    pub terrain_error_m: f64,
    /// The classes of measured points that are read besides the ground: `building`, `vegetation`.
    pub point_classes: Vec<String>,
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self {
            scene: None,
            scale: None,
            default_height_m: None,
            terrain_error_m: Self::TERRAIN_ERROR_M,
            point_classes: Vec::new(),
        }
    }
}

impl ReadOptions {
    /// The coarsest step that gets no note, metres. Receivers are judged at this height above themselves.
    const TOLD_M: f64 = 0.001;
    /// The default for the greatest error of a thinned terrain, metres.
    pub const TERRAIN_ERROR_M: f64 = 0.1;

    /// Numbers with a coarser step than this get a note, in the units of a file that says how many metres one is.
    pub(super) fn told_step(&self, unit_m: f64) -> f64 {
        Self::TOLD_M / self.scale.unwrap_or(unit_m)
    }
}

/// A model file that cannot be used.
#[derive(Debug, thiserror::Error)]
pub struct ModelError {
    /// The file, as requested.
    pub file: PathBuf,
    /// What is wrong with it.
    pub fault: ModelFault,
}

/// What is wrong with a model file.
#[derive(Debug)]
pub enum ModelFault {
    /// The fault of a glTF file.
    #[doc(hidden)]
    Gltf(gltf::Fault),
    /// The fault of a file of another format, with a hint; the file is the subject.
    Unusable(Message),
    /// The reading was cancelled.
    GivenUp,
}

plain_display!(ModelError);

impl Worded for ModelError {
    fn message(&self) -> Message {
        let file = self.file.display().to_string();
        match &self.fault {
            ModelFault::Unusable(message) => Message::clone(message).of(file.into()),
            fault => format!("{file}: {fault}").into(),
        }
    }
}

impl ModelError {
    /// Whether the user cancelled the reading, so that nothing is wrong.
    pub fn is_given_up(&self) -> bool {
        matches!(self.fault, ModelFault::GivenUp)
    }
}

impl std::error::Error for ModelFault {}

impl fmt::Display for ModelFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ModelFault::Gltf(fault) => fault.fmt(f),
            ModelFault::Unusable(message) => message.fmt(f),
            ModelFault::GivenUp => f.write_str("was not read to its end: the reading was cancelled"),
        }
    }
}

impl From<gltf::Fault> for ModelFault {
    fn from(fault: gltf::Fault) -> Self {
        ModelFault::Gltf(fault)
    }
}

impl From<Message> for ModelFault {
    fn from(message: Message) -> Self {
        ModelFault::Unusable(message)
    }
}

impl ModelFault {
    /// The operating system cannot read the file.
    pub(crate) fn unreadable(error: std::io::Error) -> Self {
        message![format!("cannot be read: {error}")].into()
    }

    /// Whether the user asked for a scene that the file does not have.
    pub(crate) fn is_about_scene(&self) -> bool {
        matches!(self, ModelFault::Gltf(gltf::Fault::Scene(_)))
    }
}

impl Model {
    /// The kind of a part.
    pub fn kind(&self, part: usize) -> PartKind {
        self.kinds.get(part).copied().unwrap_or_default()
    }

    /// Whether a part's heights are measured from the ground.
    pub fn is_from_ground(&self, part: usize) -> bool {
        self.from_ground.get(part).copied().unwrap_or_default()
    }

    /// Whether all parts' heights are, so that the model has no height above the sea.
    pub fn stands_on_ground(&self) -> bool {
        !self.from_ground.is_empty() && self.from_ground.iter().all(|is_from_ground| *is_from_ground)
    }

    /// The number of its triangles.
    pub fn triangles(&self) -> u64 {
        self.parts.iter().map(|part| part.triangles.len() as u64).sum()
    }
}
