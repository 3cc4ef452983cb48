//! Verdicts, and what they rest on.

use super::days::DayJudge;
use super::resolved::ResolvedRule;
use crate::choice::words;
use chrono::NaiveDate;
use std::cmp::Ordering;

/// Whether a rule is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It is.
    Pass,
    /// Nobody can say: the number is closer to its limit than it is known.
    Close,
    /// It is not.
    Fail,
    /// The rule has no limit.
    Report,
}

words!(Verdict, [
    "pass" => Verdict::Pass,
    "close" => Verdict::Close,
    "fail" => Verdict::Fail,
    "report" => Verdict::Report,
]);

impl Verdict {
    /// Of several things that must all pass.
    pub fn all(verdicts: impl IntoIterator<Item = Verdict>) -> Verdict {
        let worst = [Verdict::Report, Verdict::Pass, Verdict::Close, Verdict::Fail];
        Verdict::furthest(&worst, verdicts)
    }

    /// Of several things one of which must pass.
    pub fn any(verdicts: impl IntoIterator<Item = Verdict>) -> Verdict {
        let best = [Verdict::Report, Verdict::Fail, Verdict::Close, Verdict::Pass];
        Verdict::furthest(&best, verdicts)
    }

    fn furthest(order: &[Verdict; 4], verdicts: impl IntoIterator<Item = Verdict>) -> Verdict {
        let rank = |verdict: Verdict| order.iter().position(|of| *of == verdict);
        verdicts.into_iter().max_by_key(|verdict| rank(*verdict)).unwrap_or(Verdict::Report)
    }
}

/// A number that a rule compares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Quantity {
    /// Seconds.
    Secs(i64),
    /// A part of a whole, 0 to 1.
    Share(f64),
    /// Square metres.
    AreaM2(f64),
    /// Square metres times seconds.
    AreaTime(f64),
    /// How many.
    Count(usize),
}

/// Why a number that misses its limit is taken all the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Excuse {
    /// It is still the share of what was before that the rule asks.
    Ratio,
    /// The limit was not kept before either, and nothing has become less.
    NoWorse,
    /// A body that the law allows does the same.
    Reference,
}

/// What one criterion came to on one day, or on all days that are added up.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Which criterion, from 0.
    pub criterion: usize,
    /// Which day; none where days are added up, or where it is of none.
    pub date: Option<NaiveDate>,
    /// Whether it is kept.
    pub verdict: Verdict,
    /// The number.
    pub value: Quantity,
    /// The longest spell, seconds, where time is counted.
    pub longest_secs: Option<i64>,
    /// The number before, or that of the body that the law allows.
    pub before: Option<Quantity>,
    /// Its limit; none where it is only told.
    pub limit: Option<Quantity>,
    /// By how much it is kept; negative where it is missed.
    pub margin: Option<f64>,
    /// Why it is taken though it misses its limit.
    pub excuse: Option<Excuse>,
    /// How long all sun is gone that was there before, at a time, seconds; where the rule asks.
    pub no_sun_left_secs: Option<i64>,
}

impl Finding {
    /// The margin by the limit, for what is compared across criteria; an excused one is at its limit.
    pub(super) fn slack(&self) -> f64 {
        let limit = match self.limit {
            Some(Quantity::Secs(secs)) => secs as f64,
            Some(Quantity::Share(number) | Quantity::AreaM2(number) | Quantity::AreaTime(number)) => number,
            Some(Quantity::Count(count)) => count as f64,
            None => return f64::INFINITY,
        };
        let margin = if self.excuse.is_some() { 0.0 } else { self.margin.unwrap_or(0.0) };
        if limit > 0.0 { margin / limit } else { margin }
    }
}

/// A verdict with its reasons.
#[derive(Clone, Debug, PartialEq)]
pub struct Ruling {
    /// Of all days and criteria together.
    pub verdict: Verdict,
    /// The highest grade that is reached, where the rule has grades.
    pub grade: Option<String>,
    /// Which finding decides, by its number; none where there is none.
    pub deciding: Option<usize>,
    /// Each criterion on each day.
    pub findings: Vec<Finding>,
}

/// The findings of one day, or of all days that are added up.
pub(super) struct DayCase {
    /// Of which set of days.
    pub(super) set: usize,
    /// In the order of the criteria.
    pub(super) findings: Vec<Finding>,
}

/// What a day or a set of days came to: the verdict, how many grades are reached, and the number of the finding that
/// decides.
#[derive(Clone, Copy)]
struct Standing {
    verdict: Verdict,
    grades: usize,
    deciding: Option<usize>,
    slack: f64,
}

impl ResolvedRule {
    /// One verdict of the findings of all days.
    pub(super) fn ruling(&self, cases: Vec<DayCase>) -> Ruling {
        let mut findings: Vec<Finding> = Vec::new();
        let mut sets: Vec<Vec<Standing>> = vec![Vec::new(); self.days.len()];
        for case in cases {
            if case.findings.is_empty() {
                continue;
            }
            let standing = self.of_case(&case.findings, findings.len());
            findings.extend(case.findings);
            if let Some(set) = sets.get_mut(case.set) {
                set.push(standing);
            }
        }
        let of_sets = self.days.iter().zip(&sets).filter_map(|(set, of)| match set.judge {
            DayJudge::Best => of.iter().copied().reduce(better),
            DayJudge::Each | DayJudge::Worst | DayJudge::Sum => of.iter().copied().reduce(worse),
        });
        let whole = of_sets.reduce(worse);
        let graded = whole.filter(|whole| whole.verdict == Verdict::Pass && whole.grades > 0);
        let grade = graded.and_then(|whole| self.criteria.get(whole.grades - 1)?.grade.clone());
        Ruling {
            verdict: whole.map_or(Verdict::Report, |whole| whole.verdict),
            grade,
            deciding: whole.and_then(|whole| whole.deciding),
            findings,
        }
    }

    /// One day's criteria together; `offset` is the number of its first finding.
    fn of_case(&self, findings: &[Finding], offset: usize) -> Standing {
        let one = |(at, finding): (usize, &Finding)| Standing {
            verdict: finding.verdict,
            grades: 0,
            deciding: Some(offset + at),
            slack: finding.slack(),
        };
        let is_graded = self.criteria.iter().any(|criterion| criterion.grade.is_some());
        let each = findings.iter().enumerate().map(one);
        let none = Standing { verdict: Verdict::Report, grades: 0, deciding: None, slack: f64::INFINITY };
        if is_graded {
            // the grades are a ladder, and its first step is what must be kept
            let grades = findings.iter().take_while(|finding| finding.verdict == Verdict::Pass).count();
            let first = each.into_iter().next().unwrap_or(none);
            return Standing { grades, ..first };
        }
        let whole = if self.any { each.reduce(better) } else { each.reduce(worse) };
        whole.unwrap_or(none)
    }
}

/// The one of two that decides where both must be kept.
fn worse(a: Standing, b: Standing) -> Standing {
    let verdict = Verdict::all([a.verdict, b.verdict]);
    let grades = a.grades.min(b.grades);
    let kept = match (a.verdict == verdict, b.verdict == verdict) {
        (true, false) => a,
        (false, true) => b,
        _ if b.slack.partial_cmp(&a.slack) == Some(Ordering::Less) => b,
        _ => a,
    };
    Standing { grades, ..kept }
}

/// The one of two that decides where one is enough.
fn better(a: Standing, b: Standing) -> Standing {
    let verdict = Verdict::any([a.verdict, b.verdict]);
    match (a.verdict == verdict, b.verdict == verdict) {
        (true, false) => a,
        (false, true) => b,
        _ if (b.grades, b.slack) > (a.grades, a.slack) => b,
        _ => a,
    }
}
