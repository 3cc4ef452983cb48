//! The gaps between instants in which times of change are searched, and their moments.
//!
//! A gap is searched in whole steps of the resolution from its first instant on. These are the moments of a study whose
//! step is the resolution, so a cell that changes once in the gap gets the same seconds as in that study.

use crate::profile::accumulate::MOST_SECS;
use crate::site::Site;
use crate::sun::{Instant, SunError};
use chrono::TimeDelta;
use glam::DVec3;

/// The gaps of a site's track.
#[derive(Clone, Copy)]
pub(super) struct Gaps<'a> {
    site: &'a Site,
    /// 0 if no gap is searched.
    resolution_secs: u32,
}

/// The time between two consecutive instants, with the sun above the horizon throughout.
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

    /// Whether any gap is searched.
    pub(super) fn any(&self) -> bool {
        (0..self.site.track.instants.len()).any(|at| self.before(at).is_some())
    }

    /// The gap before an instant if it is searched: it must be longer than the resolution, and its steps must fit in a
    /// word.
    pub(super) fn before(&self, at: usize) -> Option<Gap<'a>> {
        let instants = &self.site.track.instants;
        let (before, after) = (instants.get(at.checked_sub(1)?)?, instants.get(at)?);
        let is_searched = self.resolution_secs > 0 && (self.resolution_secs + 1..=MOST_SECS).contains(&after.gap_secs);
        is_searched.then_some(Gap { site: self.site, before, after, resolution_secs: self.resolution_secs })
    }

    /// Whether a searched gap begins or ends at an instant.
    pub(super) fn touch(&self, at: usize) -> bool {
        self.before(at).is_some() || self.before(at + 1).is_some()
    }

    /// The seconds for which an instant itself stands, without the halves of adjoining gaps that are searched.
    pub(super) fn own_secs(&self, at: usize) -> u32 {
        let secs = |gap: Option<Gap<'_>>| gap.map_or(0, |gap| gap.secs());
        let (before, after) = (secs(self.before(at)), secs(self.before(at + 1)));
        // weights are split in the same way: a half second goes to the later instant
        self.site.track.instants[at].weight_secs.saturating_sub(before - before / 2).saturating_sub(after / 2)
    }

    /// The seconds for which an instant stands among the moments of its gaps: its own, and half a step on either side.
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

    /// The number of steps in which it is searched, at least 2.
    pub(super) fn steps(&self) -> u32 {
        self.secs().div_ceil(self.resolution_secs)
    }

    /// The seconds from its beginning to the end of a step. The last step may be shorter.
    pub(super) fn secs_at(&self, step: u32) -> u32 {
        step.saturating_mul(self.resolution_secs).min(self.secs())
    }

    /// The length of a step, seconds.
    fn step_secs(&self, step: u32) -> u32 {
        self.secs_at(step + 1) - self.secs_at(step)
    }

    /// The half of a step that belongs to the moment at its end.
    fn later_half(&self, step: u32) -> u32 {
        let secs = self.step_secs(step);
        secs - secs / 2
    }

    /// The seconds in the gap's first state for a cell that changes within a step.
    pub(super) fn secs_before_change(&self, step: u32) -> u32 {
        self.secs_at(step) + self.step_secs(step) / 2
    }

    /// The moments between its ends: the sun, and the seconds for which each stands.
    pub(super) fn moments(&self) -> impl Iterator<Item = Result<(DVec3, u32), SunError>> {
        (1..self.steps()).map(|step| Ok((self.sun_at(step)?, self.later_half(step - 1) + self.step_secs(step) / 2)))
    }

    /// The sun at the end of a step.
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
