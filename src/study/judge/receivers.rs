//! Judges all receivers of a rule.

use super::super::StudyError;
use super::area_light::reach_of;
use super::areas::area;
use super::bands::BandWork;
use super::facades::facade;
use super::judging::{RuleOnSite, Steps};
use super::open_spaces::{OpenSpace, of_dwellings, open_spaces};
use super::point_light::PointLight;
use super::state_search::WallPlane;
use super::windows::{WindowLight, wall_plane, windows};
use crate::judgement::{JudgedThing, ReceiverRuling};
use crate::rules::{RuleReceiver, Spell};
use crate::shadow::JUDGED_ABOVE_M;
use crate::sunlight::JudgedPoint;
use glam::DVec3;

/// The points at which a receiver's takers are sought: each by itself, or all together.
pub(super) struct ShadedReceiver {
    /// Each by itself; the mean over them is reported.
    pub(super) parts: Vec<ShadedSpells>,
    pub(super) wall: Option<WallPlane>,
}

/// Points of a receiver that is lit while all of them are.
pub(super) struct ShadedSpells {
    pub(super) points: Vec<JudgedPoint>,
    /// For each day, when a sun that counts would shine with nothing in its way.
    pub(super) open: Vec<Vec<Spell>>,
    /// For each day, when it does shine.
    pub(super) lit: Vec<Vec<Spell>>,
}

/// All receivers, judged.
pub(super) struct JudgedReceivers {
    pub(super) receivers: Vec<(ReceiverRuling, ShadedReceiver)>,
    /// For a rule of windows, the light of each, in the site's order.
    pub(super) windows: Vec<WindowLight>,
    /// For each open space of a dwelling its light.
    pub(super) open_spaces: Vec<(String, PointLight)>,
}

impl RuleOnSite<'_> {
    /// The number of receivers.
    pub(super) fn count(&self) -> usize {
        match &self.rule.receiver {
            RuleReceiver::Area { .. } => self.site.areas.len(),
            RuleReceiver::Facade => self.site.facades.len(),
            receiver @ RuleReceiver::Window { .. } => self.site.windows.len() + of_dwellings(receiver, self.site).len(),
            RuleReceiver::Lines { bands, .. } => bands.len(),
        }
    }
}

/// All receivers, in the site's order.
pub(super) fn found(judging: &RuleOnSite<'_>, steps: &mut Steps<'_, '_>) -> Result<JudgedReceivers, StudyError> {
    match &judging.rule.receiver {
        RuleReceiver::Area { .. } => of_areas(judging, steps),
        RuleReceiver::Facade => of_facades(judging, steps),
        RuleReceiver::Window { .. } => of_windows(judging, steps),
        RuleReceiver::Lines { .. } => of_bands(judging, steps),
    }
}

fn of_areas(judging: &RuleOnSite<'_>, steps: &mut Steps<'_, '_>) -> Result<JudgedReceivers, StudyError> {
    let site = judging.site;
    let states: Vec<_> = std::iter::once(&site.now).chain(judging.before).collect();
    let searches = judging.states(&reach_of(&site.areas, &states));
    let mut receivers = Vec::new();
    for of in &site.areas {
        let answer = area(judging, &searches, of, steps)?;
        let part = |(point, light): &(JudgedPoint, PointLight)| shaded_part(vec![*point], light);
        let parts = answer.shaded.iter().map(part).collect();
        let mut receiver = answer.receiver;
        if let Some(light) = answer.light.filter(|_| receiver.spells.is_empty()) {
            tell(judging, &mut receiver, &light);
        }
        receivers.push((receiver, ShadedReceiver { parts, wall: None }));
    }
    Ok(JudgedReceivers { receivers, windows: Vec::new(), open_spaces: Vec::new() })
}

fn of_facades(judging: &RuleOnSite<'_>, steps: &mut Steps<'_, '_>) -> Result<JudgedReceivers, StudyError> {
    let points: Vec<DVec3> = judging.site.facades.iter().flat_map(|facade| &facade.points).map(|[at, _]| *at).collect();
    let searches = judging.states(&points);
    let mut receivers = Vec::new();
    for of in &judging.site.facades {
        let judged = facade(judging, &searches, of, steps)?;
        receivers.extend(judged.map(|(receiver, light)| told(judging, receiver, &light)));
    }
    Ok(JudgedReceivers { receivers, windows: Vec::new(), open_spaces: Vec::new() })
}

fn of_bands(judging: &RuleOnSite<'_>, steps: &mut Steps<'_, '_>) -> Result<JudgedReceivers, StudyError> {
    let work = judging.site.plot.as_ref().and_then(|plot| BandWork::new(judging, plot));
    let mut receivers = Vec::new();
    for number in 0..work.as_ref().map_or(0, BandWork::count) {
        let band = work.as_ref().map(|work| work.band(number, steps)).transpose()?.flatten();
        receivers.extend(band.map(|(receiver, light)| told(judging, receiver, &light)));
    }
    Ok(JudgedReceivers { receivers, windows: Vec::new(), open_spaces: Vec::new() })
}

fn of_windows(judging: &RuleOnSite<'_>, steps: &mut Steps<'_, '_>) -> Result<JudgedReceivers, StudyError> {
    let lights = windows(judging, steps)?;
    let mut receivers = Vec::new();
    for (window, WindowLight { spot, light }) in judging.site.windows.iter().zip(&lights) {
        let counted = light.counted();
        let receiver = ReceiverRuling {
            name: window.name.clone(),
            kind: JudgedThing::Window,
            ruling: counted.ruling(judging.rule, None, judging.days.days)?,
            area: None,
            points: spot.points.clone(),
            normal: Some(window.outward),
            room: window.room.clone(),
            dwelling: window.dwelling.clone(),
            usage: window.usage.clone(),
            counts: counted.counts(judging.rule, judging.days.days),
            spells: Vec::new(),
            takers: Vec::new(),
        };
        let (receiver, shaded) = told(judging, receiver, light);
        receivers.push((receiver, ShadedReceiver { wall: wall_plane(spot), ..shaded }));
    }
    let mut spaces = Vec::new();
    for OpenSpace { dwelling, light, receiver } in open_spaces(judging, steps)? {
        receivers.push(told(judging, receiver, &light));
        spaces.push((dwelling, light));
    }
    Ok(JudgedReceivers { receivers, windows: lights, open_spaces: spaces })
}

/// A receiver that consists of points, with the spells of the days that are reported.
fn told(
    judging: &RuleOnSite<'_>,
    mut receiver: ReceiverRuling,
    light: &PointLight,
) -> (ReceiverRuling, ShadedReceiver) {
    tell(judging, &mut receiver, light);
    let normal = receiver.normal;
    let judged = |point: &DVec3| JudgedPoint {
        point: point + normal.unwrap_or(DVec3::ZERO) * JUDGED_ABOVE_M,
        normal,
        below_ground_m: None,
    };
    let points = receiver.points.iter().map(judged).collect();
    let parts = vec![shaded_part(points, light)];
    (receiver, ShadedReceiver { parts, wall: None })
}

fn shaded_part(points: Vec<JudgedPoint>, light: &PointLight) -> ShadedSpells {
    let counted = light.now.iter().map(|lit| crate::judgement::spells_of(lit)).collect();
    ShadedSpells { points, open: light.open.clone(), lit: counted }
}

/// The most days for which all spells are reported; if there are more, only those of the deciding day are.
const MOST_TOLD: usize = 8;

/// Which of the rule's days decides for a receiver: that of its deciding finding; if there is none, the day with the
/// least sun, or with the most shadow if that is counted.
pub(super) fn deciding_day(judging: &RuleOnSite<'_>, receiver: &ReceiverRuling) -> usize {
    let days = judging.days.days;
    let date = receiver.ruling.deciding.and_then(|at| receiver.ruling.findings[at].date);
    let of_date = date.and_then(|date| days.iter().position(|day| day.date == date));
    let counted = receiver.counts.iter().enumerate();
    let of_sun = judging.rule.counting.what == crate::rules::CountedTime::Sun;
    of_date.unwrap_or_else(|| {
        let by = |(_, count): &(usize, &crate::judgement::DayCount)| {
            if of_sun { count.now_secs } else { -count.now_secs }
        };
        counted.min_by_key(by).map_or(0, |(day, _)| day)
    })
}

fn tell(judging: &RuleOnSite<'_>, receiver: &mut ReceiverRuling, light: &PointLight) {
    let count = judging.days.days.len();
    receiver.spells = match count <= MOST_TOLD {
        true => light.told(0..count),
        false => light.told([deciding_day(judging, receiver)]),
    };
}
