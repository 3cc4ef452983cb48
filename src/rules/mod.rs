//! What authorities require of sunlight, as data: on which days, by which clock and in which windows the sun counts,
//! how it is counted, and what must hold.
//!
//! A [`Rule`] is read from TOML. [`Rule::resolve`] sets its options, [`ResolvedRule::calendar`] returns its days and
//! windows at a place, and [`DaySun`] the spells in which the sun counts. Other modules find the spells and the lit
//! areas; the functions `judge_…` turn them into a verdict with its margin. `docs/rules` has a page for each built-in
//! rule.

mod clock;
mod counting;
mod criterion;
mod cuts;
mod day_sun;
mod days;
mod error;
mod given_hours;
mod judge_area;
mod judge_group;
mod judge_time;
mod keys;
mod library;
mod options;
mod reader;
mod receiver;
mod resolved;
mod rule;
mod spell;
mod verdict;
mod weigh;
mod window;

pub use clock::{ClockRule, RuleClock};
pub use counting::{AreaUnit, Bridge, CountHow, CountedTime, Counting, Run, SpellCount};
pub use criterion::{Criterion, Demand, DwellingShare, Extent, RoomsNeeded, SunlessWhen};
pub use cuts::{GrazingIn, SunCuts};
pub use day_sun::DaySun;
pub use days::{Dates, DayJudge, DayName, DaySet};
pub use error::{RuleError, RuleNeed};
pub use given_hours::{KEEP_HOURS, SunDemand};
pub use judge_area::{AreaLight, PartMet, ShadowLoad};
pub use judge_group::{DwellingRuling, DwellingSun, RoomRuling};
pub use judge_time::DayLight;
pub use keys::RULE_KEYS;
pub use library::{BUILT_IN, KnownRule, built_in_rules, built_in_text, rule_for_site, rules_for_site};
pub use options::{OptionType, OptionValue, RuleOption, duration_text};
pub use receiver::{Band, CornerRule, DeemedBoundary, Grouping, HeightOver, OpenSpaces, RuleReceiver, WindowPoint};
pub use resolved::{CompareWith, ResolvedRule, RuleDay};
pub use rule::{Confidence, Rule, RuleKind, RuleSource};
pub use spell::{Spell, common, merged, total_secs, without};
pub use verdict::{Excuse, Finding, Quantity, Ruling, Verdict};
pub use window::{WindowEdge, WindowRule};
