//! The days on which a rule counts, and how the verdicts of several days become one.

use super::error::RuleError;
use super::reader::TableReader;
use super::window::WindowRule;
use crate::choice::{nearest, words};
use crate::sun::{Place, Season, SunError};
use chrono::NaiveDate;

words!(Season, [
    "march-equinox" => Season::MarchEquinox,
    "june-solstice" => Season::JuneSolstice,
    "september-equinox" => Season::SeptemberEquinox,
    "december-solstice" => Season::DecemberSolstice,
    "great-cold" => Season::GreatCold,
]);

/// A day of every year.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DayName {
    /// A month and a day that every year has.
    MonthDay(u32, u32),
    /// The local date of an equinox, a solstice or another solar term.
    Season(Season),
}

/// A set of dates.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Dates {
    /// Single days, in this order.
    Named(Vec<DayName>),
    /// All days from the first to the second, both included. The range reaches over New Year if the first is later in
    /// the year.
    Range([DayName; 2]),
}

/// How the verdicts of several days become one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DayJudge {
    /// All days must pass, and each is reported.
    Each,
    /// All days must pass, and the worst is reported.
    Worst,
    /// One day must pass, and the best is reported.
    Best,
    /// What is counted is added up over the days.
    Sum,
}

words!(DayJudge, [
    "each" => DayJudge::Each,
    "worst" => DayJudge::Worst,
    "best" => DayJudge::Best,
    "sum" => DayJudge::Sum,
]);

/// A set of days with the same windows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DaySet {
    /// The name by which criteria refer to it; empty if none does.
    pub name: String,
    /// Its dates.
    pub dates: Dates,
    /// How the days' verdicts become one.
    pub judge: DayJudge,
    /// The windows of each day.
    pub windows: WindowRule,
}

impl DayName {
    /// Reads a date that every year has, such as `03-21`, or the name of a season's point, such as `march-equinox`.
    ///
    /// # Errors
    /// A message that says what can be written instead.
    pub fn parse(text: &str) -> Result<DayName, String> {
        if let Some((_, season)) = Season::WORDS.iter().find(|(word, _)| *word == text) {
            return Ok(DayName::Season(*season));
        }
        let two_digits = |part: &str| part.parse::<u32>().ok().filter(|_| part.len() == 2);
        let month_day = text.split_once('-').and_then(|(month, day)| Some((two_digits(month)?, two_digits(day)?)));
        // a year without 29 February
        if let Some((month, day)) =
            month_day.filter(|(month, day)| NaiveDate::from_ymd_opt(2001, *month, *day).is_some())
        {
            return Ok(DayName::MonthDay(month, day));
        }
        let nearest = nearest(text, Season::WORDS.iter().map(|(word, _)| *word)).unwrap_or_default();
        Err(format!(
            "{text:?} is not a day of every year; write month and day as \"03-21\", or for example \"{nearest}\""
        ))
    }

    /// Returns its date in a year at a place.
    ///
    /// # Errors
    /// A year outside 1600 to 2999.
    pub fn date(self, place: &Place, year: i32) -> Result<NaiveDate, SunError> {
        match self {
            DayName::MonthDay(month, day) => Ok(NaiveDate::from_ymd_opt(year, month, day).unwrap_or_default()),
            DayName::Season(season) => season.date(place, year),
        }
    }

    /// Its month and day; of a season's point, to within a day.
    pub(super) fn month_day(self) -> (u32, u32) {
        match self {
            DayName::MonthDay(month, day) => (month, day),
            DayName::Season(season) => season.about(),
        }
    }
}

impl Dates {
    /// Returns the dates of a year, in order. Those of a range over New Year reach into the next year.
    ///
    /// # Errors
    /// A year outside 1600 to 2999.
    pub fn of(&self, place: &Place, year: i32) -> Result<Vec<NaiveDate>, SunError> {
        match self {
            Dates::Named(names) => names.iter().map(|name| name.date(place, year)).collect(),
            Dates::Range([first, last]) => {
                let (first, mut end) = (first.date(place, year)?, last.date(place, year)?);
                if end < first {
                    end = last.date(place, year + 1)?;
                }
                Ok(first.iter_days().take_while(|date| *date <= end).collect())
            }
        }
    }
}

impl DaySet {
    /// The keys that `[[day]]` may have.
    pub(super) const KEYS: &[&str] = &["name", "days", "range", "judge", "windows"];

    pub(super) fn read(table: TableReader) -> Result<DaySet, RuleError> {
        let named = |key: &'static str| -> Result<Vec<DayName>, RuleError> {
            let read = |text| DayName::parse(text).map_err(|what| table.wrong(key, what));
            table.texts(key)?.into_iter().map(read).collect()
        };
        let (days, range) = (named("days")?, named("range")?);
        let dates = match (days.as_slice(), range.as_slice()) {
            ([_, ..], []) => Dates::Named(days),
            ([], [first, last]) => Dates::Range([*first, *last]),
            _ => {
                let what = "write days = [\"03-21\"], or range = [\"02-01\", \"03-21\"] with its first and last day";
                return Err(table.wrong("days", what));
            }
        };
        let judge = table.word("judge")?;
        if judge.is_none() && !matches!(&dates, Dates::Named(names) if names.len() == 1) {
            return Err(table.wrong("judge", "it is required with several days: each, worst, best or sum"));
        }
        let windows = WindowRule::read(&table)?.ok_or_else(|| table.wrong("windows", "it is required"))?;
        let name = table.text("name")?.unwrap_or_default().to_owned();
        table.finish()?;
        Ok(DaySet { name, dates, judge: judge.unwrap_or(DayJudge::Each), windows })
    }
}
