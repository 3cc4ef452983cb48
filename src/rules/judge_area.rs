//! Judges criteria on parts of areas, and shadow as area times time.

use super::criterion::{Criterion, Demand, Extent};
use super::error::{RuleError, RuleNeed};
use super::resolved::{ResolvedRule, RuleDay};
use super::verdict::{DayCase, Finding, Quantity, Ruling, Verdict};
use super::weigh::{Weight, verdict_of};

/// How much of an area keeps a criterion's limit on a day.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartMet {
    /// The area that keeps it, square metres.
    pub now_m2: f64,
    /// The same area in the state before.
    pub before_m2: Option<f64>,
    /// The uncertainty of both, ± square metres.
    pub error_m2: f64,
    /// Whether any of its points has less sun than before.
    pub has_less: bool,
}

/// An area on one day.
#[derive(Clone, Debug)]
pub struct AreaLight<'a> {
    /// The day.
    pub day: &'a RuleDay,
    /// One for each criterion; `None` for those that are not about parts of areas.
    pub met: Vec<Option<PartMet>>,
}

/// The new shadow on an area on one day.
#[derive(Clone, Copy, Debug)]
pub struct ShadowLoad<'a> {
    /// The day.
    pub day: &'a RuleDay,
    /// Its area times its duration, square metres times seconds.
    pub m2_secs: f64,
    /// The uncertainty of that, ± square metres times seconds.
    pub error_m2_secs: f64,
}

impl ResolvedRule {
    /// Returns the ruling on an area by the parts of it that keep the criteria.
    ///
    /// # Errors
    /// [`RuleError::Needs`] if the rule compares with a state that the site does not have, or if the area is empty.
    pub fn judge_parts(&self, area_m2: f64, days: &[AreaLight]) -> Result<Ruling, RuleError> {
        self.check_area(area_m2)?;
        let mut cases = Vec::new();
        for light in days {
            let mut findings = Vec::new();
            for (number, criterion) in self.criteria.iter().enumerate() {
                let counts = light.day.criteria.get(number).is_some_and(Option::is_some);
                if let Some(Some(met)) = light.met.get(number)
                    && counts
                    && let Some(finding) = self.part(number, criterion, area_m2, *met)?
                {
                    findings.push(Finding { date: Some(light.day.date), ..finding });
                }
            }
            cases.push(DayCase { set: light.day.set, findings });
        }
        Ok(self.ruling(cases))
    }

    fn check_area(&self, area_m2: f64) -> Result<(), RuleError> {
        if area_m2.is_finite() && area_m2 > 0.0 {
            return Ok(());
        }
        Err(RuleError::Needs { rule: self.id.clone(), needs: vec![RuleNeed::without_key("areas of more than 0 m²")] })
    }

    /// `None` if the criterion is not about parts of areas.
    fn part(
        &self,
        number: usize,
        criterion: &Criterion,
        area_m2: f64,
        met: PartMet,
    ) -> Result<Option<Finding>, RuleError> {
        if criterion.needs_before() && met.before_m2.is_none() {
            return Err(self.needs_before());
        }
        let (least_m2, error_m2) = match criterion.extent {
            Extent::Part { share, or_area_m2 } => {
                ((share * area_m2).min(or_area_m2.unwrap_or(f64::INFINITY)), met.error_m2)
            }
            // both areas have the error
            Extent::OfBefore(ratio) => (ratio * met.before_m2.unwrap_or(0.0), met.error_m2 * (1.0 + ratio)),
            Extent::Whole | Extent::Dwellings(_) | Extent::Sunless { .. } => return Ok(None),
        };
        let weight = Weight {
            value: met.now_m2,
            error: error_m2,
            least: least_m2,
            before: met.before_m2,
            has_less: met.has_less,
        };
        let (verdict, excuse) = weight.verdict(criterion);
        Ok(Some(Finding {
            criterion: number,
            date: None,
            verdict,
            value: Quantity::AreaM2(met.now_m2),
            longest_secs: None,
            before: met.before_m2.map(Quantity::AreaM2),
            limit: Some(Quantity::AreaM2(least_m2)),
            margin: Some(met.now_m2 - least_m2),
            excuse,
            no_sun_left_secs: None,
        }))
    }

    /// Returns the ruling on the new shadow on an area, added up over days.
    ///
    /// # Errors
    /// [`RuleError::Needs`] if the area is empty.
    pub fn judge_load(&self, area_m2: f64, days: &[ShadowLoad]) -> Result<Ruling, RuleError> {
        self.check_area(area_m2)?;
        let mut cases = Vec::new();
        for set in 0..self.days.len() {
            let of_set = || days.iter().filter(|load| load.day.set == set);
            let open: f64 = of_set().map(|load| area_m2 * super::spell::total_secs(&load.day.windows) as f64).sum();
            let value: f64 = of_set().map(|load| load.m2_secs).sum();
            let error: f64 = of_set().map(|load| load.error_m2_secs).sum();
            let finding = |(number, criterion): (usize, &Criterion)| {
                let limit = match criterion.demand {
                    Demand::ShareOfOpen(share) => Some(share * open),
                    Demand::AtLeast { .. } | Demand::AtMost(_) | Demand::Report { .. } => None,
                };
                Finding {
                    criterion: number,
                    date: None,
                    verdict: limit.map_or(Verdict::Report, |limit| verdict_of(-value, error, -limit)),
                    value: Quantity::AreaTime(value),
                    longest_secs: None,
                    before: None,
                    limit: limit.map(Quantity::AreaTime),
                    margin: limit.map(|limit| limit - value),
                    excuse: None,
                    no_sun_left_secs: None,
                }
            };
            cases.push(DayCase { set, findings: self.criteria.iter().enumerate().map(finding).collect() });
        }
        Ok(self.ruling(cases))
    }
}
