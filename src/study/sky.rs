//! The sky of points: what stands in front of each of them, and the sun's ways in it.

use super::StudyError;
use super::probe::{air, judged_points};
use crate::site::ProbeSite;
use crate::sunlight::{JudgedPoint, ProbeWay, SkyCaster, SkyLines, SkyRaster, Sunlight};
use crate::view::{Probe, SkyPicture};
use chrono::Datelike;

/// The most ways of requested days in one chart; more would cover each other.
pub const MOST_WAYS: usize = 12;

/// The skies of the points of an answer.
pub struct SkySearch<'a> {
    asked: &'a ProbeSite,
    sunlight: &'a Sunlight,
    points: Vec<JudgedPoint>,
    caster: SkyCaster,
}

impl<'a> SkySearch<'a> {
    /// The skies of the points that were searched.
    pub fn new(asked: &'a ProbeSite, sunlight: &'a Sunlight) -> SkySearch<'a> {
        let probes: Vec<Probe> = sunlight.probes.iter().map(|probed| probed.probe.clone()).collect();
        let points = judged_points(asked, &probes);
        let caster = SkyCaster::new(asked.mesh.of_components(&asked.casts), &points);
        SkySearch { asked, sunlight, points, caster }
    }

    /// The lines that all points share: of the year of the first requested day.
    ///
    /// # Errors
    /// [`StudyError`].
    pub fn lines(&self) -> Result<SkyLines, StudyError> {
        let year = self.sunlight.days.first().map_or(2000, |day| day.window.day.date.year());
        Ok(SkyLines::of_year(&self.asked.place, year, air(self.asked))?)
    }

    /// What stands in front of a point, in each of some pictures.
    pub fn rasters<const N: usize>(&self, probe: usize, pictures: [SkyPicture; N]) -> [SkyRaster; N] {
        pictures.map(|picture| self.caster.raster(&self.points[probe], picture))
    }

    /// The sun's ways on the requested days, with what a point sees of them; if there are more than [`MOST_WAYS`] days,
    /// evenly chosen ones, with the first and the last among them.
    ///
    /// # Errors
    /// [`StudyError`].
    pub fn ways(&self, probe: usize) -> Result<Vec<ProbeWay>, StudyError> {
        let days = self.sunlight.days.len();
        let count = days.min(MOST_WAYS);
        let chosen = (0..count).map(|at| if count > 1 { at * (days - 1) / (count - 1) } else { at });
        let of_day = |day: usize| {
            let intervals = &self.sunlight.probes[probe].days[day];
            Ok(ProbeWay::of(&self.asked.place, &self.sunlight.days[day], intervals, air(self.asked))?)
        };
        chosen.map(of_day).collect()
    }
}
