//! Areas: parts of them, their worst point, new shadow on them, and area times time.

use super::super::StudyError;
use super::area_light::{AreaPlace, AreaStates};
use super::judging::{RuleOnSite, Steps};
use super::parts::PartsAsked;
use super::point_light::{CountedLight, PointLight, merit};
use super::samples::{AreaSpot, AreaSums, Samples};
use crate::judgement::{AreaSize, CountedParts, JudgedThing, ReceiverRuling, ReceiverSpells};
use crate::rules::{
    AreaLight, CountHow, CountedTime, Criterion, DayLight, Demand, Extent, PartMet, RuleDay, RuleError, RuleNeed,
    Ruling, ShadowLoad, Verdict, total_secs,
};
use crate::site::JudgedArea;
use crate::sun::SunError;
use crate::sunlight::JudgedPoint;
use rayon::prelude::*;

/// The number of points that are searched between two calls of the listener.
const POINTS_TOGETHER: usize = 256;

/// The number of an area's points at which its takers are sought.
const MOST_ASKED: usize = 48;

/// The greatest side of the first triangles, as a part of the side of a square with the area's size.
const SIDES_ACROSS: f64 = 16.0;
/// If every day of a year is summed, the first triangles are larger and there are fewer points.
const SIDES_ACROSS_OF_SUMS: f64 = 10.0;

/// The greatest error of a part of an area, as a share of the area, unless it would take too many points.
const GOOD_SHARE: f64 = 0.001;
const MOST_POINTS: usize = 40_000;

/// The greatest error of area times time, as a share of it, unless it would take too many points.
const GOOD_LOAD: f64 = 0.005;
const MOST_POINTS_OF_SUMS: usize = 1500;

/// A point has less sun than before if it has lost more than this; the ends of spells are rounded to seconds.
const NOISE_SECS: f64 = 1.0;

/// New shadow on an area is looked for at points so far apart, metres, or farther if there were more than about so many.
const LEAST_APART_M: f64 = 2.0;
const POINTS_OF_NEW_SHADOW: f64 = 20_000.0;

/// What a rule asks of an area.
#[derive(Clone, Copy, PartialEq, Eq)]
enum AreaQuestion {
    /// The part of it that keeps the demand.
    Part,
    /// How much shadow falls on it, area times time.
    Load,
    /// The times at which new shadow lies on any part of it.
    NewShadow,
    /// Whether its worst point keeps the demand.
    Worst,
}

/// A ruling, and what is reported with it.
pub(super) struct AreaAnswer {
    pub(super) receiver: ReceiverRuling,
    /// The light of the point that decides, if one does.
    pub(super) light: Option<PointLight>,
    /// Some points that do not keep the demand, at which takers are sought; empty if the area passes.
    pub(super) shaded: Vec<(JudgedPoint, PointLight)>,
}

/// An area that is being judged.
struct AreaWork<'w> {
    judging: &'w RuleOnSite<'w>,
    place: AreaPlace<'w>,
    samples: Samples,
    size: AreaSize,
}

/// Judges one area.
pub(super) fn area(
    judging: &RuleOnSite<'_>,
    states: &AreaStates,
    area: &JudgedArea,
    steps: &mut Steps<'_, '_>,
) -> Result<AreaAnswer, StudyError> {
    let counted = CountedParts::of(&judging.rule.receiver, area);
    let (parts, m2) = (&counted.triangles, counted.m2());
    let question = question(judging);
    let longest_m = match question {
        AreaQuestion::Load => m2.sqrt() / SIDES_ACROSS_OF_SUMS,
        AreaQuestion::Part | AreaQuestion::Worst => m2.sqrt() / SIDES_ACROSS,
        // a slender shadow must not pass between the points; a triangle has about a third of its longest side's square
        AreaQuestion::NewShadow => {
            (m2 * 3.0 / POINTS_OF_NEW_SHADOW).sqrt().max(LEAST_APART_M).min(m2.sqrt() / SIDES_ACROSS)
        }
    }
    .max(1e-3);
    let samples = Samples::new(parts, longest_m);
    let place = AreaPlace::new(judging, states, &area.surface, parts);
    let size = AreaSize {
        m2,
        narrow_m2: counted.narrow_m2,
        points: 0,
        error_m2: 0.0,
        error_m2_secs: None,
        apart_m: (question == AreaQuestion::NewShadow).then_some(longest_m),
    };
    let work = AreaWork { judging, place, samples, size };
    let mut answer = match question {
        AreaQuestion::Part => work.part(steps)?,
        AreaQuestion::Load => work.load(steps)?,
        AreaQuestion::NewShadow => work.new_shadow(steps)?,
        AreaQuestion::Worst => work.worst(steps)?,
    };
    answer.receiver.name = area.name.clone();
    steps.done(1)?;
    Ok(answer)
}

fn question(judging: &RuleOnSite<'_>) -> AreaQuestion {
    let rule = judging.rule;
    let has = |of: &dyn Fn(&Criterion) -> bool| rule.criteria.iter().any(of);
    if has(&|criterion| criterion.how == CountHow::AreaTime) {
        AreaQuestion::Load
    } else if has(&is_of_part) {
        AreaQuestion::Part
    } else if rule.counting.what == CountedTime::NewShadow || rule.is_report() {
        AreaQuestion::NewShadow
    } else {
        AreaQuestion::Worst
    }
}

fn is_of_part(criterion: &Criterion) -> bool {
    matches!(criterion.extent, Extent::Part { .. } | Extent::OfBefore(_))
}

impl AreaWork<'_> {
    /// The numbers of the days and of those of their criteria that ask for a part of the area.
    fn asked(&self) -> Vec<(usize, usize)> {
        let judging = self.judging;
        let of_day = |day: usize| {
            let counts = move |number: &usize| judging.days.days[day].criteria[*number].is_some();
            let parts = (0..judging.rule.criteria.len()).filter(|number| is_of_part(&judging.rule.criteria[*number]));
            parts.filter(counts).map(move |number| (day, number))
        };
        (0..judging.days.days.len()).flat_map(of_day).collect()
    }

    fn part(mut self, steps: &mut Steps<'_, '_>) -> Result<AreaAnswer, StudyError> {
        let (judging, m2, asked) = (self.judging, self.size.m2, self.asked());
        let states = if judging.before.is_some() { 2 } else { 1 };
        let value = |spot: &AreaSpot| -> Result<Vec<f64>, SunError> {
            let light = self.place.light(spot)?.counted();
            Ok(margins(judging, &light, &asked))
        };
        let ruling = |sums: &AreaSums, has_less: &[bool]| {
            judging.rule.judge_parts(m2, &lights(judging, (&asked, states), m2, (sums, has_less)))
        };
        let none_has_less = vec![false; asked.len() * states];
        let is_decided = |sums: &AreaSums| {
            Ok(ruling(sums, &none_has_less)?.findings.iter().all(|finding| finding.verdict != Verdict::Close))
        };
        let parts = PartsAsked {
            numbers: asked.len() * states,
            good_m2: GOOD_SHARE * m2,
            most_points: MOST_POINTS,
            is_decided: &is_decided,
        };
        let sums = self.samples.parts(&parts, &value, steps)?;
        let has_less = |at: usize| {
            let less = |values: &Vec<f64>| values.get(at + 1).is_some_and(|before| values[at] < before - NOISE_SECS);
            states == 2 && at.is_multiple_of(2) && self.samples.values.iter().any(less)
        };
        let has_less: Vec<bool> = (0..asked.len() * states).map(has_less).collect();
        let ruling = ruling(&sums, &has_less)?;
        let error_m2 = sums.errors.iter().copied().fold(0.0, f64::max);
        let deciding = ruling.deciding.map(|at| &ruling.findings[at]);
        let field = deciding.and_then(|finding| {
            asked.iter().position(|(day, number)| {
                *number == finding.criterion && Some(judging.days.days[*day].date) == finding.date
            })
        });
        let at = field.unwrap_or(0) * states;
        self.answer(ruling, error_m2, at)
    }

    /// Makes the point with the lowest number the one that decides.
    fn answer(&self, ruling: Ruling, error_m2: f64, number: usize) -> Result<AreaAnswer, StudyError> {
        let value = |spot: usize| self.samples.values[spot][number];
        let lowest = (0..self.samples.spots.len()).min_by(|one, other| value(*one).total_cmp(&value(*other)));
        let shaded = if ruling.verdict == Verdict::Pass { Vec::new() } else { self.some_below(number)? };
        let light = lowest.map(|spot| self.place.light(&self.samples.spots[spot])).transpose()?;
        let spot = lowest.map(|spot| self.samples.spots[spot]);
        Ok(self.told(ruling, error_m2, (spot, light), shaded))
    }

    /// Some of the points whose number is below 0, spread evenly over their list.
    fn some_below(&self, number: usize) -> Result<Vec<(JudgedPoint, PointLight)>, SunError> {
        let values = &self.samples.values;
        let below: Vec<usize> = (0..values.len()).filter(|spot| values[*spot][number] < 0.0).collect();
        let some = below.iter().step_by(below.len().div_ceil(MOST_ASKED).max(1));
        let light = |spot: &usize| {
            let spot = &self.samples.spots[*spot];
            Ok((self.place.judged_now(spot), self.place.light(spot)?))
        };
        some.copied().collect::<Vec<_>>().par_iter().map(light).collect()
    }

    fn told(
        &self,
        ruling: Ruling,
        error_m2: f64,
        (spot, light): (Option<AreaSpot>, Option<PointLight>),
        shaded: Vec<(JudgedPoint, PointLight)>,
    ) -> AreaAnswer {
        let counts = light.as_ref().map(|light| light.counted().counts(self.judging.rule, self.judging.days.days));
        let receiver = ReceiverRuling {
            name: String::new(),
            kind: JudgedThing::Area,
            ruling,
            area: Some(AreaSize { points: self.samples.values.len(), error_m2, ..self.size }),
            points: spot.iter().map(|spot| self.place.judged_now(spot).point).collect(),
            normal: spot.and_then(|spot| spot.normal),
            room: None,
            dwelling: None,
            usage: None,
            counts: counts.unwrap_or_default(),
            spells: Vec::new(),
            takers: Vec::new(),
        };
        AreaAnswer { receiver, light, shaded }
    }

    fn load(mut self, steps: &mut Steps<'_, '_>) -> Result<AreaAnswer, StudyError> {
        let judging = self.judging;
        let days = judging.days.days;
        // the first number is the sum of all days, which alone decides which triangles are split
        let value = |spot: &AreaSpot| -> Result<Vec<f64>, SunError> {
            let light = self.place.light(spot)?.counted();
            let secs = |day: usize| total_secs(&light.new_shadow(day)) as f64;
            let mut found: Vec<f64> = (0..days.len()).map(secs).collect();
            let sum = found.iter().sum();
            found.insert(0, sum);
            Ok(found)
        };
        let open: i64 = days.iter().map(|day| total_secs(&day.windows)).sum();
        let enough = 1e-6 * self.size.m2 * open as f64;
        let allowed = |sum: f64| (GOOD_LOAD * sum).max(enough);
        self.samples.refine(&value, (&allowed, MOST_POINTS_OF_SUMS), steps)?;
        let sums = self.samples.sums(days.len() + 1);
        let each_error = sums.errors[0] / days.len().max(1) as f64;
        let of = |(at, day)| ShadowLoad { day, m2_secs: sums.sums[at + 1], error_m2_secs: each_error };
        let loads: Vec<ShadowLoad<'_>> = days.iter().enumerate().map(of).collect();
        let ruling = judging.rule.judge_load(self.size.m2, &loads)?;
        let most = self.samples.values.iter().enumerate().max_by(|one, other| one.1[0].total_cmp(&other.1[0]));
        let spot = most.map(|(spot, _)| self.samples.spots[spot]);
        let light = spot.map(|spot| self.place.light(&spot)).transpose()?;
        self.size.error_m2_secs = Some(sums.errors[0]);
        // takers are sought where new shadow lies
        self.samples.values.iter_mut().for_each(|values| values[0] = -values[0]);
        let shaded = if ruling.verdict == Verdict::Pass { Vec::new() } else { self.some_below(0)? };
        Ok(self.told(ruling, 0.0, (spot, light), shaded))
    }

    fn new_shadow(mut self, steps: &mut Steps<'_, '_>) -> Result<AreaAnswer, StudyError> {
        let judging = self.judging;
        let days = judging.days.days;
        let mut lights: Vec<CountedLight> = Vec::new();
        for some in self.samples.spots.chunks(POINTS_TOGETHER) {
            let light = |spot: &AreaSpot| Ok(self.place.light(spot)?.counted());
            lights.extend(some.par_iter().map(light).collect::<Result<Vec<_>, SunError>>()?);
            steps.poll()?;
        }
        let shaded_secs =
            |light: &CountedLight| (0..days.len()).map(|day| total_secs(&light.new_shadow(day))).sum::<i64>();
        self.samples.values = lights.iter().map(|light| vec![-(shaded_secs(light) as f64)]).collect();
        let any = CountedLight::any_with_new_shadow(&lights.iter().collect::<Vec<_>>(), days.len());
        let ruling = any.ruling(judging.rule, None, days)?;
        let mut answer = self.answer(ruling, 0.0, 0)?;
        answer.receiver.counts = any.counts(judging.rule, days);
        let light = answer.light.as_ref();
        let told = light.map(|light| light.told(0..days.len())).unwrap_or_default();
        let with = |spells: ReceiverSpells| ReceiverSpells { newly_shaded: any.newly_shaded_on(spells.day), ..spells };
        answer.receiver.spells = told.into_iter().map(with).collect();
        Ok(answer)
    }

    fn worst(mut self, steps: &mut Steps<'_, '_>) -> Result<AreaAnswer, StudyError> {
        let judging = self.judging;
        let ruling = |spot: &AreaSpot| -> Result<Ruling, StudyError> {
            Ok(self.place.light(spot)?.counted().ruling(judging.rule, None, judging.days.days)?)
        };
        if let Some(first) = self.samples.spots.first() {
            // an error about missing values is the same at all points
            ruling(first)?;
        }
        let value = |spot: &AreaSpot| -> Result<Vec<f64>, SunError> {
            let light = self.place.light(spot)?.counted();
            let ruling = light.ruling(judging.rule, None, judging.days.days);
            Ok(vec![ruling.map_or(0.0, |ruling| merit(&ruling).1)])
        };
        let (lowest, lowered) = self.samples.lowest(&value, steps)?;
        let mut worst = match self.samples.spots.get(lowest) {
            Some(spot) => ruling(spot)?,
            None => {
                return Err(RuleError::Needs {
                    rule: judging.rule.id.clone(),
                    needs: vec![RuleNeed::without_key("areas of more than 0 m²")],
                }
                .into());
            }
        };
        close_where_near(&mut worst, lowered);
        self.answer(worst, 0.0, 0)
    }
}

/// If the worst point's margin is smaller than what the last steps of the search lowered it by, there may be a worse
/// one.
pub(super) fn close_where_near(ruling: &mut Ruling, lowered: f64) {
    let (rank, margin) = merit(ruling);
    let is_near = ruling.verdict == Verdict::Pass && rank == 2 && margin >= 0.0 && margin < lowered;
    if is_near {
        ruling.verdict = Verdict::Close;
    }
}

/// The parts of an area that keep each criterion on each day, in one or both states.
fn lights<'d>(
    judging: &RuleOnSite<'d>,
    (asked, states): (&[(usize, usize)], usize),
    m2: f64,
    (sums, has_less): (&AreaSums, &[bool]),
) -> Vec<AreaLight<'d>> {
    let of_day = |(day, of): (usize, &'d RuleDay)| {
        let met = |number: usize| {
            let at = asked.iter().position(|one| *one == (day, number))? * states;
            let before_m2 = (states == 2).then(|| sums.sums[at + 1].min(m2));
            let error_m2 = sums.errors[at..at + states].iter().copied().fold(0.0, f64::max);
            Some(PartMet { now_m2: sums.sums[at].min(m2), before_m2, error_m2, has_less: has_less[at] })
        };
        AreaLight { day: of, met: (0..judging.rule.criteria.len()).map(met).collect() }
    };
    judging.days.days.iter().enumerate().map(of_day).collect()
}

/// The margin by which a point keeps each demand, in seconds, now and before.
fn margins(judging: &RuleOnSite<'_>, light: &CountedLight, asked: &[(usize, usize)]) -> Vec<f64> {
    let days = light.days(judging.days.days);
    let mut found = Vec::with_capacity(asked.len() * 2);
    for (day, number) in asked {
        let now = days[*day];
        found.push(margin(judging, *number, &now));
        if let Some(before) = now.before {
            found.push(margin(judging, *number, &DayLight { lit: before, ..now }));
        }
    }
    found
}

fn margin(judging: &RuleOnSite<'_>, number: usize, light: &DayLight<'_>) -> f64 {
    // a missing state before is an error that comes earlier
    let count = judging.rule.tally(number, light).unwrap_or_default();
    match judging.rule.criteria[number].demand {
        Demand::AtLeast { secs, longest_secs } => {
            let of_longest = if longest_secs > 0 { count.longest_secs - longest_secs } else { i64::MAX };
            (count.secs - secs).min(of_longest) as f64
        }
        Demand::AtMost(secs) => (secs - count.secs) as f64,
        Demand::ShareOfOpen(_) | Demand::Report { .. } => 0.0,
    }
}
