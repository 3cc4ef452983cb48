//! Hours of sun that are given without an authority's rule.

use super::clock::{ClockRule, RuleClock};
use super::counting::{AreaUnit, CountHow, CountedTime, Counting};
use super::criterion::{Criterion, Demand, Extent};
use super::cuts::SunCuts;
use super::receiver::{RuleReceiver, WindowPoint};
use super::resolved::{ResolvedRule, RuleDay};
use super::rule::RuleSource;
use super::spell::Spell;
use crate::sun::{DayWindow, Sunrise};

/// The point of a window that must keep given hours: the middle of the window, in the wall's outer plane.
const WINDOW: RuleReceiver = RuleReceiver::Window {
    at: WindowPoint::MiddleOutside,
    floor_m: 0.0,
    sill_m: 0.0,
    group: None,
    all_of: Vec::new(),
    open_spaces: None,
};

/// What keeps given hours, in the order in which it is searched.
pub const KEEP_HOURS: [RuleReceiver; 3] = [WINDOW, RuleReceiver::Facade, RuleReceiver::Area { least_width_m: 0.0 }];

/// What must keep its sun.
#[derive(Clone, Copy, Debug)]
pub enum SunDemand<'a> {
    /// What a rule protects, as much as it says.
    Rule(&'a RuleSource, &'a ResolvedRule),
    /// Everything that a site names, so many seconds on each of these days.
    Hours(i64, &'a [DayWindow]),
}

impl ResolvedRule {
    /// So much sun in all on each of the given days, wherever the sun is above the horizon. The days are given with
    /// [`RuleDay::of_hours`].
    pub fn of_hours(receiver: RuleReceiver, secs: i64) -> ResolvedRule {
        ResolvedRule {
            id: "given-hours".to_owned(),
            chosen: Vec::new(),
            clock: ClockRule { clock: RuleClock::Legal, sunrise: Sunrise::Almanac },
            days: Vec::new(),
            cuts: SunCuts::default(),
            receiver,
            counting: Counting {
                what: CountedTime::Sun,
                how: CountHow::Total,
                shortest_secs: 0,
                bridge: None,
                step_secs: 0,
                unit: AreaUnit::default(),
            },
            compare: None,
            criteria: vec![Criterion {
                on: String::new(),
                band: None,
                grade: None,
                how: CountHow::Total,
                windows: None,
                demand: Demand::AtLeast { secs, longest_secs: 0 },
                extent: Extent::Whole,
                or_ratio: None,
                no_worse: false,
            }],
            any: false,
            dwelling: None,
        }
    }
}

impl RuleDay {
    /// A day of a study on which given hours are kept.
    pub fn of_hours(day: &DayWindow) -> RuleDay {
        let spell = Spell::new(day.from.timestamp(), day.to.timestamp());
        let windows = if spell.start < spell.end { vec![spell] } else { Vec::new() };
        RuleDay { date: day.day.date, set: 0, criteria: vec![Some(windows.clone())], windows }
    }
}
