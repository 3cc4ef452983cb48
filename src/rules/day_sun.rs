//! When the sun counts on a day for a receiver that nothing obstructs.

use super::cuts::SunCuts;
use super::resolved::RuleDay;
use super::spell::{Spell, common, merged};
use crate::sun::{Instant, Sky, SunError};
use chrono::{DateTime, TimeZone};
use glam::DVec3;

/// In a minute the sun moves by a quarter of a degree, and almost along a line.
const STEP_SECS: i64 = 60;

/// The sun in the windows of a day, minute by minute: computed once for all receivers.
#[derive(Clone, Debug)]
pub struct DaySun {
    windows: Vec<Spell>,
    minutes: Vec<SunMinute>,
}

/// The sun at a second since 1970.
#[derive(Clone, Copy, Debug)]
struct SunMinute {
    secs: i64,
    to_sun: DVec3,
    altitude_deg: f64,
}

impl DaySun {
    /// Computes the sun in all windows of a day, and in those of single criteria.
    ///
    /// # Errors
    /// A year outside 1600 to 2999.
    pub fn of(sky: &Sky, day: &RuleDay) -> Result<DaySun, SunError> {
        let own = day.criteria.iter().flatten().flatten();
        let windows = merged(day.windows.iter().chain(own).copied());
        let mut minutes = Vec::new();
        for window in &windows {
            let inner = (window.start..window.end).step_by(STEP_SECS as usize);
            for secs in inner.chain([window.end]) {
                minutes.push(SunMinute::at(sky, secs)?);
            }
        }
        Ok(DaySun { windows, minutes })
    }

    /// Returns the spells, to the second, in which the sun is up and the cuts admit it, and in which it is in front of
    /// the plane if there is an outward normal. The altitude is the apparent one if the sky has air.
    pub fn open(&self, cuts: &SunCuts, outward: Option<DVec3>) -> Vec<Spell> {
        self.when(|sun| {
            // below 0 it is night, as in every study
            sun.altitude_deg >= 0.0 && cuts.admits(sun.altitude_deg, sun.to_sun, outward)
        })
    }

    /// When the sun is before all planes of these normals, or in them, to the second: so a point sees it through an opening.
    pub fn before_planes(&self, normals: &[DVec3]) -> Vec<Spell> {
        // each plane by itself, as the sun may pass two of them within a minute
        let of_plane = |normal: &DVec3| self.when(|sun| sun.to_sun.dot(*normal) >= 0.0);
        normals.iter().fold(self.windows.clone(), |spells, normal| common(&spells, &of_plane(normal)))
    }

    /// The lowest altitude in the windows that the cuts admit, degrees; nothing where the sun is never so high.
    pub fn lowest_deg(&self, cuts: &SunCuts) -> Option<f64> {
        let counted = self.minutes.iter().filter(|sun| cuts.admits(sun.altitude_deg, sun.to_sun, None));
        counted.map(|sun| sun.altitude_deg).filter(|altitude| *altitude >= 0.0).min_by(f64::total_cmp)
    }

    /// The spells in the windows in which a sun counts.
    fn when(&self, counts: impl Fn(&SunMinute) -> bool) -> Vec<Spell> {
        let mut spells = Vec::new();
        for [before, after] in self.minutes.array_windows() {
            let [was, is] = [before, after].map(&counts);
            let change = || first_like(*before, *after, &counts);
            match (was, is) {
                (true, true) => spells.push(Spell::new(before.secs, after.secs)),
                (true, false) => spells.push(Spell::new(before.secs, change())),
                (false, true) => spells.push(Spell::new(change(), after.secs)),
                (false, false) => {}
            }
        }
        // windows that touch are not joined
        common(&spells, &self.windows)
    }
}

impl SunMinute {
    fn at(sky: &Sky, secs: i64) -> Result<SunMinute, SunError> {
        // cannot fail: a day's windows lie within the years that chrono knows
        let utc = DateTime::from_timestamp(secs, 0).unwrap_or_default().naive_utc();
        let sun: Instant = sky.at(sky.place.time_zone.from_utc_datetime(&utc))?;
        Ok(SunMinute { secs, to_sun: sun.to_sun, altitude_deg: sun.altitude_deg() })
    }

    /// The sun at a second between this minute and another one, interpolated.
    fn between(&self, other: &SunMinute, secs: i64) -> SunMinute {
        let part = (secs - self.secs) as f64 / (other.secs - self.secs) as f64;
        SunMinute {
            secs,
            to_sun: self.to_sun.lerp(other.to_sun, part).normalize_or(self.to_sun),
            altitude_deg: self.altitude_deg + part * (other.altitude_deg - self.altitude_deg),
        }
    }
}

/// The first second at which the sun counts, or does not, as it does at the later minute. The two minutes must differ.
fn first_like(before: SunMinute, after: SunMinute, counts: &impl Fn(&SunMinute) -> bool) -> i64 {
    let is = counts(&after);
    let (mut other, mut like) = (before.secs, after.secs);
    while like - other > 1 {
        let middle = other + (like - other) / 2;
        if counts(&before.between(&after, middle)) == is { like = middle } else { other = middle }
    }
    like
}
