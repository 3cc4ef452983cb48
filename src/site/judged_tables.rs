//! The tables of the site file that say what a rule judges, as written.

use serde::de::{Deserializer, Error as _};
use serde::{Deserialize, Serialize, Serializer};
use toml::Value;

/// `[[area]]`
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct AreaTable {
    /// What people call it; beside `file` which of its polygons is meant.
    pub name: Option<String>,
    /// Its corners, metres east and north.
    pub polygon: Option<Vec<[f64; 2]>>,
    /// A GeoJSON file.
    pub file: Option<String>,
    /// The reference system of that file's coordinates.
    pub crs: Option<String>,
    /// The components whose upper faces it is.
    pub component: Option<WrittenNames>,
    /// Metres above the ground.
    pub height: Option<f64>,
    /// Metres above the place's point.
    pub level: Option<f64>,
    /// What the dwelling to which it belongs is called.
    pub dwelling: Option<String>,
}

/// `[[window]]`
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct WindowTable {
    /// What people call it.
    pub name: Option<String>,
    /// The components whose pieces are panes.
    pub component: Option<WrittenNames>,
    /// The four corners of the glass, metres.
    pub corners: Option<[[f64; 3]; 4]>,
    /// What its room is called.
    pub room: Option<String>,
    /// What its dwelling is called.
    pub dwelling: Option<String>,
    /// What the room is used for.
    pub usage: Option<String>,
    /// Metres from the wall's outer plane to the glass.
    pub reveal: Option<f64>,
    /// Metres from the glass to the wall's inner plane.
    pub inner: Option<f64>,
    /// The floor's height, metres above the place's point.
    pub floor: Option<f64>,
    /// The room's floor area, square metres.
    pub room_area: Option<f64>,
    /// A table of windows with their rooms.
    pub rooms: Option<String>,
}

/// `[[facade]]`
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct FacadeTable {
    /// What people call it.
    pub name: Option<String>,
    /// The components whose upright faces it is.
    pub component: Option<WrittenNames>,
    /// Metres from point to point.
    pub spacing: Option<f64>,
    /// Metres above the ground.
    pub heights: Option<Vec<f64>>,
}

/// `[plot]`
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct PlotTable {
    /// Its corners, metres east and north.
    pub border: Option<Vec<[f64; 2]>>,
    /// A GeoJSON file.
    pub file: Option<String>,
    /// The reference system of that file's coordinates.
    pub crs: Option<String>,
    /// Where roads or water adjoin.
    pub roads: Option<Vec<RoadTable>>,
    /// Where the neighbour's ground lies at another height.
    pub neighbours: Option<Vec<NeighbourTable>>,
    /// Metres above the place's point.
    pub mean_ground: Option<f64>,
}

/// A road, or water, along one side of a plot.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct RoadTable {
    /// The number of the side: 1 runs from the first corner to the second.
    pub side: u64,
    /// Metres.
    pub width: f64,
}

/// A neighbour's ground along one side of a plot.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct NeighbourTable {
    /// As of a road.
    pub side: u64,
    /// Metres above the mean level of the ground.
    pub higher: f64,
}

/// `[before]`
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct BeforeTable {
    /// The site file of that state.
    pub site: Option<String>,
    /// The components that do not stand there yet.
    pub absent: Option<WrittenNames>,
    /// The components that stand there and are gone by now.
    pub demolished: Option<WrittenNames>,
}

/// One name, or several.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrittenNames(pub Vec<String>);

impl Serialize for WrittenNames {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        match self.0.as_slice() {
            [name] => to.serialize_str(name),
            names => names.serialize(to),
        }
    }
}

impl<'de> Deserialize<'de> for WrittenNames {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let wrong = || D::Error::custom("expected a name in quotes or a list of such names");
        match Value::deserialize(from)? {
            Value::String(name) => Ok(WrittenNames(vec![name])),
            Value::Array(names) => {
                let text = |name| if let Value::String(name) = name { Ok(name) } else { Err(wrong()) };
                names.into_iter().map(text).collect::<Result<_, _>>().map(WrittenNames)
            }
            _ => Err(wrong()),
        }
    }
}
