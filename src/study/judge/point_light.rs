//! The light of a receiver on all days, as rules count it.

use crate::judgement::{DayCount, LitSpell, ReceiverSpells, spells_of};
use crate::rules::{CountedTime, DayLight, ResolvedRule, RuleDay, RuleError, Ruling, Spell, Verdict, merged, without};

/// Of one receiver, each day by itself.
#[derive(Clone, Debug)]
pub(super) struct PointLight {
    /// When a sun that counts would shine if nothing stood there.
    pub(super) open: Vec<Vec<Spell>>,
    /// In the sun, as it is.
    pub(super) now: Vec<Vec<LitSpell>>,
    /// In the sun, as it was.
    pub(super) before: Option<Vec<Vec<LitSpell>>>,
}

/// The same without what bounds the spells, as what is judged needs it.
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
    /// Of several receivers of which one is enough, or of an area of which any part is.
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

    /// Of an area: where any of its points lies in shadow that was lit before is newly shaded.
    pub(super) fn any_with_new_shadow(lights: &[&CountedLight], days: usize) -> CountedLight {
        let any = CountedLight::any(lights, days);
        let new = |day: usize| merged(lights.iter().flat_map(|light| light.new_shadow(day)));
        let newly_shaded = any.before.is_some().then(|| (0..days).map(new).collect());
        CountedLight { newly_shaded, ..any }
    }

    /// Shadow that was sun, on a day.
    pub(super) fn new_shadow(&self, day: usize) -> Vec<Spell> {
        self.before.as_ref().map_or_else(Vec::new, |before| without(&before[day], &self.now[day]))
    }

    /// As a rule is given it, on each day.
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

    /// The spells of some days, without what bounds them.
    pub(super) fn newly_shaded_on(&self, day: usize) -> Option<Vec<Spell>> {
        self.newly_shaded.as_ref().map(|new| new[day].clone())
    }

    /// What the rule's own way of counting comes to on each day.
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

    /// The ruling of a receiver that is lit or not as one.
    pub(super) fn ruling(
        &self,
        rule: &ResolvedRule,
        band: Option<usize>,
        days: &[RuleDay],
    ) -> Result<Ruling, RuleError> {
        rule.judge_time(band, &self.days(days))
    }
}

/// How good a ruling is: the greater the better. Seconds to its limit, and whether it is kept before all.
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
