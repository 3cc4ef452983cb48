//! Every key that a rule may have, by table.

use super::clock::ClockRule;
use super::counting::Counting;
use super::criterion::{Criterion, DwellingShare};
use super::cuts::SunCuts;
use super::days::DaySet;
use super::options::RuleOption;
use super::receiver::RuleReceiver;
use super::resolved::COMPARE_KEYS;
use super::rule::SOURCE_KEYS;

/// The tables as their headings are written, with the keys of each. A table in a list may have `when` besides.
pub const RULE_KEYS: &[(&str, &[&str])] = &[
    ("[rule]", SOURCE_KEYS),
    ("[options.NAME]", RuleOption::KEYS),
    ("[clock]", ClockRule::KEYS),
    ("[[day]]", DaySet::KEYS),
    ("[sun]", SunCuts::KEYS),
    ("[receiver]", RuleReceiver::KEYS),
    ("[count]", Counting::KEYS),
    ("[compare]", COMPARE_KEYS),
    ("[[pass]]", Criterion::KEYS),
    ("[dwelling]", DwellingShare::KEYS),
];
