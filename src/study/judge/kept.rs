//! What must keep its sun by a rule or for given hours: the places of each receiver, and how much sun must stay at which times.

use super::super::envelope::{DaysNeeded, KeptPlace, KeptThing, SunNeeded};
use super::super::{OnEvent, StudyError, note_models};
use super::area_light::{AreaPlace, reach_of};
use super::days::{JudgedDays, hulls};
use super::judging::{BothStates, RuleOnSite, Steps};
use super::kept_demand::{RuleDemand, days_needed, needed_weight};
use super::needs;
use super::open_spaces::of_dwellings;
use super::point_light::PointLight;
use super::samples::AreaSpot;
use super::windows::{WindowLight, windows};
use crate::judgement::{CountedParts, DeemedBorder, PartTriangle, PlotSpot};
use crate::rules::{Band, HeightOver, KEEP_HOURS, ResolvedRule, RuleDay, RuleError, RuleNeed, RuleReceiver, SunDemand};
use crate::shadow::JUDGED_ABOVE_M;
use crate::site::{JudgedArea, JudgedPlot, JudgedSite, JudgedWindow};
use glam::DVec3;
use rayon::prelude::*;

/// What must keep its sun, and on which days.
pub struct KeptByDemand {
    /// Each receiver.
    pub things: Vec<KeptThing>,
    /// Whether all of the days count, or one of them.
    pub needed: DaysNeeded,
    /// The days on which it counts.
    pub days: Vec<RuleDay>,
}

/// Places on an area: this many along the side of a square of the same size, but no closer together than this, metres.
const ACROSS: f64 = 16.0;
const LEAST_M: f64 = 0.25;

/// The distance between places along the lines around a plot, metres.
const SPACING_M: f64 = 2.0;

/// Shadow is not sought farther out than this, metres, nor for a lower sun than this, degrees.
const FARTHEST_M: f64 = 2000.0;
const LOWEST_DEG: f64 = 0.5;

/// The number of places that are searched between two calls of the listener.
const TOGETHER: usize = 64;

/// The plot on which something is to be built such that all that is protected keeps its sun.
///
/// # Errors
/// [`StudyError`] with everything that the demand needs and the site lacks.
pub fn plot_to_build_on<'s>(site: &'s JudgedSite, demand: SunDemand<'_>) -> Result<&'s JudgedPlot, StudyError> {
    let missing = || RuleNeed::of_key("the plot that is built on", "[plot]", "");
    let mut needs = match demand {
        SunDemand::Rule(_, rule) => needs::lacking(rule, site),
        SunDemand::Hours(..) if rules_of(site, demand).is_empty() => vec![RuleNeed::of_key(
            "a window, an area or a façade, whose sun is to stay",
            "[[window]], [[area]] or [[facade]]",
            "",
        )],
        SunDemand::Hours(..) => Vec::new(),
    };
    let knows_plot = needs.iter().any(|need| need.said_at == missing().said_at);
    needs.extend((site.plot.is_none() && !knows_plot).then(missing));
    match (&site.plot, demand) {
        (Some(plot), _) if needs.is_empty() => Ok(plot),
        (_, SunDemand::Rule(_, rule)) => Err(RuleError::Needs { rule: rule.id.clone(), needs }.into()),
        (_, SunDemand::Hours(..)) => Err(StudyError::hours_need(&needs)),
    }
}

/// The rule that is asked; or, for given hours, one for each kind of thing that the site has.
fn rules_of(site: &JudgedSite, demand: SunDemand<'_>) -> Vec<ResolvedRule> {
    let has = |receiver: &RuleReceiver| match receiver {
        RuleReceiver::Window { .. } => !site.windows.is_empty(),
        RuleReceiver::Facade => !site.facades.is_empty(),
        RuleReceiver::Area { .. } => !site.areas.is_empty(),
        RuleReceiver::Lines { .. } => site.plot.is_some(),
    };
    match demand {
        SunDemand::Rule(_, rule) => vec![rule.clone()],
        SunDemand::Hours(secs, _) => {
            KEEP_HOURS.into_iter().filter(has).map(|receiver| ResolvedRule::of_hours(receiver, secs)).collect()
        }
    }
}

/// Finds what is protected on a site. The lines around the plot reach as far as the shadow of something `highest_m`
/// high.
///
/// # Errors
/// [`StudyError`]; [`StudyError::NoEnvelope`] if a rule does not say how much sun must stay.
pub fn kept_by(
    site: &JudgedSite,
    demand: SunDemand<'_>,
    highest_m: f64,
    on_event: &mut OnEvent<'_>,
) -> Result<KeptByDemand, StudyError> {
    note_models(&site.notes, on_event)?;
    plot_to_build_on(site, demand)?;
    let (needed, calendar, hulls) = match demand {
        SunDemand::Rule(_, rule) => {
            let needed = days_needed(rule)?;
            let calendar = rule.calendar(&site.place, site.year)?;
            let hulls = hulls(&site.place, &calendar)?;
            (needed, calendar, hulls)
        }
        SunDemand::Hours(_, days) => (DaysNeeded::Each, days.iter().map(RuleDay::of_hours).collect(), days.to_vec()),
    };
    let rules = rules_of(site, demand);
    let cuts = rules.first().map(|rule| rule.cuts).unwrap_or_default();
    let days = JudgedDays::new(site, cuts, &calendar, &hulls)?;
    let judgings: Vec<RuleOnSite<'_>> =
        rules.iter().map(|rule| RuleOnSite { site, rule, days: &days, before: None }).collect();
    // by night nothing bounds the heights, which would look like an answer
    let has_sun = days.open(None).iter().any(|spells| !spells.is_empty());
    let Some(first) = hulls.first().filter(|_| has_sun) else { return Err(StudyError::NoDay) };
    let mut steps = Steps::new(on_event, judgings.iter().map(RuleOnSite::count).sum(), first.from)?;
    let mut things = Vec::new();
    for judging in &judgings {
        things.extend(match &judging.rule.receiver {
            RuleReceiver::Window { .. } => of_windows(judging, &mut steps)?,
            RuleReceiver::Facade => of_facades(judging, &mut steps)?,
            RuleReceiver::Area { .. } => of_areas(judging, needed, &mut steps)?,
            RuleReceiver::Lines { .. } => of_lines(judging, highest_m, &mut steps)?,
        });
    }
    Ok(KeptByDemand { things, needed, days: calendar })
}

/// A place, from its light.
fn place(
    judging: &RuleOnSite<'_>,
    demand: &RuleDemand,
    (weight, points): (f64, Vec<DVec3>),
    light: &PointLight,
) -> Result<KeptPlace, StudyError> {
    let of_day = |(day, at): (&RuleDay, usize)| -> Result<SunNeeded, StudyError> {
        demand.on(judging.rule, day, &light.open[at], &light.now[at])
    };
    let days = judging.days.days.iter().zip(0..).map(of_day).collect::<Result<_, _>>()?;
    Ok(KeptPlace { weight, points, around_m: 0.0, days })
}

/// A thing whose places must all keep their sun.
fn whole(name: String, places: Vec<KeptPlace>) -> KeptThing {
    let needed = places.iter().map(|place| place.weight).sum();
    KeptThing { name, places, needed }
}

fn of_windows(judging: &RuleOnSite<'_>, steps: &mut Steps<'_, '_>) -> Result<Vec<KeptThing>, StudyError> {
    let demand = RuleDemand::of(judging.rule, None)?;
    let lights = windows(judging, steps)?;
    let of = |(window, found): (&JudgedWindow, &WindowLight)| {
        let before = if found.spot.through.is_some() { DVec3::ZERO } else { window.outward * JUDGED_ABOVE_M };
        let points = found.spot.points.iter().map(|point| point + before).collect();
        Ok(whole(window.name.clone(), vec![place(judging, &demand, (1.0, points), &found.light)?]))
    };
    let mut things = judging.site.windows.iter().zip(&lights).map(of).collect::<Result<Vec<_>, StudyError>>()?;
    if let RuleReceiver::Window { open_spaces: Some(open_spaces), .. } = &judging.rule.receiver {
        let states = judging.states(&reach_of(&judging.site.areas, &[&judging.site.now]));
        for area in of_dwellings(&judging.rule.receiver, judging.site) {
            let places = of_area(judging, (&demand, &states), area, steps)?;
            let m2: f64 = places.iter().map(|place| place.weight).sum();
            // at least one place, if any part is enough
            let least = places.iter().map(|place| place.weight).fold(f64::INFINITY, f64::min);
            things.push(KeptThing {
                name: area.name.clone(),
                places,
                needed: open_spaces.least_lit_m2.max(least).min(m2),
            });
            steps.done(1)?;
        }
    }
    Ok(things)
}

fn of_facades(judging: &RuleOnSite<'_>, steps: &mut Steps<'_, '_>) -> Result<Vec<KeptThing>, StudyError> {
    let demand = RuleDemand::of(judging.rule, None)?;
    let all: Vec<DVec3> = judging.site.facades.iter().flat_map(|facade| &facade.points).map(|[at, _]| *at).collect();
    let states = judging.states(&all);
    let mut things = Vec::new();
    for facade in &judging.site.facades {
        let of = |[at, normal]: &[DVec3; 2]| -> Result<_, StudyError> {
            let (judged, open) = (states.now.in_plane(*at, *normal), judging.days.open(Some(*normal)));
            let now = states.now.lit(&judged, judging.days, &open)?;
            place(judging, &demand, (1.0, vec![judged.point]), &PointLight { open, now, before: None })
        };
        let places = in_steps(&facade.points, steps, of)?;
        things.push(whole(facade.name.clone(), places));
        steps.done(1)?;
    }
    Ok(things)
}

fn of_areas(
    judging: &RuleOnSite<'_>,
    needed: DaysNeeded,
    steps: &mut Steps<'_, '_>,
) -> Result<Vec<KeptThing>, StudyError> {
    let demand = RuleDemand::of(judging.rule, None)?;
    let site = judging.site;
    let states = judging.states(&reach_of(&site.areas, &[&site.now]));
    let mut things = Vec::new();
    for area in &site.areas {
        let places = of_area(judging, (&demand, &states), area, steps)?;
        let weight = needed_weight(judging.rule, &demand, &places, needed);
        things.push(KeptThing { name: area.name.clone(), places, needed: weight });
        steps.done(1)?;
    }
    Ok(things)
}

fn of_area(
    judging: &RuleOnSite<'_>,
    (demand, states): (&RuleDemand, &BothStates),
    area: &JudgedArea,
    steps: &mut Steps<'_, '_>,
) -> Result<Vec<KeptPlace>, StudyError> {
    let counted = CountedParts::of(&judging.rule.receiver, area);
    let (parts, m2) = (&counted.triangles, counted.m2());
    let on = AreaPlace::new(judging, states, &area.surface, parts);
    let parts = small_parts(parts, (m2.sqrt() / ACROSS).max(LEAST_M));
    let of = |triangle: &PartTriangle| -> Result<_, StudyError> {
        let at = triangle.corners.iter().sum::<DVec3>() / 3.0;
        let spot = AreaSpot { at, normal: triangle.normal };
        // all of the triangle keeps the sun of its middle, from its lowest corner on
        let away = |corner: &DVec3| corner.truncate().distance(at.truncate());
        let around_m = triangle.corners.iter().map(away).fold(0.0, f64::max);
        let lower_m = triangle.corners.iter().map(|corner| at.z - corner.z).fold(0.0, f64::max);
        let point = on.judged_now(&spot).point - DVec3::Z * lower_m;
        let place = place(judging, demand, (triangle.m2, vec![point]), &on.light(&spot)?)?;
        Ok(KeptPlace { around_m, ..place })
    };
    in_steps(&parts, steps, of)
}

/// Cuts triangles into those whose sides are at most this long.
fn small_parts(parts: &[PartTriangle], longest_m: f64) -> Vec<PartTriangle> {
    let mut small = Vec::new();
    let mut waiting: Vec<PartTriangle> = parts.to_vec();
    while let Some(part) = waiting.pop() {
        let PartTriangle { corners, m2, .. } = part;
        let length = |first: usize| corners[first].distance(corners[(first + 1) % 3]);
        let longest = (0..3).max_by(|one, other| length(*one).total_cmp(&length(*other))).unwrap_or(0);
        if length(longest) <= longest_m {
            small.push(part);
            continue;
        }
        let [a, b, c] = [0, 1, 2].map(|step| corners[(longest + step) % 3]);
        let middle = (a + b) / 2.0;
        let half = |corners: [DVec3; 3]| PartTriangle { corners, m2: m2 / 2.0, ..part };
        waiting.extend([half([a, middle, c]), half([middle, b, c])]);
    }
    small
}

fn of_lines(judging: &RuleOnSite<'_>, highest_m: f64, steps: &mut Steps<'_, '_>) -> Result<Vec<KeptThing>, StudyError> {
    let RuleReceiver::Lines { height_m, over, deemed, bands, corners } = &judging.rule.receiver else {
        return Ok(Vec::new());
    };
    let Some(plot) = &judging.site.plot else { return Ok(Vec::new()) };
    let Some(base) = base_of(judging.site, plot, *over) else { return Ok(Vec::new()) };
    let border = DeemedBorder::of(plot, *deemed, *corners);
    let open = judging.days.open(None);
    let low_deg = judging.days.lowest_deg().unwrap_or(90.0).max(LOWEST_DEG);
    let reach_m = (highest_m / low_deg.to_radians().tan()).min(FARTHEST_M);
    let mut things = Vec::new();
    for (number, band) in bands.iter().enumerate() {
        let demand = RuleDemand::of(judging.rule, Some(number))?;
        let spots = border.spots(*band, band.from_m + reach_m, SPACING_M);
        let point = |spot: &PlotSpot| spot.at.extend(base + height_m + spot.raised_m);
        let states = judging.states(&spots.iter().map(point).collect::<Vec<_>>());
        let of = |spot: &PlotSpot| -> Result<_, StudyError> {
            let judged = states.now.free(point(spot), None);
            let now = states.now.lit(&judged, judging.days, &open)?;
            let light = PointLight { open: open.clone(), now, before: None };
            // it stands for the line as far as halfway to its neighbours
            let around_m = DeemedBorder::spacing_m(border.distance_m(spot.at), SPACING_M) / 2.0;
            let place = place(judging, &demand, (1.0, vec![judged.point]), &light)?;
            Ok(KeptPlace { around_m, ..place })
        };
        let places = in_steps(&spots, steps, of)?;
        things.push(whole(named(number, *band), places));
        steps.done(1)?;
    }
    Ok(things)
}

fn base_of(site: &JudgedSite, plot: &JudgedPlot, over: HeightOver) -> Option<f64> {
    match over {
        HeightOver::Ground => Some(site.now.ground.level),
        HeightOver::MeanGround => plot.mean_ground,
        HeightOver::Floor => None,
    }
}

fn named(number: usize, band: Band) -> String {
    let end = if band.to_m.is_finite() { format!(" to {} m", band.to_m) } else { " m outward".to_owned() };
    format!("band {}, from {}{end}", number + 1, band.from_m)
}

/// Searches many places, and gives the listener chances to stop the work.
fn in_steps<T: Sync>(
    all: &[T],
    steps: &mut Steps<'_, '_>,
    of: impl Fn(&T) -> Result<KeptPlace, StudyError> + Sync,
) -> Result<Vec<KeptPlace>, StudyError> {
    let mut places = Vec::with_capacity(all.len());
    for some in all.chunks(TOGETHER) {
        places.extend(some.par_iter().map(&of).collect::<Result<Vec<_>, _>>()?);
        steps.poll()?;
    }
    Ok(places)
}
