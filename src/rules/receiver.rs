//! What a rule judges.

use super::error::RuleError;
use super::reader::TableReader;
use crate::choice::words;

/// Which kind of thing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ReceiverWord {
    Area,
    Facade,
    Window,
    Lines,
}

const RECEIVER_WORDS: &[(&str, ReceiverWord)] = &[
    ("area", ReceiverWord::Area),
    ("facade", ReceiverWord::Facade),
    ("window", ReceiverWord::Window),
    ("lines", ReceiverWord::Lines),
];

/// Where of a window is judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WindowPoint {
    /// The middle of its width, in the inner plane of the wall.
    MiddleInside,
    /// The middle of the window, in the wall's outer plane.
    MiddleOutside,
    /// The middle of the sill, on the inner side of the glass.
    SillInside,
    /// The middle of the sill, in the wall's outer plane.
    SillMiddle,
    /// Both ends of the sill, in the wall's outer plane: lit where both are.
    SillEnds,
}

words!(WindowPoint, [
    "middle-inside" => WindowPoint::MiddleInside,
    "middle-outside" => WindowPoint::MiddleOutside,
    "sill-inside" => WindowPoint::SillInside,
    "sill-middle" => WindowPoint::SillMiddle,
    "sill-ends" => WindowPoint::SillEnds,
]);

/// Windows whose spells are one list: lit where any of them is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grouping {
    /// Those of a room.
    Room,
    /// Those of one use in a dwelling.
    Dwelling,
}

words!(Grouping, [
    "room" => Grouping::Room,
    "dwelling" => Grouping::Dwelling,
]);

/// What a height is counted from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HeightOver {
    /// The ground below.
    Ground,
    /// The mean level of the ground at the building.
    MeanGround,
    /// The floor of the room.
    Floor,
}

words!(HeightOver, [
    "ground" => HeightOver::Ground,
    "mean-ground" => HeightOver::MeanGround,
    "floor" => HeightOver::Floor,
]);

/// How a line at a distance goes round a corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CornerRule {
    /// At the same distance from the corner.
    Round,
    /// Straight on to where the lines meet.
    Mitred,
}

words!(CornerRule, [
    "round" => CornerRule::Round,
    "mitred" => CornerRule::Mitred,
]);

/// Whose law moves a plot's border outward where a road or water adjoins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DeemedBoundary {
    /// Japan's Enforcement Order of the Building Standards Act, art. 135-12 para. 3.
    Japan,
}

words!(DeemedBoundary, ["jp" => DeemedBoundary::Japan]);

/// A strip along a plot's border.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// From so far outside of the border, metres.
    pub from_m: f64,
    /// To so far, which may be infinity.
    pub to_m: f64,
}

/// What is judged.
#[derive(Clone, Debug, PartialEq)]
pub enum RuleReceiver {
    /// Areas, each by the part of it that gets enough.
    Area {
        /// Narrower parts do not count, metres.
        least_width_m: f64,
    },
    /// Façades, windows or not.
    Facade,
    /// Windows.
    Window {
        /// Where of a window.
        at: WindowPoint,
        /// At least so far above the floor, metres.
        floor_m: f64,
        /// At least so far above the sill, metres.
        sill_m: f64,
        /// Which windows are judged together.
        group: Option<Grouping>,
        /// The uses that a dwelling must have lit, all of them; empty where the rule knows no uses.
        all_of: Vec<String>,
    },
    /// A level plane around a plot.
    Lines {
        /// Its height, metres.
        height_m: f64,
        /// From what.
        over: HeightOver,
        /// Whose law says where the border is.
        deemed: Option<DeemedBoundary>,
        /// The strips, by which criteria are bound.
        bands: Vec<Band>,
        /// How they go round corners.
        corners: CornerRule,
    },
}

impl RuleReceiver {
    /// What [receiver] may say.
    pub(super) const KEYS: &[&str] = &[
        "kind",
        "least_width",
        "at",
        "floor",
        "sill",
        "group",
        "all_of",
        "height",
        "over",
        "deemed",
        "bands",
        "corners",
    ];

    pub(super) fn read(table: TableReader) -> Result<RuleReceiver, RuleError> {
        const MOST_M: f64 = 1000.0;
        let must = |key: &'static str| table.wrong(key, "it must be written");
        let metres = |key: &'static str| table.number(key, 0.0, MOST_M);
        let receiver = match table.one_of("kind", RECEIVER_WORDS)?.ok_or_else(|| must("kind"))? {
            ReceiverWord::Area => RuleReceiver::Area { least_width_m: metres("least_width")?.unwrap_or(0.0) },
            ReceiverWord::Facade => RuleReceiver::Facade,
            ReceiverWord::Window => RuleReceiver::Window {
                at: table.word("at")?.ok_or_else(|| must("at"))?,
                floor_m: metres("floor")?.unwrap_or(0.0),
                sill_m: metres("sill")?.unwrap_or(0.0),
                group: table.word("group")?,
                all_of: table.texts("all_of")?.into_iter().map(str::to_owned).collect(),
            },
            ReceiverWord::Lines => RuleReceiver::Lines {
                height_m: metres("height")?.ok_or_else(|| must("height"))?,
                over: table.word("over")?.ok_or_else(|| must("over"))?,
                deemed: table.word("deemed")?,
                bands: bands(&table)?,
                corners: table.word("corners")?.ok_or_else(|| must("corners"))?,
            },
        };
        table.finish()?;
        Ok(receiver)
    }
}

/// Pairs of distances from the border, each strip beginning where the one before ends or further out.
fn bands(table: &TableReader) -> Result<Vec<Band>, RuleError> {
    let what = "write the strips as pairs of metres, the nearest first: [[5, 10], [10, inf]]";
    let pair = |value: &toml::Value| {
        let [from, to] = value.as_array()?.as_slice() else { return None };
        let metres = |value: &toml::Value| value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64));
        let band = Band { from_m: metres(from)?, to_m: metres(to)? };
        (band.from_m >= 0.0 && band.from_m < band.to_m && band.from_m.is_finite()).then_some(band)
    };
    let list = table.value("bands").and_then(|value| value.as_array()).filter(|list| !list.is_empty());
    let bands: Option<Vec<Band>> = list.and_then(|list| list.iter().map(pair).collect());
    let is_ordered = |bands: &Vec<Band>| bands.windows(2).all(|two| two[0].to_m <= two[1].from_m);
    bands.filter(is_ordered).ok_or_else(|| table.wrong("bands", what))
}

impl DeemedBoundary {
    /// How far outside of the border it is deemed to lie where a road or water of a width adjoins, metres.
    pub fn outward_m(self, road_width_m: f64) -> f64 {
        match self {
            // up to 10 m wide its middle; beyond that 5 m before its far side
            DeemedBoundary::Japan if road_width_m <= 10.0 => road_width_m / 2.0,
            DeemedBoundary::Japan => road_width_m - 5.0,
        }
    }

    /// How much the plane is raised where the neighbour's ground lies higher by so much, metres.
    pub fn raised_m(self, neighbour_higher_m: f64) -> f64 {
        match self {
            DeemedBoundary::Japan if neighbour_higher_m >= 1.0 => (neighbour_higher_m - 1.0) / 2.0,
            DeemedBoundary::Japan => 0.0,
        }
    }
}
