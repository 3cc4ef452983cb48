//! Verdicts, and the findings they are based on.

use super::counting::CountedTime;
use super::days::DayJudge;
use super::resolved::ResolvedRule;
use crate::choice::words;
use chrono::NaiveDate;
use std::cmp::Ordering;

/// The result of comparing a number with a rule's limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The rule is kept.
    Pass,
    /// Undecided: the number differs from its limit by less than its error.
    Close,
    /// The rule is broken.
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
    /// The verdict on several things that must all pass.
    pub fn all(verdicts: impl IntoIterator<Item = Verdict>) -> Verdict {
        let worst = [Verdict::Report, Verdict::Pass, Verdict::Close, Verdict::Fail];
        Verdict::furthest(&worst, verdicts)
    }

    /// The verdict on several things if one that passes is enough.
    pub fn any(verdicts: impl IntoIterator<Item = Verdict>) -> Verdict {
        let best = [Verdict::Report, Verdict::Fail, Verdict::Close, Verdict::Pass];
        Verdict::furthest(&best, verdicts)
    }

    fn furthest(order: &[Verdict; 4], verdicts: impl IntoIterator<Item = Verdict>) -> Verdict {
        let rank = |verdict: Verdict| order.iter().position(|of| *of == verdict);
        verdicts.into_iter().max_by_key(|verdict| rank(*verdict)).unwrap_or(Verdict::Report)
    }
}

/// A number that a rule compares with a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Quantity {
    /// A time, seconds.
    Secs(i64),
    /// A share, 0 to 1.
    Share(f64),
    /// An area, square metres.
    AreaM2(f64),
    /// An area times a time, square metres times seconds.
    AreaTime(f64),
    /// A number of things.
    Count(usize),
}

/// Why a number that misses its limit is accepted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Excuse {
    /// It is still the share of the number before that the rule demands.
    Ratio,
    /// It missed the limit before, too, and has not become worse.
    NoWorse,
    /// A body that the law allows would have the same effect.
    Reference,
}

/// The result of one criterion on one day, or on all days added up.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// The index of the criterion, from 0.
    pub criterion: usize,
    /// The day; `None` if days are added up, or if the criterion is not about a day.
    pub date: Option<NaiveDate>,
    /// The verdict.
    pub verdict: Verdict,
    /// The number that is compared.
    pub value: Quantity,
    /// The longest spell, seconds, if time is counted.
    pub longest_secs: Option<i64>,
    /// The number before, or with the body that the law allows.
    pub before: Option<Quantity>,
    /// The limit; `None` if the number is only reported.
    pub limit: Option<Quantity>,
    /// The distance from the limit; negative if it is missed.
    pub margin: Option<f64>,
    /// Why the number is accepted though it misses the limit.
    pub excuse: Option<Excuse>,
    /// The longest time in which all sun is gone that was there before, seconds, if the rule asks for it.
    pub no_sun_left_secs: Option<i64>,
}

impl Finding {
    /// The margin as a share of the limit, to compare criteria with each other; 0 for an excused finding.
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
    /// The verdict on all days and criteria together.
    pub verdict: Verdict,
    /// The highest grade that is reached, if the rule has grades.
    pub grade: Option<String>,
    /// The index of the finding that decides; `None` without findings.
    pub deciding: Option<usize>,
    /// One finding for each criterion and day.
    pub findings: Vec<Finding>,
}

/// The findings of one day, or of all days added up.
pub(super) struct DayCase {
    /// The index of the set of days.
    pub(super) set: usize,
    /// The findings in the order of the criteria.
    pub(super) findings: Vec<Finding>,
}

/// The result of a day or of a set of days: the verdict, the number of grades that are reached, and the index of the
/// finding that decides.
#[derive(Clone, Copy)]
struct Standing {
    verdict: Verdict,
    grades: usize,
    deciding: Option<usize>,
    slack: f64,
}

impl ResolvedRule {
    /// Combines the findings of all days.
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

    /// As [`Finding::slack`]; of reports the worst day decides: the one with the least sun, or the most shadow.
    fn slack(&self, finding: &Finding) -> f64 {
        match (finding.verdict, finding.value) {
            (Verdict::Report, Quantity::Secs(secs)) if self.counting.what == CountedTime::Sun => secs as f64,
            (Verdict::Report, Quantity::Secs(secs)) => -(secs as f64),
            (Verdict::Report, Quantity::AreaTime(m2_secs)) => -m2_secs,
            _ => finding.slack(),
        }
    }

    /// Combines the criteria of one day; `offset` is the index of its first finding.
    fn of_case(&self, findings: &[Finding], offset: usize) -> Standing {
        let one = |(at, finding): (usize, &Finding)| Standing {
            verdict: finding.verdict,
            grades: 0,
            deciding: Some(offset + at),
            slack: self.slack(finding),
        };
        let is_graded = self.criteria.iter().any(|criterion| criterion.grade.is_some());
        let each = findings.iter().enumerate().map(one);
        let none = Standing { verdict: Verdict::Report, grades: 0, deciding: None, slack: f64::INFINITY };
        if is_graded {
            // grades are a ladder, and the rule demands its first step
            let grades = findings.iter().take_while(|finding| finding.verdict == Verdict::Pass).count();
            let first = each.into_iter().next().unwrap_or(none);
            return Standing { grades, ..first };
        }
        let whole = if self.any { each.reduce(better) } else { each.reduce(worse) };
        whole.unwrap_or(none)
    }
}

/// Returns the one that decides if both must be kept.
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

/// Returns the one that decides if one is enough.
fn better(a: Standing, b: Standing) -> Standing {
    let verdict = Verdict::any([a.verdict, b.verdict]);
    match (a.verdict == verdict, b.verdict == verdict) {
        (true, false) => a,
        (false, true) => b,
        _ if (b.grades, b.slack) > (a.grades, a.slack) => b,
        _ => a,
    }
}
