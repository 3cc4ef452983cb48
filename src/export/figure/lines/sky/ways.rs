//! The sun's ways in a chart.

use super::chart::SkyChart;
use super::context::SkyContext;
use super::tones::{CLOCK, SHADED, SUN, SUNDIAL, WAY};
use crate::export::figure::scale::mix;
use crate::export::figure::svg::{Block, INK};
use glam::DVec3;

impl SkyChart<'_> {
    /// The sun's ways, hours, and what the point sees of the requested days.
    pub(super) fn ways(&self, block: &mut Block, shown: &SkyContext) {
        let lines = shown.lines;
        for hour in lines.solar_hours.iter().filter(|_| !self.is_small()) {
            self.stroke(block, &self.hours(&hour.runs), 2.0, SUNDIAL, Some("9 7"));
        }
        for hour in &lines.clock_hours {
            self.stroke(block, &self.hours(&hour.runs), 2.0, CLOCK, None);
        }
        for (index, month) in lines.months.iter().enumerate() {
            let parts: Vec<_> = month.runs.iter().flat_map(|run| self.parts(run)).collect();
            self.stroke(block, &parts, 2.4, WAY, (index >= 6).then_some("16 8"));
        }
        for way in shown.ways {
            let parts: Vec<_> = way.way.runs.iter().flat_map(|run| self.parts(run)).collect();
            self.stroke(block, &parts, 6.0, SHADED, None);
        }
        for way in shown.ways {
            let parts: Vec<_> = way.lit.iter().flat_map(|run| self.parts(run)).collect();
            self.stroke(block, &parts, 15.0, mix(SUN, INK, 0.45), None);
            self.stroke(block, &parts, 11.0, SUN, None);
        }
    }

    fn hours<T>(&self, runs: &[Vec<(T, DVec3)>]) -> Vec<Vec<[f64; 2]>> {
        let of_run = |run: &Vec<(T, DVec3)>| self.parts(&run.iter().map(|(_, to)| *to).collect::<Vec<_>>());
        runs.iter().flat_map(of_run).collect()
    }
}
