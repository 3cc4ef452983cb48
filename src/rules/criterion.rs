//! The criteria: what must hold for a rule to be kept.

use super::counting::CountHow;
use super::error::RuleError;
use super::reader::TableReader;
use super::window::WindowRule;
use crate::choice::words;

/// The limit of a criterion.
#[derive(Clone, Debug, PartialEq)]
pub enum Demand {
    /// A least time.
    AtLeast {
        /// The least time of what is counted, seconds.
        secs: i64,
        /// The least length of the longest spell, seconds; 0 if there is no such limit.
        longest_secs: i64,
    },
    /// The greatest time, seconds.
    AtMost(i64),
    /// The greatest share of the area times time that would be lit if nothing stood there.
    ShareOfOpen(f64),
    /// No limit: the number is reported.
    Report {
        /// The result marks when all sun is gone for longer than this, seconds.
        no_sun_left_secs: Option<i64>,
    },
}

/// What the limit applies to.
#[derive(Clone, Debug, PartialEq)]
pub enum Extent {
    /// The receiver as a whole; of an area, each of its points.
    Whole,
    /// A part of the area.
    Part {
        /// The share of the area, 0 to 1.
        share: f64,
        /// An area in m² that is enough, too, if it is less than the share.
        or_area_m2: Option<f64>,
    },
    /// This share of the area for which the limit was kept before the change.
    OfBefore(f64),
    /// This share of the dwellings, 0 to 1; a dwelling keeps the limit if each of the uses that the receiver names
    /// does.
    Dwellings(f64),
    /// The dwellings without any sun.
    Sunless {
        /// The greatest share of the dwellings, 0 to 1.
        most: f64,
        /// Which dwellings count as sunless.
        counts: SunlessWhen,
    },
}

/// When a dwelling of several uses counts as sunless.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SunlessWhen {
    /// If one of its uses has no sun.
    OneUse,
    /// If none of its uses has sun.
    AllUses,
}

words!(SunlessWhen, [
    "one" => SunlessWhen::OneUse,
    "all" => SunlessWhen::AllUses,
]);

/// One condition of a rule.
#[derive(Clone, Debug, PartialEq)]
pub struct Criterion {
    /// The name of the set of days to which it applies; empty for all days.
    pub on: String,
    /// The index of the band to which it applies, from 0.
    pub band: Option<usize>,
    /// Its grade, if the rule has grades.
    pub grade: Option<String>,
    /// How spells are counted for it.
    pub how: CountHow,
    /// Its own windows, if they differ from the day's.
    pub windows: Option<WindowRule>,
    /// The limit.
    pub demand: Demand,
    /// What the limit applies to.
    pub extent: Extent,
    /// The criterion is also kept if the number is at least this share of the number before.
    pub or_ratio: Option<f64>,
    /// The criterion is also kept if it was missed before, too, and the number has not become smaller.
    pub no_worse: bool,
}

impl Criterion {
    /// The keys that `[[pass]]` and `[[any]]` may have.
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

    /// Refuses keys that contradict each other.
    fn check(&self, table: &TableReader) -> Result<(), RuleError> {
        let is_time = matches!(self.demand, Demand::AtLeast { .. } | Demand::AtMost(_));
        let is_sunless = matches!(self.extent, Extent::Sunless { .. });
        let is_relative = self.or_ratio.is_some() || self.no_worse;
        if !is_time && (self.extent != Extent::Whole || is_relative || self.grade.is_some()) {
            return Err(table.wrong("", "a share, a ratio or a grade is allowed only with at_least or at_most"));
        }
        if self.grade.is_some() && !matches!(self.demand, Demand::AtLeast { .. }) {
            return Err(table.wrong("grade", "it is allowed only with at_least"));
        }
        if is_sunless && self.demand != (Demand::AtLeast { secs: 1, longest_secs: 0 }) {
            return Err(
                table.wrong("sunless_at_most", "no limit of time can stand beside it: a dwelling has sun or has none")
            );
        }
        let is_of_open = matches!(self.demand, Demand::ShareOfOpen(_));
        if self.how == CountHow::AreaTime && is_time || is_of_open && self.how != CountHow::AreaTime {
            return Err(table.wrong(
                "how",
                "\"area-time\" needs at_most_of_open or report, and at_most_of_open needs \"area-time\"",
            ));
        }
        Ok(())
    }

    /// Whether judging it needs the state before the change.
    pub fn needs_before(&self) -> bool {
        let reports_loss = matches!(self.demand, Demand::Report { no_sun_left_secs: Some(_) });
        self.or_ratio.is_some() || self.no_worse || reports_loss || matches!(self.extent, Extent::OfBefore(_))
    }

    /// Whether it applies to a building's dwellings as a whole, and not to single receivers.
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
        return Err(table.wrong("longest_at_least", "it is allowed only with at_least"));
    }
    if no_sun_left_secs.is_some() && !report {
        return Err(table.wrong("no_sun_left", "it is allowed only with report = true"));
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
            return Err(table.wrong(
                "of",
                format!("{other:?} cannot be read; write \"dwellings\", or leave it out for a share of an area"),
            ));
        }
    };
    match (share, or_area_m2, ratio, sunless, of_dwellings) {
        (None, None, None, None, false) => Ok(Extent::Whole),
        (Some(share), or_area_m2, None, None, false) => Ok(Extent::Part { share, or_area_m2 }),
        (None, None, Some(ratio), None, false) => Ok(Extent::OfBefore(ratio)),
        (Some(share), None, None, None, true) => Ok(Extent::Dwellings(share)),
        (None, None, None, Some(most), true) => {
            let counts = counts.ok_or_else(|| {
                table.wrong(
                    "sunless",
                    "it is required: a dwelling has no sun if \"one\" or \"all\" of its uses have none",
                )
            })?;
            Ok(Extent::Sunless { most, counts })
        }
        _ => Err(table.wrong(
            "share",
            "write share, perhaps with or_area; or ratio; or of = \"dwellings\" with share or with sunless_at_most",
        )),
    }
}

/// The part of a dwelling that must keep the criteria.
#[derive(Clone, Debug, PartialEq)]
pub enum DwellingShare {
    /// A number of rooms, by the dwelling's size: the last line whose `from` is not above the dwelling's rooms applies.
    Rooms(Vec<RoomsNeeded>),
    /// Rooms with this share of the habitable floor area, 0 to 1.
    FloorArea(f64),
}

/// How many rooms must keep the criteria in dwellings of a size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RoomsNeeded {
    /// The number of rooms from which the line applies.
    pub from: usize,
    /// The number of rooms that must keep the criteria.
    pub needed: usize,
}

impl DwellingShare {
    /// The keys that `[dwelling]` may have.
    pub(super) const KEYS: &[&str] = &["rooms", "floor_area"];

    pub(super) fn read(table: TableReader) -> Result<DwellingShare, RuleError> {
        let rooms = table.value("rooms").map(|value| {
            let what = "write a number of rooms, or lines as [[1, 1], [4, 2]]: two rooms in dwellings of four or more";
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

    /// Returns how many of a dwelling's rooms must keep the criteria.
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
