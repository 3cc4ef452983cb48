//! The receivers of rules: areas, façades, windows, and planes around a plot.

use super::error::RuleError;
use super::reader::TableReader;
use crate::choice::words;

/// A rule's word for a kind of receiver.
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

/// The point of a window that is judged.
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
    /// Both ends of the sill, in the wall's outer plane: the window is lit when both are.
    SillEnds,
}

words!(WindowPoint, [
    "middle-inside" => WindowPoint::MiddleInside,
    "middle-outside" => WindowPoint::MiddleOutside,
    "sill-inside" => WindowPoint::SillInside,
    "sill-middle" => WindowPoint::SillMiddle,
    "sill-ends" => WindowPoint::SillEnds,
]);

/// Windows that are judged together: lit when any of them is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grouping {
    /// The windows of a room.
    Room,
    /// The windows of one use in a dwelling.
    Dwelling,
}

words!(Grouping, [
    "room" => Grouping::Room,
    "dwelling" => Grouping::Dwelling,
]);

/// The level from which a height is measured.
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

/// How a line at a constant distance from a border turns a corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CornerRule {
    /// In an arc around the corner.
    Round,
    /// Straight on, to where the two lines meet.
    Mitred,
}

words!(CornerRule, [
    "round" => CornerRule::Round,
    "mitred" => CornerRule::Mitred,
]);

/// Which law moves the border of a plot outwards along roads and water.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DeemedBoundary {
    /// Japan's Enforcement Order of the Building Standards Act, art. 135-12 para. 3.
    Japan,
}

words!(DeemedBoundary, ["jp" => DeemedBoundary::Japan]);

/// A strip along the border of a plot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// The distance from the border at which the strip begins, metres.
    pub from_m: f64,
    /// The distance at which it ends, metres; infinite for an open strip.
    pub to_m: f64,
}

/// Areas that belong to dwellings.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenSpaces {
    /// Which of the uses in `all_of` they are.
    pub usage: String,
    /// How much of one must be lit at a time, square metres; all of it if it is smaller.
    pub least_lit_m2: f64,
}

/// What a rule judges.
#[derive(Clone, Debug, PartialEq)]
pub enum RuleReceiver {
    /// Areas, each by the part of it that gets enough.
    Area {
        /// The least width: narrower parts do not count, metres.
        least_width_m: f64,
    },
    /// Façades, with or without windows.
    Facade,
    /// Windows.
    Window {
        /// The point that is judged.
        at: WindowPoint,
        /// The least height of that point above the floor, metres.
        floor_m: f64,
        /// The least height of that point above the sill, metres.
        sill_m: f64,
        /// Which windows are judged together; `None` if each is judged alone.
        group: Option<Grouping>,
        /// The uses of a dwelling that must all be lit; empty if the rule knows no uses.
        all_of: Vec<String>,
        /// The areas that belong to dwellings, if the rule counts them beside windows.
        open_spaces: Option<OpenSpaces>,
    },
    /// A level plane around a plot.
    Lines {
        /// Its height, metres.
        height_m: f64,
        /// The level from which that is measured.
        over: HeightOver,
        /// Which law moves the border outwards.
        deemed: Option<DeemedBoundary>,
        /// The strips to which criteria apply.
        bands: Vec<Band>,
        /// How the strips turn corners.
        corners: CornerRule,
    },
}

impl RuleReceiver {
    /// The keys that `[receiver]` may have.
    pub(super) const KEYS: &[&str] = &[
        "kind",
        "least_width",
        "at",
        "floor",
        "sill",
        "group",
        "all_of",
        "open_space",
        "open_space_lit",
        "height",
        "over",
        "deemed",
        "bands",
        "corners",
    ];

    pub(super) fn read(table: TableReader) -> Result<RuleReceiver, RuleError> {
        const MOST_M: f64 = 1000.0;
        let must = |key: &'static str| table.wrong(key, "it is required");
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
                open_spaces: open_spaces(&table)?,
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

/// Reads which use of a dwelling the areas are.
fn open_spaces(table: &TableReader) -> Result<Option<OpenSpaces>, RuleError> {
    let usage = table.text("open_space")?;
    let least_lit_m2 = table.number("open_space_lit", 0.0, 1e6)?;
    match usage {
        None if least_lit_m2.is_some() => Err(table.wrong("open_space_lit", "it says nothing without open_space")),
        Some(usage) if !table.texts("all_of")?.contains(&usage) => {
            Err(table.wrong("open_space", "it is none of the uses in all_of"))
        }
        usage => {
            Ok(usage.map(|usage| OpenSpaces { usage: usage.to_owned(), least_lit_m2: least_lit_m2.unwrap_or(0.0) }))
        }
    }
}

/// Reads pairs of distances from the border. Each strip begins where the one before ends, or further out.
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
    /// Returns how far outwards the border moves, in metres, along a road or water of a width.
    pub fn outward_m(self, road_width_m: f64) -> f64 {
        match self {
            // to the middle if that is at most 10 m wide; otherwise to 5 m from its far side
            DeemedBoundary::Japan if road_width_m <= 10.0 => road_width_m / 2.0,
            DeemedBoundary::Japan => road_width_m - 5.0,
        }
    }

    /// Returns how far the plane is raised, in metres, where the neighbour's ground lies this much higher.
    pub fn raised_m(self, neighbour_higher_m: f64) -> f64 {
        match self {
            DeemedBoundary::Japan if neighbour_higher_m >= 1.0 => (neighbour_higher_m - 1.0) / 2.0,
            DeemedBoundary::Japan => 0.0,
        }
    }
}
