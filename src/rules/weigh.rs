//! Holds one number against one criterion.

use super::criterion::Criterion;
use super::verdict::{Excuse, Verdict};

/// A number, with what it is held against.
pub(super) struct Weight {
    /// The number.
    pub(super) value: f64,
    /// It is known to so much, up and down.
    pub(super) error: f64,
    /// What it must reach.
    pub(super) least: f64,
    /// The number before.
    pub(super) before: Option<f64>,
}

/// Whether a number reaches another, which may be a product whose rounding is no reason to fail.
pub(super) fn reaches(value: f64, least: f64) -> bool {
    value >= least - 1e-9 * least.abs()
}

/// Whether a number that is known to an error reaches another.
pub(super) fn verdict_of(value: f64, error: f64, least: f64) -> Verdict {
    match (reaches(value - error, least), reaches(value + error, least)) {
        (true, _) => Verdict::Pass,
        (false, true) => Verdict::Close,
        (false, false) => Verdict::Fail,
    }
}

impl Weight {
    /// The verdict, with what the criterion takes in place of its limit.
    pub(super) fn verdict(&self, criterion: &Criterion) -> (Verdict, Option<Excuse>) {
        let Weight { value, error, least, before } = *self;
        let own = verdict_of(value, error, least);
        let ratio = criterion.or_ratio.zip(before);
        let by_ratio =
            ratio.map(|(ratio, before)| (Excuse::Ratio, verdict_of(value, error * (1.0 + ratio), ratio * before)));
        let no_worse = before.filter(|_| criterion.no_worse).map(|before| {
            let failed = match verdict_of(before, error, least) {
                Verdict::Pass => Verdict::Fail,
                Verdict::Fail => Verdict::Pass,
                other => other,
            };
            // two numbers of one method that are equal have not changed
            let held = if value == before { Verdict::Pass } else { verdict_of(value, 2.0 * error, before) };
            (Excuse::NoWorse, Verdict::all([failed, held]))
        });
        let excuses = [by_ratio, no_worse];
        let mut best = (own, None);
        for (excuse, verdict) in excuses.into_iter().flatten() {
            if verdict != best.0 && Verdict::any([verdict, best.0]) == verdict {
                best = (verdict, Some(excuse));
            }
        }
        best
    }
}
