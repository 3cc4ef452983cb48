//! How much sun must stay by a rule, for the rules that say it as a time.

use super::super::StudyError;
use super::super::envelope::{DaysNeeded, KeptPlace, SunNeeded};
use crate::judgement::{LitSpell, spells_of};
use crate::rules::{
    CountHow, CountedTime, Criterion, DayJudge, Demand, Extent, ResolvedRule, RuleDay, Spell, common, total_secs,
};

/// The criteria of a rule that say how much sun must stay, at most one of them on a day.
pub(super) struct RuleDemand {
    criteria: Vec<usize>,
}

fn refused(rule: &ResolvedRule, why: &str) -> StudyError {
    StudyError::NoEnvelope { rule: rule.id.clone(), why: why.to_owned() }
}

/// Whether the sun must stay on all days or on one of them.
pub(super) fn days_needed(rule: &ResolvedRule) -> Result<DaysNeeded, StudyError> {
    let is = |judge: DayJudge| rule.days.iter().filter(|set| set.judge == judge).count();
    match (is(DayJudge::Sum), is(DayJudge::Best)) {
        (0, 0) => Ok(DaysNeeded::Each),
        (0, 1) if rule.days.len() == 1 => Ok(DaysNeeded::One),
        (0, _) => Err(refused(rule, "it has several sets of days of which one is enough")),
        _ => Err(refused(rule, "it adds time up over days")),
    }
}

impl RuleDemand {
    /// The demands for a band around a plot, or for other receivers. Of several grades the lowest is taken, and of
    /// several limits of which one is enough the first.
    pub(super) fn of(rule: &ResolvedRule, band: Option<usize>) -> Result<RuleDemand, StudyError> {
        let is_time = |criterion: &Criterion| {
            matches!(criterion.demand, Demand::AtLeast { .. } | Demand::AtMost(_))
                && !matches!(criterion.extent, Extent::Sunless { .. })
        };
        let of_band = rule.criteria.iter().enumerate().filter(|(_, criterion)| criterion.band == band);
        let mut criteria: Vec<usize> =
            of_band.filter(|(_, criterion)| is_time(criterion)).map(|(number, _)| number).collect();
        let is_graded = rule.criteria.iter().any(|criterion| criterion.grade.is_some());
        if is_graded || rule.any {
            criteria.truncate(1);
        }
        match (rule.counting.what, criteria.is_empty()) {
            (_, true) => Err(refused(rule, "it has no limit of time")),
            (CountedTime::NewShadow, _) => Err(refused(rule, "it counts new shadow, and not the sun that stays")),
            _ => Ok(RuleDemand { criteria }),
        }
    }

    /// The criterion that a share of an area belongs to.
    fn first<'r>(&self, rule: &'r ResolvedRule) -> Option<&'r Criterion> {
        self.criteria.first().map(|number| &rule.criteria[*number])
    }

    /// What must stay on a day, given the sun with nothing in its way and the sun that there is.
    pub(super) fn on(
        &self,
        rule: &ResolvedRule,
        day: &RuleDay,
        open: &[Spell],
        lit: &[LitSpell],
    ) -> Result<SunNeeded, StudyError> {
        let of_day = self.criteria.iter().filter_map(|number| Some((*number, day.criteria[*number].as_ref()?)));
        let of_day: Vec<_> = of_day.collect();
        let [(number, windows)] = of_day.as_slice() else {
            return match of_day.is_empty() {
                true => Ok(SunNeeded::default()),
                false => Err(refused(rule, "it has several limits on one day")),
            };
        };
        let criterion = &rule.criteria[*number];
        let lit = common(&spells_of(lit), windows);
        let at_once = match criterion.how {
            CountHow::Total => rule.counting.shortest_secs > 0,
            CountHow::Longest => true,
            CountHow::TwoLongest => return Err(refused(rule, "it counts the two longest spells")),
            CountHow::Instants | CountHow::AreaTime => return Err(refused(rule, "it counts no spells of sun")),
        };
        match (&criterion.demand, rule.counting.what) {
            (Demand::AtLeast { secs, longest_secs: 0 }, CountedTime::Sun) => {
                let secs = if at_once { (*secs).max(rule.counting.shortest_secs) } else { *secs };
                Ok(SunNeeded { lit, secs, at_once })
            }
            (Demand::AtLeast { .. }, CountedTime::Sun) => {
                Err(refused(rule, "it asks for a total and for one long spell"))
            }
            // shadow that is too short to count could be allowed in addition, but is not
            (Demand::AtMost(secs), CountedTime::Shadow) if criterion.how == CountHow::Total => {
                let all = total_secs(&common(open, windows));
                Ok(SunNeeded { lit, secs: (all - secs).max(0), at_once: false })
            }
            _ => Err(refused(rule, "it limits the sun, or the longest shadow")),
        }
    }
}

/// The part of an area that must keep its sun, square metres.
pub(super) fn needed_weight(rule: &ResolvedRule, demand: &RuleDemand, places: &[KeptPlace], days: DaysNeeded) -> f64 {
    let all: f64 = places.iter().map(|place| place.weight).sum();
    let Some(criterion) = demand.first(rule) else { return all };
    let meets = |place: &&KeptPlace| match days {
        DaysNeeded::Each => place.days.iter().all(has_enough),
        DaysNeeded::One => place.days.iter().any(has_enough),
    };
    let meeting: f64 = places.iter().filter(meets).map(|place| place.weight).sum();
    let needed = match criterion.extent {
        Extent::Part { share, or_area_m2 } => (share * all).min(or_area_m2.unwrap_or(f64::INFINITY)),
        Extent::OfBefore(ratio) => ratio * meeting,
        _ => all,
    };
    let needed = criterion.or_ratio.map_or(needed, |ratio| needed.min(ratio * meeting));
    if criterion.no_worse { needed.min(meeting) } else { needed }
}

fn has_enough(day: &SunNeeded) -> bool {
    let most = match day.at_once {
        true => day.lit.iter().map(|spell| spell.secs()).max().unwrap_or(0),
        false => total_secs(&day.lit),
    };
    most >= day.secs
}
