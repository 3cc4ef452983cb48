//! A rule's days, with what is the same for all points.

use super::super::StudyError;
use crate::rules::{DaySun, GrazingIn, RuleDay, Spell, SunCuts, common, merged};
use crate::site::JudgedSite;
use crate::sun::{Air, Day, DayWindow, Place, Sky, SunError, Zone, delta_t_secs};
use crate::sunlight::{Interval, JudgedPoint, ProbeSearch, SearchedDays, WallFront};
use chrono::{DateTime, TimeZone};
use glam::DVec3;
use rayon::prelude::*;

/// The number of days that are searched together.
const DAYS_TOGETHER: usize = 32;

/// The days of a rule, each with its sun.
pub(super) struct JudgedDays<'a> {
    /// In the order of the calendar.
    pub(super) days: &'a [RuleDay],
    /// For each day, the times at which anything is counted.
    pub(super) windows: Vec<Vec<Spell>>,
    searched: Vec<SearchedDays<'a>>,
    suns: Vec<DaySun>,
    cuts: SunCuts,
}

/// From the first to the last second that is needed on each day.
pub(super) fn hulls(place: &Place, days: &[RuleDay]) -> Result<Vec<DayWindow>, SunError> {
    days.par_iter()
        .map(|day| {
            let whole = DayWindow::on(place, day.date, None, None)?;
            let windows = windows_of(day);
            let (Some(first), Some(last)) = (windows.first(), windows.last()) else {
                return Ok(DayWindow { to: whole.from, ..whole });
            };
            let [from, to] = [first.start, last.end].map(|secs| time(place, secs));
            Ok(DayWindow { day: Day::of(place, day.date)?, from, to })
        })
        .collect()
}

/// The local time at a second since 1970.
pub(super) fn time(place: &Place, secs: i64) -> DateTime<Zone> {
    // a day's windows are within the years that chrono supports
    let utc = DateTime::from_timestamp(secs, 0).unwrap_or_default().naive_utc();
    place.time_zone.from_utc_datetime(&utc)
}

/// The windows of a day and those of its criteria, merged.
fn windows_of(day: &RuleDay) -> Vec<Spell> {
    merged(day.windows.iter().chain(day.criteria.iter().flatten().flatten()).copied())
}

impl<'a> JudgedDays<'a> {
    pub(super) fn new(
        site: &'a JudgedSite,
        cuts: SunCuts,
        days: &'a [RuleDay],
        hulls: &'a [DayWindow],
    ) -> Result<JudgedDays<'a>, StudyError> {
        let place = &site.place;
        let air = site.refraction.then(|| Air::standard(place.elevation_m));
        let searched =
            hulls.chunks(DAYS_TOGETHER).map(|some| SearchedDays::new(place, some, air)).collect::<Result<_, _>>()?;
        let sun = |(day, hull): (&RuleDay, &DayWindow)| {
            let sky = Sky { place, delta_t_secs: delta_t_secs(hull.from.to_utc())?, air };
            DaySun::of(&sky, day)
        };
        let suns = days.par_iter().zip(hulls).map(sun).collect::<Result<_, SunError>>()?;
        Ok(JudgedDays { days, windows: days.iter().map(windows_of).collect(), searched, suns, cuts })
    }

    /// When a sun that counts would shine on a receiver with nothing in its way, on each day. A window or a façade looks
    /// outward.
    pub(super) fn open(&self, outward: Option<DVec3>) -> Vec<Vec<Spell>> {
        self.suns.iter().map(|sun| sun.open(&self.cuts, outward)).collect()
    }

    /// The same for a place on an area, which has no façade: only its own slope hides the sun.
    pub(super) fn open_on_area(&self, normal: Option<DVec3>) -> Vec<Vec<Spell>> {
        let cuts = SunCuts { off_facade_deg: 0.0, off_facade_in: GrazingIn::Space, ..self.cuts };
        self.suns.iter().map(|sun| sun.open(&cuts, normal)).collect()
    }

    /// The parts of spells in which the sun is in front of all planes with these normals.
    pub(super) fn before_planes(&self, open: &[Vec<Spell>], normals: &[DVec3]) -> Vec<Vec<Spell>> {
        self.suns.iter().zip(open).map(|(sun, open)| common(open, &sun.before_planes(normals))).collect()
    }

    /// The altitude of the lowest sun that counts, degrees.
    pub(super) fn lowest_deg(&self) -> Option<f64> {
        self.suns.iter().filter_map(|sun| sun.lowest_deg(&self.cuts)).min_by(f64::total_cmp)
    }

    /// A point's intervals on all days.
    pub(super) fn intervals(
        &self,
        search: &ProbeSearch,
        (at, wall): (&JudgedPoint, Option<WallFront>),
    ) -> Result<Vec<Vec<Interval>>, SunError> {
        let mut found = Vec::with_capacity(self.days.len());
        for days in &self.searched {
            found.extend(search.intervals_before(at, wall, days)?);
        }
        Ok(found)
    }

    /// The same in two states.
    pub(super) fn intervals_in_both(
        &self,
        searches: [&ProbeSearch; 2],
        (at, wall): ([&JudgedPoint; 2], Option<WallFront>),
    ) -> Result<[Vec<Vec<Interval>>; 2], SunError> {
        let mut found = [Vec::new(), Vec::new()];
        for days in &self.searched {
            let of_days = ProbeSearch::intervals_in_both(searches, at, wall, days)?;
            found.iter_mut().zip(of_days).for_each(|(found, more)| found.extend(more));
        }
        Ok(found)
    }
}
