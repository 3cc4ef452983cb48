//! The sun of a rule's day, and when it counts for a receiver before which nothing stands.

use super::cuts::SunCuts;
use super::resolved::RuleDay;
use super::spell::{Spell, common, merged};
use crate::sun::{Instant, Sky, SunError};
use chrono::{DateTime, TimeZone};
use glam::DVec3;

/// Between two of these the sun moves by a quarter of a degree, and as good as straight on.
const STEP_SECS: i64 = 60;

/// Where the sun is in the windows of a day, minute after minute: found once, for all receivers.
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
    /// The sun in all windows of a day, those of single criteria too.
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

    /// When the sun is up and the cuts admit it, to the second; before the plane of an outward normal, where there is one.
    /// Where the altitude is that of a sky with air, it is the sun as it is seen.
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
        // two windows are not joined by the time between them
        common(&spells, &self.windows)
    }
}

impl SunMinute {
    fn at(sky: &Sky, secs: i64) -> Result<SunMinute, SunError> {
        // a day's windows lie within the years that chrono knows
        let utc = DateTime::from_timestamp(secs, 0).unwrap_or_default().naive_utc();
        let sun: Instant = sky.at(sky.place.time_zone.from_utc_datetime(&utc))?;
        Ok(SunMinute { secs, to_sun: sun.to_sun, altitude_deg: sun.altitude_deg() })
    }

    /// The sun between this and another minute.
    fn between(&self, other: &SunMinute, secs: i64) -> SunMinute {
        let part = (secs - self.secs) as f64 / (other.secs - self.secs) as f64;
        SunMinute {
            secs,
            to_sun: self.to_sun.lerp(other.to_sun, part).normalize_or(self.to_sun),
            altitude_deg: self.altitude_deg + part * (other.altitude_deg - self.altitude_deg),
        }
    }
}

/// The first second after one minute at which it is as at the next; they differ.
fn first_like(before: SunMinute, after: SunMinute, counts: &impl Fn(&SunMinute) -> bool) -> i64 {
    let is = counts(&after);
    let (mut other, mut like) = (before.secs, after.secs);
    while like - other > 1 {
        let middle = other + (like - other) / 2;
        if counts(&before.between(&after, middle)) == is { like = middle } else { other = middle }
    }
    like
}
