//! The light of a receiver on all days, in the form that rules count.

use crate::judgement::{DayCount, LitSpell, ReceiverSpells, spells_of};
use crate::rules::{CountedTime, DayLight, ResolvedRule, RuleDay, RuleError, Ruling, Spell, Verdict, merged, without};

/// The light of one receiver, a list for each day.
#[derive(Clone, Debug)]
pub(super) struct PointLight {
    /// When a sun that counts would shine with nothing in its way.
    pub(super) open: Vec<Vec<Spell>>,
    /// The spells in the sun, in the state that is judged.
    pub(super) now: Vec<Vec<LitSpell>>,
    /// The spells in the sun, in the state before.
    pub(super) before: Option<Vec<Vec<LitSpell>>>,
}

/// The same without the spells' bounds, as rules need it.
#[derive(Clone, Debug, Default)]
pub(super) struct CountedLight {
    open: Vec<Vec<Spell>>,
    now: Vec<Vec<Spell>>,
    before: Option<Vec<Vec<Spell>>>,
    newly_shaded: Option<Vec<Vec<Spell>>>,
}

impl PointLight {
    pub(super) fn counted(&self) -> CountedLight {
        let of = |days: &[Vec<LitSpell>]| days.iter().map(|day| spells_of(day)).collect();
        CountedLight {
            open: self.open.clone(),
            now: of(&self.now),
            before: self.before.as_deref().map(of),
            newly_shaded: None,
        }
    }

    /// The spells of some days.
    pub(super) fn told(&self, days: impl IntoIterator<Item = usize>) -> Vec<ReceiverSpells> {
        let of = |day: usize| ReceiverSpells {
            day,
            open: self.open[day].clone(),
            now: self.now[day].clone(),
            before: self.before.as_ref().map(|before| before[day].clone()),
            newly_shaded: None,
        };
        days.into_iter().map(of).collect()
    }
}

impl CountedLight {
    /// The light of several receivers together, lit while any of them is; or of an area, lit while any part of it is.
    pub(super) fn any(lights: &[&CountedLight], days: usize) -> CountedLight {
        let together = |of: &dyn Fn(&CountedLight) -> Option<&Vec<Vec<Spell>>>, day: usize| {
            merged(lights.iter().filter_map(|light| of(light)).flat_map(|spells| spells[day].iter().copied()))
        };
        let all = |of: &dyn Fn(&CountedLight) -> Option<&Vec<Vec<Spell>>>| -> Vec<Vec<Spell>> {
            (0..days).map(|day| together(of, day)).collect()
        };
        let has_before = !lights.is_empty() && lights.iter().all(|light| light.before.is_some());
        CountedLight {
            open: all(&|light| Some(&light.open)),
            now: all(&|light| Some(&light.now)),
            before: has_before.then(|| all(&|light| light.before.as_ref())),
            newly_shaded: None,
        }
    }

    /// New shadow on an area: while any of its points is in shadow that was lit before.
    pub(super) fn any_with_new_shadow(lights: &[&CountedLight], days: usize) -> CountedLight {
        let any = CountedLight::any(lights, days);
        let new = |day: usize| merged(lights.iter().flat_map(|light| light.new_shadow(day)));
        let newly_shaded = any.before.is_some().then(|| (0..days).map(new).collect());
        CountedLight { newly_shaded, ..any }
    }

    /// The spells of a day in shadow that were in the sun before.
    pub(super) fn new_shadow(&self, day: usize) -> Vec<Spell> {
        self.before.as_ref().map_or_else(Vec::new, |before| without(&before[day], &self.now[day]))
    }

    /// The light of each day, in the form that rules take.
    pub(super) fn days<'b>(&'b self, days: &'b [RuleDay]) -> Vec<DayLight<'b>> {
        let of = |(at, day): (usize, &'b RuleDay)| DayLight {
            day,
            open: &self.open[at],
            lit: &self.now[at],
            before: self.before.as_ref().map(|before| before[at].as_slice()),
            newly_shaded: self.newly_shaded.as_ref().map(|new| new[at].as_slice()),
        };
        days.iter().enumerate().map(of).collect()
    }

    /// The spells of some days, without their bounds.
    pub(super) fn newly_shaded_on(&self, day: usize) -> Option<Vec<Spell>> {
        self.newly_shaded.as_ref().map(|new| new[day].clone())
    }

    /// The number that the rule counts on each day.
    pub(super) fn counts(&self, rule: &ResolvedRule, days: &[RuleDay]) -> Vec<DayCount> {
        let tally = |spells: &[Spell], day: &RuleDay| rule.counting.tally(rule.counting.how, spells, &day.windows).secs;
        let of = |light: DayLight<'_>| {
            let day = light.day;
            match rule.counting.what {
                CountedTime::Sun => DayCount {
                    now_secs: tally(light.lit, day),
                    before_secs: light.before.map(|before| tally(before, day)),
                },
                CountedTime::Shadow => DayCount {
                    now_secs: tally(&without(light.open, light.lit), day),
                    before_secs: light.before.map(|before| tally(&without(light.open, before), day)),
                },
                CountedTime::NewShadow => {
                    let own = || without(light.before.unwrap_or_default(), light.lit);
                    let new = light.newly_shaded.map_or_else(own, <[Spell]>::to_vec);
                    DayCount { now_secs: tally(&new, day), before_secs: None }
                }
            }
        };
        self.days(days).into_iter().map(of).collect()
    }

    /// The ruling of a receiver that is lit or in shadow as a whole.
    pub(super) fn ruling(
        &self,
        rule: &ResolvedRule,
        band: Option<usize>,
        days: &[RuleDay],
    ) -> Result<Ruling, RuleError> {
        rule.judge_time(band, &self.days(days))
    }
}

/// How good a ruling is, greater being better: first whether it is kept, then the seconds to its limit.
pub(super) fn merit(ruling: &Ruling) -> (u8, f64) {
    let rank = match ruling.verdict {
        Verdict::Fail => 0,
        Verdict::Close => 1,
        Verdict::Pass => 2,
        Verdict::Report => 3,
    };
    let margin = ruling.deciding.and_then(|at| ruling.findings[at].margin);
    (rank, margin.unwrap_or(f64::INFINITY))
}

/// Whether one ruling is worse than another.
pub(super) fn is_worse(one: &Ruling, other: &Ruling) -> bool {
    let (a, b) = (merit(one), merit(other));
    a.0 < b.0 || a.0 == b.0 && a.1 < b.1
}
