//! What must hold for a rule to be kept.

use super::counting::CountHow;
use super::error::RuleError;
use super::reader::TableReader;
use super::window::WindowRule;
use crate::choice::words;

/// What is demanded of a number.
#[derive(Clone, Debug, PartialEq)]
pub enum Demand {
    /// So much time at least.
    AtLeast {
        /// Of what is counted, seconds.
        secs: i64,
        /// Of the longest spell, seconds; 0 where that does not matter.
        longest_secs: i64,
    },
    /// So much time at most, seconds.
    AtMost(i64),
    /// At most this share of area times time that would be lit if nothing stood there.
    ShareOfOpen(f64),
    /// Nothing: the number is told.
    Report {
        /// Told apart where all sun goes for longer than this, seconds.
        no_sun_left_secs: Option<i64>,
    },
}

/// Of what it must hold.
#[derive(Clone, Debug, PartialEq)]
pub enum Extent {
    /// The receiver; of an area each point of it.
    Whole,
    /// A part of an area.
    Part {
        /// Of the area, 0 to 1.
        share: f64,
        /// Or so many square metres, where that is less.
        or_area_m2: Option<f64>,
    },
    /// As much of an area as this share of what it held for before.
    OfBefore(f64),
    /// So many of the dwellings, 0 to 1, with each of the uses that the receiver names.
    Dwellings(f64),
    /// At most so many of the dwellings get nothing, 0 to 1.
    Sunless {
        /// Of the dwellings.
        most: f64,
        /// Which dwelling gets nothing.
        counts: SunlessWhen,
    },
}

/// When a dwelling of several uses is said to have no sun.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SunlessWhen {
    /// Where one of its uses has none.
    OneUse,
    /// Where all its uses have none.
    AllUses,
}

words!(SunlessWhen, [
    "one" => SunlessWhen::OneUse,
    "all" => SunlessWhen::AllUses,
]);

/// One condition of a rule.
#[derive(Clone, Debug, PartialEq)]
pub struct Criterion {
    /// The days to which it is bound, by their name; empty for all.
    pub on: String,
    /// The strip of the plane to which it is bound, from 0.
    pub band: Option<usize>,
    /// Its grade, where the rule has grades.
    pub grade: Option<String>,
    /// How is counted for it.
    pub how: CountHow,
    /// Its own windows, where they are not the day's.
    pub windows: Option<WindowRule>,
    /// What is demanded.
    pub demand: Demand,
    /// Of what.
    pub extent: Extent,
    /// Kept as well by what has this share of what was before.
    pub or_ratio: Option<f64>,
    /// Kept as well where it was not kept before and nothing has become less.
    pub no_worse: bool,
}

impl Criterion {
    /// What [[pass]] and [[any]] may say.
    pub(super) const KEYS: &[&str] = &[
        "on",
        "band",
        "grade",
        "how",
        "windows",
        "at_least",
        "longest_at_least",
        "at_most",
        "at_most_of_open",
        "report",
        "no_sun_left",
        "share",
        "or_area",
        "ratio",
        "of",
        "sunless_at_most",
        "sunless",
        "or_ratio",
        "no_worse_where_before_fails",
    ];

    pub(super) fn read(table: TableReader, how: CountHow) -> Result<Criterion, RuleError> {
        let demand = demand(&table)?;
        let extent = extent(&table)?;
        let band = table.count("band")?;
        let criterion = Criterion {
            on: table.text("on")?.unwrap_or_default().to_owned(),
            band: band.map(|band| band - 1),
            grade: table.text("grade")?.map(str::to_owned),
            how: table.word("how")?.unwrap_or(how),
            windows: WindowRule::read(&table)?,
            demand,
            extent,
            or_ratio: table.number("or_ratio", 0.0, 1.0)?,
            no_worse: table.flag("no_worse_where_before_fails")?,
        };
        criterion.check(&table)?;
        table.finish()?;
        Ok(criterion)
    }

    /// What does not go together.
    fn check(&self, table: &TableReader) -> Result<(), RuleError> {
        let is_time = matches!(self.demand, Demand::AtLeast { .. } | Demand::AtMost(_));
        let is_sunless = matches!(self.extent, Extent::Sunless { .. });
        let is_relative = self.or_ratio.is_some() || self.no_worse;
        if !is_time && (self.extent != Extent::Whole || is_relative || self.grade.is_some()) {
            return Err(table.wrong("", "a share, a ratio or a grade is of at_least or at_most"));
        }
        if self.grade.is_some() && !matches!(self.demand, Demand::AtLeast { .. }) {
            return Err(table.wrong("grade", "it goes with at_least alone"));
        }
        if is_sunless && self.demand != (Demand::AtLeast { secs: 1, longest_secs: 0 }) {
            return Err(table.wrong("sunless_at_most", "it stands alone: a dwelling has sun or has none"));
        }
        let is_of_open = matches!(self.demand, Demand::ShareOfOpen(_));
        if self.how == CountHow::AreaTime && is_time || is_of_open && self.how != CountHow::AreaTime {
            return Err(table.wrong("how", "\"area-time\" goes with at_most_of_open or report, and that with it"));
        }
        Ok(())
    }

    /// Whether it cannot be judged without the state before.
    pub fn needs_before(&self) -> bool {
        let reports_loss = matches!(self.demand, Demand::Report { no_sun_left_secs: Some(_) });
        self.or_ratio.is_some() || self.no_worse || reports_loss || matches!(self.extent, Extent::OfBefore(_))
    }

    /// Whether it is of a whole house and not of its parts.
    pub fn is_of_dwellings(&self) -> bool {
        matches!(self.extent, Extent::Dwellings(_) | Extent::Sunless { .. })
    }
}

fn demand(table: &TableReader) -> Result<Demand, RuleError> {
    let least = table.secs("at_least")?;
    let longest = table.secs("longest_at_least")?;
    let most = table.secs("at_most")?;
    let of_open = table.number("at_most_of_open", 0.0, 1.0)?;
    let report = table.flag("report")?;
    let no_sun_left_secs = table.secs("no_sun_left")?;
    let is_sunless = table.has("sunless_at_most");
    if longest.is_some() && least.is_none() {
        return Err(table.wrong("longest_at_least", "it goes with at_least"));
    }
    if no_sun_left_secs.is_some() && !report {
        return Err(table.wrong("no_sun_left", "it goes with report = true"));
    }
    match (least, most, of_open, report, is_sunless) {
        (Some(secs), None, None, false, false) => Ok(Demand::AtLeast { secs, longest_secs: longest.unwrap_or(0) }),
        (None, Some(secs), None, false, false) => Ok(Demand::AtMost(secs)),
        (None, None, Some(share), false, false) => Ok(Demand::ShareOfOpen(share)),
        (None, None, None, true, false) => Ok(Demand::Report { no_sun_left_secs }),
        (None, None, None, false, true) => Ok(Demand::AtLeast { secs: 1, longest_secs: 0 }),
        _ => Err(table.wrong("", "write one of at_least, at_most, at_most_of_open, sunless_at_most and report = true")),
    }
}

fn extent(table: &TableReader) -> Result<Extent, RuleError> {
    let share = table.number("share", 0.0, 1.0)?;
    let or_area_m2 = table.number("or_area", 0.0, 1e9)?;
    let ratio = table.number("ratio", 0.0, 1.0)?;
    let sunless = table.number("sunless_at_most", 0.0, 1.0)?;
    let counts: Option<SunlessWhen> = table.word("sunless")?;
    let of_dwellings = match table.text("of")? {
        None => false,
        Some("dwellings") => true,
        Some(other) => {
            return Err(
                table.wrong("of", format!("{other:?} is not \"dwellings\", all that a share can be of beside an area"))
            );
        }
    };
    match (share, or_area_m2, ratio, sunless, of_dwellings) {
        (None, None, None, None, false) => Ok(Extent::Whole),
        (Some(share), or_area_m2, None, None, false) => Ok(Extent::Part { share, or_area_m2 }),
        (None, None, Some(ratio), None, false) => Ok(Extent::OfBefore(ratio)),
        (Some(share), None, None, None, true) => Ok(Extent::Dwellings(share)),
        (None, None, None, Some(most), true) => {
            let counts = counts.ok_or_else(|| {
                table.wrong("sunless", "write which dwelling has none: \"one\" or \"all\" of its uses")
            })?;
            Ok(Extent::Sunless { most, counts })
        }
        _ => Err(table.wrong(
            "share",
            "write share, perhaps with or_area; or ratio; or of = \"dwellings\" with share or with sunless_at_most",
        )),
    }
}

/// What of a dwelling must keep the criteria.
#[derive(Clone, Debug, PartialEq)]
pub enum DwellingShare {
    /// So many rooms: the last line that begins at no more rooms than it has.
    Rooms(Vec<RoomsNeeded>),
    /// Rooms with this share of the habitable floor area, 0 to 1.
    FloorArea(f64),
}

/// How many rooms of a dwelling must keep the criteria.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RoomsNeeded {
    /// In dwellings with at least so many rooms.
    pub from: usize,
    /// So many.
    pub needed: usize,
}

impl DwellingShare {
    /// What [dwelling] may say.
    pub(super) const KEYS: &[&str] = &["rooms", "floor_area"];

    pub(super) fn read(table: TableReader) -> Result<DwellingShare, RuleError> {
        let rooms = table.value("rooms").map(|value| {
            let what = "write a number of rooms, or lines as [[1, 1], [4, 2]]: two rooms from four rooms on";
            rooms_needed(value).ok_or_else(|| table.wrong("rooms", what))
        });
        let share = match (rooms.transpose()?, table.number("floor_area", 0.0, 1.0)?) {
            (Some(rooms), None) => DwellingShare::Rooms(rooms),
            (None, Some(share)) => DwellingShare::FloorArea(share),
            _ => return Err(table.wrong("rooms", "write either rooms or floor_area")),
        };
        table.finish()?;
        Ok(share)
    }

    /// How many rooms are needed of so many.
    pub fn rooms_of(lines: &[RoomsNeeded], rooms: usize) -> usize {
        lines.iter().rev().find(|line| line.from <= rooms).map_or(0, |line| line.needed)
    }
}

fn rooms_needed(value: &toml::Value) -> Option<Vec<RoomsNeeded>> {
    let count = |value: &toml::Value| usize::try_from(value.as_integer()?).ok().filter(|count| *count > 0);
    if let Some(needed) = count(value) {
        return Some(vec![RoomsNeeded { from: 1, needed }]);
    }
    let line = |value: &toml::Value| {
        let [from, needed] = value.as_array()?.as_slice() else { return None };
        Some(RoomsNeeded { from: count(from)?, needed: count(needed)? })
    };
    let lines: Vec<RoomsNeeded> = value.as_array()?.iter().map(line).collect::<Option<_>>()?;
    let is_ordered = lines.windows(2).all(|two| two[0].from < two[1].from);
    (lines.first()?.from == 1 && is_ordered).then_some(lines)
}
