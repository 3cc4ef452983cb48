//! The labels of a chart: months, hours of the clock and of the sundial, and the times at which the point's sun comes
//! and goes.

use super::chart::SkyChart;
use super::context::SkyContext;
use super::tones::{CLOCK, SUN, SUNDIAL, WAY};
use crate::export::figure::lines::labels::{self, Labels, Spot};
use crate::export::figure::scale::mix;
use crate::export::figure::svg::{GRAY, INK};
use crate::sun::Zone;
use crate::sunlight::{HourLine, ProbeWay};
use chrono::{DateTime, Datelike, NaiveDate};
use glam::DVec3;

/// Spells in the sun and gaps between them that are shorter than this have no times in a chart, where they would cover each
/// other, seconds. The panel and the answer have them.
const SHORT_SECS: i64 = 300;

/// The most times that are written in a chart; if there are more, the panel's table has those that fit, and the
/// command's answer has all.
const MOST_TIMES: usize = 12;

impl SkyChart<'_> {
    /// Lines that labels should not cover, and the letters at the rim, which they must not.
    pub(super) fn avoid(&self, labels: &mut Labels, shown: &SkyContext) {
        for label in self.rim_labels() {
            labels.cover(label.at, [0.7 * label.size, 0.5 * label.size]);
        }
        for run in shown.lines.months.iter().flat_map(|month| &month.runs) {
            self.parts(run).iter().for_each(|part| labels.avoid(part));
        }
        for run in shown.ways.iter().flat_map(|way| &way.way.runs) {
            // thick lines, which hide more
            self.parts(run).iter().for_each(|part| (0..4).for_each(|_| labels.avoid(part)));
        }
        let hours = shown.lines.clock_hours.iter().chain(&shown.lines.solar_hours);
        for run in hours.flat_map(|hour| &hour.runs) {
            let run: Vec<DVec3> = run.iter().map(|(_, to)| *to).collect();
            self.parts(&run).iter().for_each(|part| labels.avoid(part));
        }
    }

    /// Writes all labels, the most important first; a label that finds no room is left out.
    pub(super) fn mark(&self, labels: &mut Labels, shown: &SkyContext) {
        if !self.is_small() {
            if let [way] = shown.ways {
                self.times(labels, way);
            }
            for (said, at) in self.altitudes(shown.place.latitude_deg < 0.0) {
                labels.place(&said, GRAY, &mut [Spot { at, angle: 0.0, cost: 0.0 }]);
            }
        }
        let (sin, cos) = shown.place.latitude_deg.to_radians().sin_cos();
        let pole = DVec3::new(0.0, cos, sin);
        for hour in &shown.lines.clock_hours {
            self.clock_hour(labels, hour, pole);
        }
        if self.is_small() {
            return;
        }
        self.months(labels, shown);
        for hour in &shown.lines.solar_hours {
            self.solar_hour(labels, hour);
        }
    }

    /// The times at which the sun comes and goes, for more than a moment.
    fn times(&self, labels: &mut Labels, way: &ProbeWay) {
        let mut spells: Vec<[(DateTime<Zone>, DVec3); 2]> = Vec::new();
        for (interval, lit) in way.intervals.iter().zip(&way.lit) {
            let (Some(first), Some(last)) = (lit.first(), lit.last()) else { continue };
            let [start, end] = [(interval.start, *first), (interval.end, *last)];
            match spells.last_mut().filter(|before| secs([before[1], start]) < SHORT_SECS) {
                Some(before) => before[1] = end,
                None => spells.push([start, end]),
            }
        }
        spells.retain(|spell| secs(*spell) >= SHORT_SECS);
        for (time, to) in spells.into_iter().flatten().take(MOST_TIMES) {
            let at = self.place(to);
            let mut spots = around(at, &[44.0, 62.0, 84.0]);
            labels.place(&time.format("%H:%M").to_string(), mix(SUN, INK, 0.62), &mut spots);
        }
    }

    /// The hour of the clock, at both ends of its line: in June and in December, by the clock of those days.
    fn clock_hour(&self, labels: &mut Labels, hour: &HourLine, pole: DVec3) {
        for (month, sign) in [(6, 1.0), (12, -1.0)] {
            let is_there = |(date, _): &&(NaiveDate, DVec3)| date.month() == month && date.day() == 21;
            let Some((_, to)) = hour.runs.iter().flatten().find(is_there) else { continue };
            // away from the ways of the other days: towards the celestial pole, or away from it
            let (at, beyond) = (self.place(*to), self.place((*to + pole * 0.02 * sign).normalize_or(*to)));
            let out = [beyond[0] - at[0], beyond[1] - at[1]];
            let length = out[0].hypot(out[1]);
            if length < 1e-6 || length > self.size()[0] / 2.0 {
                continue;
            }
            let out = out.map(|part| part / length);
            let mut spots = Vec::new();
            for away in [26.0, 36.0, 48.0].map(|away| away * self.pen) {
                for aside in [0.0, -16.0, 16.0].map(|aside| aside * self.pen) {
                    let at = [at[0] + out[0] * away - out[1] * aside, at[1] + out[1] * away + out[0] * aside];
                    spots.push(Spot { at, angle: 0.0, cost: away + f64::abs(aside) });
                }
            }
            labels.place(&hour.hour.to_string(), CLOCK, &mut spots);
        }
    }

    /// The dates of the ways, written on them: in the afternoon for the first half of the year, in the morning for the
    /// second.
    fn months(&self, labels: &mut Labels, shown: &SkyContext) {
        for (index, month) in shown.lines.months.iter().enumerate() {
            let said = month.date.format("%-d %b").to_string();
            let width = 2.0 * labels.half(&said)[0];
            let parts: Vec<_> = month.runs.iter().flat_map(|run| self.parts(run)).collect();
            let Some(part) = parts.iter().max_by(|a, b| length(a).total_cmp(&length(b))) else { continue };
            let all = length(part);
            let range = if index < 6 { [0.55 * all, 0.97 * all] } else { [0.03 * all, 0.45 * all] };
            let is_placed = labels.place(&said, WAY, &mut labels::along(part, range, width));
            if !is_placed {
                labels.place(&said, WAY, &mut labels::along(part, [0.0, all], width));
            }
        }
    }

    /// The hour of the sundial, in Roman numerals as sundials have it, on its line.
    fn solar_hour(&self, labels: &mut Labels, hour: &HourLine) {
        let Some(run) = hour.runs.iter().max_by_key(|run| run.len()) else { return };
        let places: Vec<[f64; 2]> = run.iter().map(|(_, to)| self.place(*to)).collect();
        let mut spots: Vec<Spot> = Vec::new();
        for ends in places.windows(2).filter(|ends| (ends[0][0] - ends[1][0]).abs() < self.size()[0] / 2.0) {
            for share in [0.0, 0.25, 0.5, 0.75] {
                let at = [0, 1].map(|axis| ends[0][axis] + (ends[1][axis] - ends[0][axis]) * share);
                spots.push(Spot { at, angle: 0.0, cost: 0.0 });
            }
        }
        labels.place(roman(hour.hour), SUNDIAL, &mut spots);
    }
}

fn secs([from, to]: [(DateTime<Zone>, DVec3); 2]) -> i64 {
    (to.0 - from.0).num_seconds()
}

/// Positions around a point, at a distance.
fn around([x, y]: [f64; 2], away: &[f64]) -> Vec<Spot> {
    let directions =
        [[0.0, -1.0], [0.0, 1.0], [1.25, 0.0], [-1.25, 0.0], [0.9, -0.8], [-0.9, -0.8], [0.9, 0.8], [-0.9, 0.8]];
    let at = |away: f64| {
        directions.map(|[across, down]| Spot { at: [x + across * away, y + down * away], angle: 0.0, cost: away })
    };
    away.iter().flat_map(|away| at(*away)).collect()
}

fn length(part: &[[f64; 2]]) -> f64 {
    part.windows(2).map(|ends| (ends[1][0] - ends[0][0]).hypot(ends[1][1] - ends[0][1])).sum()
}

/// An hour in Roman numerals; midnight is XXIV.
fn roman(hour: u32) -> &'static str {
    const ROMAN: [&str; 24] = [
        "XXIV", "I", "II", "III", "IV", "V", "VI", "VII", "VIII", "IX", "X", "XI", "XII", "XIII", "XIV", "XV", "XVI",
        "XVII", "XVIII", "XIX", "XX", "XXI", "XXII", "XXIII",
    ];
    ROMAN[hour as usize % 24]
}
