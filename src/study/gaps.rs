//! Between which instants times of change are searched, and at which moments.
//!
//! A gap is searched in whole steps of the resolution from its first instant on: the moments of a study that is stepped at
//! the resolution. What changes once in it gets the seconds that it has in that study.

use crate::profile::accumulate::MOST_SECS;
use crate::site::Site;
use crate::sun::{Instant, SunError};
use chrono::TimeDelta;
use glam::DVec3;

/// The gaps of a site's track.
#[derive(Clone, Copy)]
pub(super) struct Gaps<'a> {
    site: &'a Site,
    /// 0 where none is searched.
    resolution_secs: u32,
}

/// The time between two instants that follow one another, with the sun above the horizon all along.
#[derive(Clone, Copy)]
pub(super) struct Gap<'a> {
    site: &'a Site,
    before: &'a Instant,
    after: &'a Instant,
    resolution_secs: u32,
}

impl<'a> Gaps<'a> {
    pub(super) fn new(site: &'a Site, resolution_secs: u32) -> Gaps<'a> {
        Gaps { site, resolution_secs }
    }

    /// Whether any is searched.
    pub(super) fn any(&self) -> bool {
        (0..self.site.track.instants.len()).any(|at| self.before(at).is_some())
    }

    /// The gap before an instant, where it is searched: longer than the resolution, and no longer than a word holds.
    pub(super) fn before(&self, at: usize) -> Option<Gap<'a>> {
        let instants = &self.site.track.instants;
        let (before, after) = (instants.get(at.checked_sub(1)?)?, instants.get(at)?);
        let is_searched = self.resolution_secs > 0 && (self.resolution_secs + 1..=MOST_SECS).contains(&after.gap_secs);
        is_searched.then_some(Gap { site: self.site, before, after, resolution_secs: self.resolution_secs })
    }

    /// Whether an instant begins or ends a gap that is searched.
    pub(super) fn touch(&self, at: usize) -> bool {
        self.before(at).is_some() || self.before(at + 1).is_some()
    }

    /// For how many seconds an instant itself stands: without the halves of the gaps that are searched.
    pub(super) fn own_secs(&self, at: usize) -> u32 {
        let secs = |gap: Option<Gap<'_>>| gap.map_or(0, |gap| gap.secs());
        let (before, after) = (secs(self.before(at)), secs(self.before(at + 1)));
        // as weights share a gap's seconds out: a half second goes to the later instant
        self.site.track.instants[at].weight_secs.saturating_sub(before - before / 2).saturating_sub(after / 2)
    }

    /// For how many seconds an instant stands among the moments of its gaps: itself, and half a step to either side.
    pub(super) fn secs_among_moments(&self, at: usize) -> u32 {
        let before = self.before(at).map_or(0, |gap| gap.later_half(gap.steps() - 1));
        let after = self.before(at + 1).map_or(0, |gap| gap.step_secs(0) / 2);
        self.own_secs(at) + before + after
    }
}

impl Gap<'_> {
    pub(super) fn secs(&self) -> u32 {
        self.after.gap_secs
    }

    /// Into how many steps it is searched, at least 2.
    pub(super) fn steps(&self) -> u32 {
        self.secs().div_ceil(self.resolution_secs)
    }

    /// Seconds from its beginning to the end of so many steps; the last step may be shorter.
    pub(super) fn secs_at(&self, step: u32) -> u32 {
        step.saturating_mul(self.resolution_secs).min(self.secs())
    }

    /// How long the step after so many is, seconds.
    fn step_secs(&self, step: u32) -> u32 {
        self.secs_at(step + 1) - self.secs_at(step)
    }

    /// That half of it that belongs to the moment at its end.
    fn later_half(&self, step: u32) -> u32 {
        let secs = self.step_secs(step);
        secs - secs / 2
    }

    /// What changes within the step after so many has been for so many seconds as it was at the beginning.
    pub(super) fn secs_before_change(&self, step: u32) -> u32 {
        self.secs_at(step) + self.step_secs(step) / 2
    }

    /// The moments between its ends: the sun, and for how many seconds each stands.
    pub(super) fn moments(&self) -> impl Iterator<Item = Result<(DVec3, u32), SunError>> {
        (1..self.steps()).map(|step| Ok((self.sun_at(step)?, self.later_half(step - 1) + self.step_secs(step) / 2)))
    }

    /// The sun at the end of so many steps.
    pub(super) fn sun_at(&self, step: u32) -> Result<DVec3, SunError> {
        if step == 0 {
            return Ok(self.before.to_sun);
        }
        if step >= self.steps() {
            return Ok(self.after.to_sun);
        }
        let time = self.before.time + TimeDelta::seconds(self.secs_at(step).into());
        Ok(self.site.track.sky(&self.site.place).at(time)?.to_sun)
    }
}
