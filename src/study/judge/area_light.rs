//! The light of points on areas.

use super::judging::{BothStates, RuleOnSite};
use super::point_light::PointLight;
use super::samples::AreaSpot;
use super::state_search::StateSearch;
use crate::judgement::PartTriangle;
use crate::rules::Spell;
use crate::site::{AreaSurface, JudgedArea, JudgedState};
use crate::sun::SunError;
use crate::sunlight::JudgedPoint;
use glam::DVec3;
use std::collections::HashMap;

/// The light of areas in both states.
pub(super) type AreaStates = BothStates;

/// Points that bound all points of the areas.
pub(super) fn reach_of(areas: &[JudgedArea], states: &[&JudgedState]) -> Vec<DVec3> {
    let bounds = states.iter().filter_map(|state| state.mesh.bounds());
    let heights: Vec<f64> =
        bounds.flat_map(|(low, high)| [low.z, high.z]).chain(states.iter().map(|state| state.ground.level)).collect();
    let mut points = Vec::new();
    for area in areas {
        let corners = area.rings.iter().flatten();
        let level = if let AreaSurface::Level(z) | AreaSurface::Ground(z) = area.surface { z } else { 0.0 };
        points.extend(corners.flat_map(|corner| heights.iter().map(|z| corner.extend(z + level.abs()))));
        if let AreaSurface::Faces(faces) = &area.surface {
            points.extend(faces.iter().flatten());
        }
    }
    points
}

/// An area, ready to be searched.
pub(super) struct AreaPlace<'a> {
    judging: &'a RuleOnSite<'a>,
    states: &'a AreaStates,
    surface: &'a AreaSurface,
    /// When a sun that counts would shine with nothing in its way, for each slope.
    open: HashMap<[u64; 3], Vec<Vec<Spell>>>,
}

fn slope(normal: Option<DVec3>) -> [u64; 3] {
    normal.map_or([0; 3], |normal| normal.to_array().map(f64::to_bits))
}

impl<'a> AreaPlace<'a> {
    pub(super) fn new(
        judging: &'a RuleOnSite<'a>,
        states: &'a AreaStates,
        surface: &'a AreaSurface,
        parts: &[PartTriangle],
    ) -> AreaPlace<'a> {
        let mut open = HashMap::new();
        for part in parts {
            open.entry(slope(part.normal)).or_insert_with(|| judging.days.open_on_area(part.normal));
        }
        AreaPlace { judging, states, surface, open }
    }

    /// The times at which a point is lit.
    pub(super) fn light(&self, spot: &AreaSpot) -> Result<PointLight, SunError> {
        let open = &self.open[&slope(spot.normal)];
        let at = |search: &StateSearch| self.judged(search, spot);
        let (now, before) = self.states.lit(at, None, self.judging.days, open)?;
        Ok(PointLight { open: open.clone(), now, before })
    }

    /// Where a point is judged in the state that is judged.
    pub(super) fn judged_now(&self, spot: &AreaSpot) -> JudgedPoint {
        self.judged(&self.states.now, spot)
    }

    /// Where a point is judged in a given state.
    fn judged(&self, search: &StateSearch, spot: &AreaSpot) -> JudgedPoint {
        match (self.surface, spot.normal) {
            (AreaSurface::Level(z), _) => search.at_level(spot.at.with_z(*z)),
            (AreaSurface::Ground(above), _) => search.above_ground(spot.at, *above),
            (AreaSurface::Faces(_), Some(normal)) => search.in_plane(spot.at, normal),
            (AreaSurface::Faces(_), None) => search.at_level(spot.at),
        }
    }
}
