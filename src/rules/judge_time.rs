//! Judges receivers that are either lit or not as a whole: a point, a window, or an area that counts as lit if any part
//! of it is.

use super::counting::{CountHow, CountedTime, SpellCount};
use super::criterion::{Criterion, Demand, Extent};
use super::days::DayJudge;
use super::error::{RuleError, RuleNeed};
use super::resolved::{CompareWith, ResolvedRule, RuleDay};
use super::spell::{Spell, without};
use super::verdict::{DayCase, Excuse, Finding, Quantity, Ruling, Verdict};
use super::weigh::Weight;

/// When a receiver is lit on one day.
#[derive(Clone, Copy, Debug)]
pub struct DayLight<'a> {
    /// The day.
    pub day: &'a RuleDay,
    /// When a sun that counts would light the receiver if nothing stood in the way: the sun is up, high enough, and in
    /// front of its plane. Time in `open` but not in `lit` is shadow; night is not.
    pub open: &'a [Spell],
    /// When a sun that counts lights it.
    pub lit: &'a [Spell],
    /// The same in the state before, or with the body that the law allows.
    pub before: Option<&'a [Spell]>,
    /// When any part of it lies in shadow that was lit before. Not needed for a single point, for which it follows from
    /// the other fields.
    pub newly_shaded: Option<&'a [Spell]>,
}

/// What one criterion counts on one day.
#[derive(Clone, Copy)]
struct CountedDay {
    now: SpellCount,
    before: Option<SpellCount>,
    no_sun_left_secs: Option<i64>,
}

impl CountedDay {
    fn plus(self, other: CountedDay) -> CountedDay {
        let sum = |a: SpellCount, b: SpellCount| SpellCount {
            secs: a.secs + b.secs,
            longest_secs: a.longest_secs.max(b.longest_secs),
        };
        CountedDay {
            now: sum(self.now, other.now),
            before: self.before.zip(other.before).map(|(a, b)| sum(a, b)),
            no_sun_left_secs: self.no_sun_left_secs.max(other.no_sun_left_secs),
        }
    }
}

impl ResolvedRule {
    /// Returns the ruling on a receiver, or on a point of a rule's level plane in one of its bands. Criteria on parts
    /// of areas and on dwellings are left out; if there are no others, the verdict is [`Verdict::Report`].
    ///
    /// # Errors
    /// [`RuleError::Needs`] if the rule compares with a state that the site does not have.
    pub fn judge_time(&self, band: Option<usize>, days: &[DayLight]) -> Result<Ruling, RuleError> {
        let mut cases: Vec<DayCase> = Vec::new();
        let mut sums: Vec<Vec<Option<CountedDay>>> = vec![vec![None; self.criteria.len()]; self.days.len()];
        for light in days {
            let set = light.day.set;
            let is_sum = self.days.get(set).is_some_and(|of| of.judge == DayJudge::Sum);
            let mut findings = Vec::new();
            for (number, criterion) in self.criteria.iter().enumerate() {
                let Some(windows) = self.own_windows(number, band, light.day) else { continue };
                let counts = self.counts(criterion, light, windows)?;
                if is_sum {
                    let sum = &mut sums[set][number];
                    *sum = Some(sum.map_or(counts, |sum| sum.plus(counts)));
                } else {
                    findings.push(Finding { date: Some(light.day.date), ..self.finding(number, counts)? });
                }
            }
            cases.push(DayCase { set, findings });
        }
        for (set, sums) in sums.into_iter().enumerate() {
            let sums = sums.into_iter().enumerate();
            let findings = sums.filter_map(|(number, sum)| sum.map(|sum| self.finding(number, sum)));
            cases.push(DayCase { set, findings: findings.collect::<Result<_, _>>()? });
        }
        Ok(self.ruling(cases))
    }

    /// The windows of a criterion on a day; `None` if it does not apply to the day or the band, or not to the receiver
    /// as a whole.
    fn own_windows<'a>(&self, number: usize, band: Option<usize>, day: &'a RuleDay) -> Option<&'a [Spell]> {
        let criterion = self.criteria.get(number).filter(|of| of.band == band && of.extent == Extent::Whole)?;
        debug_assert!(!criterion.is_of_dwellings());
        day.criteria.get(number)?.as_deref()
    }

    /// Returns the time, in seconds, that a criterion counts for a receiver on a day, in the state as it is now.
    pub fn tally(&self, criterion: usize, light: &DayLight) -> Result<SpellCount, RuleError> {
        let windows = light.day.criteria.get(criterion).and_then(Option::as_deref);
        match (self.criteria.get(criterion), windows) {
            (Some(of), Some(windows)) => Ok(self.counts(of, light, windows)?.now),
            _ => Ok(SpellCount::default()),
        }
    }

    fn counts(&self, criterion: &Criterion, light: &DayLight, windows: &[Spell]) -> Result<CountedDay, RuleError> {
        let tally = |spells: &[Spell]| self.counting.tally(criterion.how, spells, windows);
        let shaded = |lit: &[Spell]| without(light.open, lit);
        let (now, before) = match self.counting.what {
            CountedTime::Sun => (tally(light.lit), light.before.map(tally)),
            CountedTime::Shadow => (tally(&shaded(light.lit)), light.before.map(|lit| tally(&shaded(lit)))),
            CountedTime::NewShadow => {
                let new = match light.newly_shaded {
                    Some(new) => tally(new),
                    None => tally(&without(light.before.ok_or_else(|| self.needs_before())?, light.lit)),
                };
                (new, None)
            }
        };
        let asks_loss = matches!(criterion.demand, Demand::Report { no_sun_left_secs: Some(_) });
        let no_sun_left_secs = if asks_loss {
            let before = light.before.ok_or_else(|| self.needs_before())?;
            Some(self.counting.tally(CountHow::Longest, &without(before, light.lit), windows).secs)
        } else {
            None
        };
        Ok(CountedDay { now, before, no_sun_left_secs })
    }

    pub(super) fn needs_before(&self) -> RuleError {
        let need = RuleNeed::of_key("the state before, with which it compares", "[before]", "");
        RuleError::Needs { rule: self.id.clone(), needs: vec![need] }
    }

    fn finding(&self, number: usize, counts: CountedDay) -> Result<Finding, RuleError> {
        let criterion = &self.criteria[number];
        let CountedDay { now, before, no_sun_left_secs } = counts;
        if criterion.needs_before() && self.counting.what != CountedTime::NewShadow && before.is_none() {
            return Err(self.needs_before());
        }
        let reference = before.filter(|_| self.compare == Some(CompareWith::Reference));
        let (verdict, excuse, limit, margin) = match criterion.demand {
            Demand::AtLeast { secs, longest_secs } => at_least(criterion, secs, longest_secs, now, before, reference),
            Demand::AtMost(secs) => at_most(secs, now, reference),
            // `judge_load` judges areas
            Demand::ShareOfOpen(_) | Demand::Report { .. } => (Verdict::Report, None, None, None),
        };
        Ok(Finding {
            criterion: number,
            date: None,
            verdict,
            value: Quantity::Secs(now.secs),
            longest_secs: Some(now.longest_secs),
            before: before.map(|before| Quantity::Secs(before.secs)),
            limit: limit.map(Quantity::Secs),
            margin: margin.map(|margin: i64| margin as f64),
            excuse,
            no_sun_left_secs,
        })
    }
}

/// A verdict, its excuse, its limit and its margin.
type LimitOutcome = (Verdict, Option<Excuse>, Option<i64>, Option<i64>);

fn at_least(
    criterion: &Criterion,
    secs: i64,
    longest_secs: i64,
    now: SpellCount,
    before: Option<SpellCount>,
    reference: Option<SpellCount>,
) -> LimitOutcome {
    // with a limit for the longest spell, too, the larger shortfall decides
    let of_longest = if longest_secs > 0 { now.longest_secs - longest_secs } else { i64::MAX };
    let margin = (now.secs - secs).min(of_longest);
    let numbers = Weight {
        value: (secs + margin) as f64,
        error: 0.0,
        least: secs as f64,
        before: before.map(|before| before.secs as f64),
        has_less: false,
    };
    let (mut verdict, mut excuse) = numbers.verdict(criterion);
    if verdict != Verdict::Pass && reference.is_some_and(|reference| now.secs >= reference.secs) {
        (verdict, excuse) = (Verdict::Pass, Some(Excuse::Reference));
    }
    (verdict, excuse, Some(secs), Some(margin))
}

fn at_most(secs: i64, now: SpellCount, reference: Option<SpellCount>) -> LimitOutcome {
    let margin = secs - now.secs;
    let (verdict, excuse) = match () {
        () if margin >= 0 => (Verdict::Pass, None),
        () if reference.is_some_and(|reference| now.secs <= reference.secs) => (Verdict::Pass, Some(Excuse::Reference)),
        () => (Verdict::Fail, None),
    };
    (verdict, excuse, Some(secs), Some(margin))
}
