//! A rule whose options are all set, and its days in a year at a place.

use super::clock::ClockRule;
use super::counting::{CountHow, CountedTime, Counting};
use super::criterion::{Criterion, Demand, DwellingShare, Extent};
use super::cuts::SunCuts;
use super::days::{DayJudge, DaySet};
use super::error::RuleError;
use super::options::OptionValue;
use super::reader::TableReader;
use super::receiver::RuleReceiver;
use super::spell::Spell;
use crate::choice::words;
use crate::sun::{Place, SunError};
use chrono::NaiveDate;
use toml::Table;

/// What the site is compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CompareWith {
    /// The state before the change.
    Before,
    /// A body that the law allows: shadow that it would also cast is excused.
    Reference,
}

words!(CompareWith, [
    "before" => CompareWith::Before,
    "reference" => CompareWith::Reference,
]);

/// A rule whose options are all set.
#[derive(Clone, Debug, PartialEq)]
pub struct ResolvedRule {
    /// The rule's id.
    pub id: String,
    /// The options' values, by name.
    pub chosen: Vec<(String, OptionValue)>,
    /// The clock that its windows are written in.
    pub clock: ClockRule,
    /// The days on which it counts.
    pub days: Vec<DaySet>,
    /// Which sun counts.
    pub cuts: SunCuts,
    /// What is judged.
    pub receiver: RuleReceiver,
    /// How spells are counted.
    pub counting: Counting,
    /// What the site is compared with.
    pub compare: Option<CompareWith>,
    /// The criteria.
    pub criteria: Vec<Criterion>,
    /// Whether one of the criteria is enough; otherwise, all must hold.
    pub any: bool,
    /// The part of a dwelling that must keep the criteria, if the rule is about dwellings.
    pub dwelling: Option<DwellingShare>,
}

/// One day of a rule.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RuleDay {
    /// The local date.
    pub date: NaiveDate,
    /// The index of the set of days that it belongs to.
    pub set: usize,
    /// The windows in which the sun counts.
    pub windows: Vec<Spell>,
    /// The windows of each criterion; `None` for those that do not apply on this day.
    pub criteria: Vec<Option<Vec<Spell>>>,
}

impl ResolvedRule {
    /// The tables of a rule besides `[rule]` and `[options]`.
    const KEYS: &[&str] = &["clock", "day", "sun", "receiver", "count", "compare", "pass", "any", "dwelling"];

    pub(super) fn read(id: &str, table: &Table, chosen: Vec<(String, OptionValue)>) -> Result<ResolvedRule, RuleError> {
        let root = TableReader::new(id, "", table, Self::KEYS)?;
        let must =
            |key: &'static str, keys| root.table(key, keys)?.ok_or_else(|| root.wrong(key, "the table is required"));
        let clock = ClockRule::read(must("clock", ClockRule::KEYS)?)?;
        let days = root.tables("day", DaySet::KEYS)?.into_iter().map(DaySet::read).collect::<Result<Vec<_>, _>>()?;
        let cuts = root.table("sun", SunCuts::KEYS)?.map_or_else(|| Ok(SunCuts::default()), SunCuts::read)?;
        let receiver = RuleReceiver::read(must("receiver", RuleReceiver::KEYS)?)?;
        let counting = Counting::read(must("count", Counting::KEYS)?)?;
        let compare = root.table("compare", COMPARE_KEYS)?.map(comparison).transpose()?;
        let read = |table| Criterion::read(table, counting.how);
        let all = root.tables("pass", Criterion::KEYS)?.into_iter().map(read).collect::<Result<Vec<_>, _>>()?;
        let any = root.tables("any", Criterion::KEYS)?.into_iter().map(read).collect::<Result<Vec<_>, _>>()?;
        let dwelling = root.table("dwelling", DwellingShare::KEYS)?.map(DwellingShare::read).transpose()?;
        let is_any = !any.is_empty();
        if is_any != all.is_empty() {
            let what = "write [[pass]] for criteria that must all hold, or [[any]] if one of them is enough";
            return Err(root.wrong("pass", what));
        }
        if days.is_empty() {
            return Err(root.wrong("day", "at least one [[day]] is required"));
        }
        let criteria = if is_any { any } else { all };
        let rule = ResolvedRule {
            id: id.to_owned(),
            chosen,
            clock,
            days,
            cuts,
            receiver,
            counting,
            compare,
            criteria,
            any: is_any,
            dwelling,
        };
        rule.check(&root)?;
        root.finish()?;
        Ok(rule)
    }

    /// Refuses tables that contradict each other.
    fn check(&self, root: &TableReader) -> Result<(), RuleError> {
        let has_before = self.compare == Some(CompareWith::Before);
        let needs_before =
            self.counting.what == CountedTime::NewShadow || self.criteria.iter().any(Criterion::needs_before);
        if needs_before && !has_before {
            return Err(root.wrong("compare", "comparing with the state before needs [compare] with = \"before\""));
        }
        let bands = if let RuleReceiver::Lines { bands, .. } = &self.receiver { bands.len() } else { 0 };
        for criterion in &self.criteria {
            let is_day = criterion.on.is_empty() || self.days.iter().any(|set| set.name == criterion.on);
            if !is_day {
                return Err(root.wrong("pass", format!("on = {:?} is not the name of a [[day]]", criterion.on)));
            }
            if criterion.band.map_or(bands > 0, |band| band >= bands) {
                return Err(root.wrong(
                    "pass",
                    format!("there are {bands} bands, and each criterion needs `band`, the number of one"),
                ));
            }
            let is_of_area = matches!(criterion.extent, Extent::Part { .. } | Extent::OfBefore(_));
            if is_of_area && !matches!(self.receiver, RuleReceiver::Area { .. }) {
                return Err(root.wrong("pass", "a share or ratio of an area needs [receiver] kind = \"area\""));
            }
            if criterion.is_of_dwellings()
                && !matches!(&self.receiver, RuleReceiver::Window { all_of, .. } if !all_of.is_empty())
            {
                return Err(root.wrong("pass", "a share of dwellings needs [receiver] kind = \"window\" with all_of"));
            }
        }
        self.check_sum(root)?;
        self.check_grades(root)
    }

    /// Refuses to add up areas over days: a share of an area belongs to one day.
    fn check_sum(&self, root: &TableReader) -> Result<(), RuleError> {
        let is_sum = self.days.iter().any(|set| set.judge == DayJudge::Sum);
        let is_area_time = self.criteria.iter().any(|criterion| criterion.how == CountHow::AreaTime);
        let has_share = self.criteria.iter().any(|criterion| criterion.extent != Extent::Whole);
        if is_sum && has_share {
            return Err(root.wrong(
                "day",
                "judge = \"sum\" adds up time; a share of an area belongs to one day, and cannot be added up",
            ));
        }
        if is_area_time && !(is_sum && self.counting.what == CountedTime::NewShadow) {
            return Err(root.wrong("count", "area-time needs what = \"new-shadow\" and judge = \"sum\""));
        }
        Ok(())
    }

    /// Refuses grades that are not a complete ladder.
    fn check_grades(&self, root: &TableReader) -> Result<(), RuleError> {
        let graded = self.criteria.iter().filter(|criterion| criterion.grade.is_some()).count();
        let secs = |criterion: &Criterion| match criterion.demand {
            Demand::AtLeast { secs, .. } => secs,
            _ => 0,
        };
        let rises = self.criteria.windows(2).all(|two| secs(&two[0]) < secs(&two[1]));
        if graded > 0 && (graded < self.criteria.len() || !rises || self.any) {
            return Err(root.wrong("pass", "give each [[pass]] a grade, the lowest first, or none"));
        }
        Ok(())
    }

    /// Returns its days in a year at a place, set by set. A range over New Year reaches into the next year.
    ///
    /// # Errors
    /// A year outside 1600 to 2999, a time that the clock skips or repeats, or a window bound to a sunrise on a day on
    /// which the sun is up throughout.
    pub fn calendar(&self, place: &Place, year: i32) -> Result<Vec<RuleDay>, SunError> {
        let mut days = Vec::new();
        for (set, of) in self.days.iter().enumerate() {
            for date in of.dates.of(place, year)? {
                days.push(self.day(place, set, date)?);
            }
        }
        Ok(days)
    }

    fn day(&self, place: &Place, set: usize, date: NaiveDate) -> Result<RuleDay, SunError> {
        let of = &self.days[set];
        let windows = of.windows.on(place, date, self.clock)?;
        let own = |criterion: &Criterion| {
            if !criterion.on.is_empty() && criterion.on != of.name {
                return Ok(None);
            }
            let own = criterion.windows.as_ref().map(|own| own.on(place, date, self.clock));
            own.unwrap_or_else(|| Ok(windows.clone())).map(Some)
        };
        let criteria = self.criteria.iter().map(own).collect::<Result<_, SunError>>()?;
        Ok(RuleDay { date, set, windows, criteria })
    }

    /// Whether it has no limits: all criteria report, and none can fail.
    pub fn is_report(&self) -> bool {
        self.criteria.iter().all(|criterion| matches!(criterion.demand, Demand::Report { .. }))
    }
}

/// The keys that `[compare]` may have.
pub(super) const COMPARE_KEYS: &[&str] = &["with"];

fn comparison(table: TableReader) -> Result<CompareWith, RuleError> {
    let with = table.word("with")?.ok_or_else(|| table.wrong("with", "it is required"))?;
    table.finish()?;
    Ok(with)
}
