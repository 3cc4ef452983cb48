//! The plane around a plot: the worst place of each band.

use super::super::StudyError;
use super::areas::close_where_near;
use super::judging::{BothStates, RuleOnSite, Steps};
use super::point_light::{CountedLight, PointLight, is_worse, merit};
use super::state_search::StateSearch;
use crate::judgement::{DeemedBorder, JudgedThing, PlotSpot, ReceiverRuling};
use crate::rules::{Band, HeightOver, RuleReceiver, Ruling, Spell};
use crate::site::JudgedPlot;
use crate::sun::SunError;
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// The distance between places along a band's inner line, metres.
const SPACING_M: f64 = 0.5;

/// The number of worst places around which worse ones are sought.
const STARTS: usize = 8;

/// The smallest step of the search around a place, metres.
const FINEST_M: f64 = 0.01;

/// The most steps of a search that moves from place to place.
const MOST_LOOKS: usize = 100;

/// Shadow is not sought farther out than this, metres.
const FARTHEST_M: f64 = 2000.0;

/// The number of places that are searched between two calls of the listener.
const TOGETHER: usize = 256;

/// The bands around a plot, ready to be searched.
pub(super) struct BandWork<'w> {
    judging: &'w RuleOnSite<'w>,
    border: DeemedBorder,
    /// The height of the plane where no neighbour raises it.
    plane_z: f64,
    bands: Vec<Band>,
    reach_m: f64,
    states: BothStates,
    /// When a sun that counts would shine with nothing in its way, on each day.
    open: Vec<Vec<Spell>>,
}

/// A place with its ruling.
#[derive(Clone)]
struct JudgedPlace {
    at: PlotSpot,
    ruling: Ruling,
}

impl<'w> BandWork<'w> {
    /// Returns `None` if the rule has no bands, or the site lacks something that it needs.
    pub(super) fn new(judging: &'w RuleOnSite<'w>, plot: &JudgedPlot) -> Option<BandWork<'w>> {
        let RuleReceiver::Lines { height_m, over, deemed, bands, corners } = &judging.rule.receiver else {
            return None;
        };
        let base = match over {
            HeightOver::Ground => judging.site.now.ground.level,
            HeightOver::MeanGround => plot.mean_ground?,
            HeightOver::Floor => return None,
        };
        let plane_z = base + height_m;
        let border = DeemedBorder::of(plot, *deemed, *corners);
        let top = judging.site.now.mesh.top();
        let low_deg = judging.days.lowest_deg().unwrap_or(90.0).max(0.5);
        let reach_m = ((top - plane_z).max(0.0) / low_deg.to_radians().tan()).min(FARTHEST_M);
        // casters may stand beyond the border, so shadows are measured from them
        let corners = border.corners();
        let far =
            |at: DVec2| [DVec2::new(1.0, 1.0), DVec2::new(-1.0, -1.0)].map(|way| at + way * (reach_m + FARTHEST_M));
        let points: Vec<DVec3> = corners.into_iter().flat_map(far).map(|at| at.extend(plane_z)).collect();
        let states = judging.states(&points);
        Some(BandWork {
            judging,
            border,
            plane_z,
            bands: bands.clone(),
            reach_m,
            states,
            open: judging.days.open(None),
        })
    }

    /// The number of bands.
    pub(super) fn count(&self) -> usize {
        self.bands.len()
    }

    /// Judges one band.
    pub(super) fn band(
        &self,
        number: usize,
        steps: &mut Steps<'_, '_>,
    ) -> Result<Option<(ReceiverRuling, PointLight)>, StudyError> {
        let band = self.bands[number];
        let spots = self.border.spots(band, self.reach_m + band.from_m, SPACING_M);
        let mut places = self.judged(&spots, number, steps)?;
        places.sort_by(|one, other| {
            merit(&one.ruling).partial_cmp(&merit(&other.ruling)).unwrap_or(std::cmp::Ordering::Equal)
        });
        places.truncate(STARTS);
        let mut worst: Option<(JudgedPlace, f64)> = None;
        for place in places {
            let found = self.lower(place, number)?;
            if worst.as_ref().is_none_or(|worst| is_worse(&found.0.ruling, &worst.0.ruling)) {
                worst = Some(found);
            }
            steps.poll()?;
        }
        steps.done(1)?;
        let Some((mut place, lowered)) = worst else { return Ok(None) };
        close_where_near(&mut place.ruling, lowered);
        let light = self.light(&place.at)?;
        let counted = light.counted();
        let end = if band.to_m.is_finite() { format!(" to {} m", band.to_m) } else { " m outward".to_owned() };
        let receiver = ReceiverRuling {
            name: format!("band {}, from {}{end}", number + 1, band.from_m),
            kind: JudgedThing::Band,
            ruling: place.ruling,
            area: None,
            points: vec![self.point(&place.at)],
            normal: None,
            room: None,
            dwelling: None,
            usage: None,
            counts: counted.counts(self.judging.rule, self.judging.days.days),
            spells: Vec::new(),
            takers: Vec::new(),
        };
        Ok(Some((receiver, light)))
    }

    fn judged(
        &self,
        spots: &[PlotSpot],
        number: usize,
        steps: &mut Steps<'_, '_>,
    ) -> Result<Vec<JudgedPlace>, StudyError> {
        let mut places = Vec::with_capacity(spots.len());
        for some in spots.chunks(TOGETHER) {
            let of = |at: &PlotSpot| self.judge(*at, number);
            places.extend(some.par_iter().map(of).collect::<Result<Vec<_>, StudyError>>()?);
            steps.poll()?;
        }
        Ok(places)
    }

    fn judge(&self, at: PlotSpot, number: usize) -> Result<JudgedPlace, StudyError> {
        let counted: CountedLight = self.light(&at)?.counted();
        let ruling = counted.ruling(self.judging.rule, Some(number), self.judging.days.days)?;
        Ok(JudgedPlace { at, ruling })
    }

    /// Searches around a place with steps that are halved. Returns the worst place, and how much worse the last two
    /// halvings made it.
    fn lower(&self, mut place: JudgedPlace, number: usize) -> Result<(JudgedPlace, f64), StudyError> {
        let band = self.bands[number];
        let mut step = SPACING_M.max(self.border.distance_m(place.at.at) * 0.05);
        let mut lowered = [0.0; 2];
        let mut looks = 0;
        while step >= FINEST_M && looks < MOST_LOOKS {
            looks += 1;
            let before = merit(&place.ruling).1;
            let around: Vec<PlotSpot> = (0..16)
                .map(|way| place.at.at + DVec2::from_angle(f64::from(way) * std::f64::consts::TAU / 16.0) * step)
                .map(|at| self.border.onto(band, at))
                .filter(|at| self.border.is_in(band, *at))
                .map(|at| self.border.spot(at))
                .collect();
            let found: Vec<JudgedPlace> =
                around.par_iter().map(|at| self.judge(*at, number)).collect::<Result<_, StudyError>>()?;
            let best =
                found.into_iter().reduce(|one, other| if is_worse(&other.ruling, &one.ruling) { other } else { one });
            match best.filter(|best| is_worse(&best.ruling, &place.ruling)) {
                Some(best) => place = best,
                None => step /= 2.0,
            }
            lowered = [lowered[1], (before - merit(&place.ruling).1).max(0.0)];
        }
        Ok((place, lowered.into_iter().sum()))
    }

    fn point(&self, at: &PlotSpot) -> DVec3 {
        at.at.extend(self.plane_z + at.raised_m)
    }

    fn light(&self, at: &PlotSpot) -> Result<PointLight, SunError> {
        let open = &self.open;
        let place = |search: &StateSearch| search.free(self.point(at), None);
        let (now, before) = self.states.lit(place, None, self.judging.days, open)?;
        Ok(PointLight { open: open.clone(), now, before })
    }
}
