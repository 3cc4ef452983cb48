//! How spells are counted.

use super::error::RuleError;
use super::reader::TableReader;
use super::spell::{Spell, common, merged};
use crate::choice::words;

/// What is counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Counted {
    /// Time in the sun.
    Sun,
    /// Time in shadow.
    Shadow,
    /// Time in shadow that was in the sun before.
    NewShadow,
}

words!(Counted, [
    "sun" => Counted::Sun,
    "shadow" => Counted::Shadow,
    "new-shadow" => Counted::NewShadow,
]);

/// How it is counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CountHow {
    /// All spells.
    Total,
    /// The longest spell.
    Longest,
    /// The two longest spells.
    TwoLongest,
    /// The test times that lie in a spell, each for one step, as on drawings of every hour.
    Instants,
    /// Area times time.
    AreaTime,
}

words!(CountHow, [
    "total" => CountHow::Total,
    "longest" => CountHow::Longest,
    "two-longest" => CountHow::TwoLongest,
    "instants" => CountHow::Instants,
    "area-time" => CountHow::AreaTime,
]);

/// Gaps that do not break a spell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bridge {
    /// The longest of them, seconds.
    pub gap_secs: i64,
    /// Whether the gap counts as if it were no gap.
    pub counts: bool,
}

/// The way from spells to a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counting {
    /// What is counted.
    pub what: Counted,
    /// How, where a criterion does not say it otherwise.
    pub how: CountHow,
    /// Shorter spells do not count, seconds.
    pub shortest_secs: i64,
    /// Gaps that do not break a spell.
    pub bridge: Option<Bridge>,
    /// Seconds between the test times of [`CountHow::Instants`]; 0 with the others.
    pub step_secs: i64,
}

/// Spells that count as one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Run {
    /// From its first second to its end.
    pub spell: Spell,
    /// What of it counts, seconds.
    pub secs: i64,
}

/// What counting came to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SpellCount {
    /// The number that is compared with the limit, seconds.
    pub secs: i64,
    /// The longest spell, seconds.
    pub longest_secs: i64,
}

impl Counting {
    /// What [count] may say.
    pub(super) const KEYS: &[&str] = &["what", "how", "shortest", "bridge", "bridge_counts", "step"];

    pub(super) fn read(table: TableReader) -> Result<Counting, RuleError> {
        let must = |key: &'static str| table.wrong(key, "it must be written");
        let bridge = table.secs("bridge")?;
        let counts = table.flag("bridge_counts")?;
        let how = table.word("how")?.ok_or_else(|| must("how"))?;
        let step_secs = table.secs("step")?;
        let counting = Counting {
            what: table.word("what")?.ok_or_else(|| must("what"))?,
            how,
            shortest_secs: table.secs("shortest")?.unwrap_or(0),
            bridge: bridge.map(|gap_secs| Bridge { gap_secs, counts }),
            step_secs: step_secs.unwrap_or(0),
        };
        if counts && bridge.is_none() {
            return Err(table.wrong("bridge_counts", "it needs `bridge`, the longest gap that does not break a spell"));
        }
        if (how == CountHow::Instants) != (counting.step_secs > 0) {
            return Err(table.wrong("step", "it goes with how = \"instants\", and that with a step of at least 1s"));
        }
        table.finish()?;
        Ok(counting)
    }

    /// The spells as they count within windows: those with short gaps as one, and without those that are too short.
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

    /// The number that a criterion compares, of spells within windows.
    pub fn tally(&self, how: CountHow, spells: &[Spell], windows: &[Spell]) -> SpellCount {
        let runs = self.runs(spells, windows);
        let mut lengths: Vec<i64> = runs.iter().map(|run| run.secs).collect();
        lengths.sort_unstable_by_key(|secs| -secs);
        let of_longest = |most: usize| lengths.iter().take(most).sum();
        let secs = match how {
            // area is another's to know
            CountHow::Total | CountHow::AreaTime => of_longest(usize::MAX),
            CountHow::Longest => of_longest(1),
            CountHow::TwoLongest => of_longest(2),
            CountHow::Instants => self.step_secs * self.instants(&runs, windows),
        };
        SpellCount { secs, longest_secs: of_longest(1) }
    }

    /// How many test times lie in a run: from each window's beginning on, its end included.
    fn instants(&self, runs: &[Run], windows: &[Spell]) -> i64 {
        let step = self.step_secs.max(1);
        let mut count = 0;
        for window in merged(windows.iter().copied()) {
            // spells have no last second, so a run up to the window's end has its last test time, too
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
