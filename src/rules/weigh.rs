//! Compares a number with a criterion's limit.

use super::criterion::Criterion;
use super::verdict::{Excuse, Verdict};

/// A number, and what it is compared with.
pub(super) struct Weight {
    pub(super) value: f64,
    /// The uncertainty of the number, ±.
    pub(super) error: f64,
    /// The limit.
    pub(super) least: f64,
    /// The number before.
    pub(super) before: Option<f64>,
    /// Whether a part of what is counted has become less, though the number may not show it.
    pub(super) has_less: bool,
}

/// Whether a number reaches a limit. Limits may be products, so a rounding error does not fail.
pub(super) fn reaches(value: f64, least: f64) -> bool {
    value >= least - 1e-9 * least.abs()
}

/// The verdict on a number with an uncertainty.
pub(super) fn verdict_of(value: f64, error: f64, least: f64) -> Verdict {
    match (reaches(value - error, least), reaches(value + error, least)) {
        (true, _) => Verdict::Pass,
        (false, true) => Verdict::Close,
        (false, false) => Verdict::Fail,
    }
}

impl Weight {
    /// The verdict, with what the criterion accepts instead of its limit.
    pub(super) fn verdict(&self, criterion: &Criterion) -> (Verdict, Option<Excuse>) {
        let Weight { value, error, least, before, has_less } = *self;
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
            // equal numbers from one method mean that nothing has changed, unless a part of it has
            let held = if has_less {
                Verdict::Fail
            } else if value == before {
                Verdict::Pass
            } else {
                verdict_of(value, 2.0 * error, before)
            };
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
