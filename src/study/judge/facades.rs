//! Façades: all their points must keep the rule, and the worst one is reported.

use super::super::StudyError;
use super::judging::{BothStates, RuleOnSite, Steps};
use super::point_light::{CountedLight, PointLight, is_worse};
use super::state_search::StateSearch;
use crate::judgement::{JudgedThing, ReceiverRuling};
use crate::rules::Ruling;
use crate::site::JudgedFacade;
use glam::DVec3;
use rayon::prelude::*;

/// The number of points that are searched between two calls of the listener.
const TOGETHER: usize = 64;

/// The worst point of a receiver that consists of points.
struct Worst {
    point: [DVec3; 2],
    light: PointLight,
    counted: CountedLight,
    ruling: Ruling,
}

/// Judges one façade by its points.
pub(super) fn facade(
    judging: &RuleOnSite<'_>,
    searches: &BothStates,
    facade: &JudgedFacade,
    steps: &mut Steps<'_, '_>,
) -> Result<Option<(ReceiverRuling, PointLight)>, StudyError> {
    let mut worst: Option<Worst> = None;
    for some in facade.points.chunks(TOGETHER) {
        let found: Vec<Worst> =
            some.par_iter().map(|point| of_point(judging, searches, *point)).collect::<Result<_, StudyError>>()?;
        for one in found {
            if worst.as_ref().is_none_or(|worst| is_worse(&one.ruling, &worst.ruling)) {
                worst = Some(one);
            }
        }
        steps.poll()?;
    }
    steps.done(1)?;
    Ok(worst.map(|Worst { point: [point, normal], light, counted, ruling }| {
        let receiver = ReceiverRuling {
            name: facade.name.clone(),
            kind: JudgedThing::Facade,
            ruling,
            area: None,
            points: vec![point],
            normal: Some(normal),
            room: None,
            dwelling: None,
            usage: None,
            counts: counted.counts(judging.rule, judging.days.days),
            spells: Vec::new(),
            takers: Vec::new(),
        };
        (receiver, light)
    }))
}

fn of_point(judging: &RuleOnSite<'_>, searches: &BothStates, point: [DVec3; 2]) -> Result<Worst, StudyError> {
    let open = judging.days.open(Some(point[1]));
    let at = |search: &StateSearch| search.in_plane(point[0], point[1]);
    let (now, before) = searches.lit(at, None, judging.days, &open)?;
    let light = PointLight { open, now, before };
    let counted = light.counted();
    let ruling = counted.ruling(judging.rule, None, judging.days.days)?;
    Ok(Worst { point, light, counted, ruling })
}
