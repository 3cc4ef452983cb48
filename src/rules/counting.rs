//! How spells are counted.

use super::error::RuleError;
use super::reader::TableReader;
use super::spell::{Spell, common, merged};
use crate::choice::words;

/// What a rule counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CountedTime {
    /// Time in the sun.
    Sun,
    /// Time in shadow.
    Shadow,
    /// Time in shadow that was time in the sun before the change.
    NewShadow,
}

words!(CountedTime, [
    "sun" => CountedTime::Sun,
    "shadow" => CountedTime::Shadow,
    "new-shadow" => CountedTime::NewShadow,
]);

/// How spells become a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CountHow {
    /// The sum of all spells.
    Total,
    /// The longest spell alone.
    Longest,
    /// The sum of the two longest spells.
    TwoLongest,
    /// The number of test times within spells, times the step: as read off hourly shadow drawings.
    Instants,
    /// Area times time, as in square-foot-hours.
    AreaTime,
}

words!(CountHow, [
    "total" => CountHow::Total,
    "longest" => CountHow::Longest,
    "two-longest" => CountHow::TwoLongest,
    "instants" => CountHow::Instants,
    "area-time" => CountHow::AreaTime,
]);

/// The unit in which areas times time are printed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AreaUnit {
    /// Square metres.
    #[default]
    SquareMetres,
    /// Square feet, of 0.3048 m each way.
    SquareFeet,
}

words!(AreaUnit, [
    "m2" => AreaUnit::SquareMetres,
    "ft2" => AreaUnit::SquareFeet,
]);

/// Short gaps that do not break a spell in two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bridge {
    /// The longest gap that is bridged, seconds.
    pub gap_secs: i64,
    /// Whether the gap itself counts as time in the spell.
    pub counts: bool,
}

/// How a list of spells becomes the number that is compared with a limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counting {
    /// What is counted.
    pub what: CountedTime,
    /// How it is counted, unless a criterion has a `how` of its own.
    pub how: CountHow,
    /// The length from which a spell counts, seconds.
    pub shortest_secs: i64,
    /// The gaps that are bridged; `None` if every gap breaks a spell.
    pub bridge: Option<Bridge>,
    /// The seconds between the test times of [`CountHow::Instants`]; 0 with the others.
    pub step_secs: i64,
    /// The unit in which areas times time are printed.
    pub unit: AreaUnit,
}

/// Spells with the bridged gaps between them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Run {
    /// From the first spell's beginning to the last one's end.
    pub spell: Spell,
    /// The seconds of it that count.
    pub secs: i64,
}

/// The result of counting.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SpellCount {
    /// The number that is compared with the limit, seconds.
    pub secs: i64,
    /// The longest spell, seconds.
    pub longest_secs: i64,
}

impl Counting {
    /// The keys that `[count]` may have.
    pub(super) const KEYS: &[&str] = &["what", "how", "shortest", "bridge", "bridge_counts", "step", "unit"];

    pub(super) fn read(table: TableReader) -> Result<Counting, RuleError> {
        let must = |key: &'static str| table.wrong(key, "it is required");
        let bridge = table.secs("bridge")?;
        let counts = table.flag("bridge_counts")?;
        let how = table.word("how")?.ok_or_else(|| must("how"))?;
        let step_secs = table.secs("step")?;
        let unit = table.word("unit")?;
        let counting = Counting {
            what: table.word("what")?.ok_or_else(|| must("what"))?,
            how,
            shortest_secs: table.secs("shortest")?.unwrap_or(0),
            bridge: bridge.map(|gap_secs| Bridge { gap_secs, counts }),
            step_secs: step_secs.unwrap_or(0),
            unit: unit.unwrap_or_default(),
        };
        if unit.is_some() && how != CountHow::AreaTime {
            return Err(table.wrong("unit", "it is allowed only with how = \"area-time\""));
        }
        if counts && bridge.is_none() {
            return Err(table.wrong(
                "bridge_counts",
                "it is allowed only with `bridge`, the longest gap that does not break a spell",
            ));
        }
        if (how == CountHow::Instants) != (counting.step_secs > 0) {
            return Err(
                table.wrong("step", "it is allowed only with how = \"instants\", which requires a step of at least 1s")
            );
        }
        table.finish()?;
        Ok(counting)
    }

    /// Returns the spells within the windows as they count: bridged over short gaps, and without those that are too
    /// short.
    pub fn runs(&self, spells: &[Spell], windows: &[Spell]) -> Vec<Run> {
        let mut runs: Vec<Run> = Vec::new();
        for spell in common(spells, windows) {
            match (runs.last_mut(), self.bridge) {
                (Some(run), Some(bridge)) if spell.start - run.spell.end <= bridge.gap_secs => {
                    let gap = if bridge.counts { spell.start - run.spell.end } else { 0 };
                    run.secs += gap + spell.secs();
                    run.spell.end = spell.end;
                }
                _ => runs.push(Run { spell, secs: spell.secs() }),
            }
        }
        runs.retain(|run| run.secs >= self.shortest_secs);
        runs
    }

    /// Returns the number that a criterion compares with its limit.
    pub fn tally(&self, how: CountHow, spells: &[Spell], windows: &[Spell]) -> SpellCount {
        let runs = self.runs(spells, windows);
        let mut lengths: Vec<i64> = runs.iter().map(|run| run.secs).collect();
        lengths.sort_unstable_by_key(|secs| -secs);
        let of_longest = |most: usize| lengths.iter().take(most).sum();
        let secs = match how {
            // areas are summed elsewhere (`judge_load`)
            CountHow::Total | CountHow::AreaTime => of_longest(usize::MAX),
            CountHow::Longest => of_longest(1),
            CountHow::TwoLongest => of_longest(2),
            CountHow::Instants => self.step_secs * self.instants(&runs, windows),
        };
        SpellCount { secs, longest_secs: of_longest(1) }
    }

    /// The number of test times that lie in a run. They start at each window's beginning; its end is included.
    fn instants(&self, runs: &[Run], windows: &[Spell]) -> i64 {
        let step = self.step_secs.max(1);
        let mut count = 0;
        for window in merged(windows.iter().copied()) {
            // a spell excludes its end, but a run up to the window's end includes the test time there
            let in_run = |time: i64| {
                let holds = |run: &Run| run.spell.start <= time && (time < run.spell.end || time == window.end);
                runs.iter().any(|run| holds(run) && time <= run.spell.end)
            };
            let mut time = window.start;
            while time <= window.end {
                count += i64::from(in_run(time));
                time += step;
            }
        }
        count
    }
}
