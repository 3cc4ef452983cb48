//! What all receivers share, and how progress is reported to the listener.

use super::super::{Event, OnEvent, StudyError, tell};
use super::days::JudgedDays;
use super::state_search::StateSearch;
use crate::rules::ResolvedRule;
use crate::site::{JudgedSite, JudgedState};
use crate::sun::Zone;
use chrono::DateTime;
use glam::DVec3;

/// A rule and a site.
pub(super) struct Judging<'a> {
    pub(super) site: &'a JudgedSite,
    pub(super) rule: &'a ResolvedRule,
    pub(super) days: &'a JudgedDays<'a>,
    /// The state that it is compared with.
    pub(super) before: Option<&'a JudgedState>,
}

/// Both states, ready to be searched.
pub(super) struct BothStates {
    pub(super) now: StateSearch,
    pub(super) before: Option<StateSearch>,
}

impl Judging<'_> {
    /// Both states, with what `of` derives from each.
    pub(super) fn both(&self, of: impl Fn(&JudgedState) -> StateSearch) -> BothStates {
        BothStates { now: of(&self.site.now), before: self.before.map(of) }
    }

    /// Both states, for points within the bounds of these.
    pub(super) fn states(&self, points: &[DVec3]) -> BothStates {
        self.both(|state| StateSearch::of(state, points))
    }
}

/// Progress, as it is reported to the listener.
pub(super) struct Steps<'s, 'e> {
    on_event: &'s mut OnEvent<'e>,
    count: usize,
    done: usize,
    time: DateTime<Zone>,
}

impl<'s, 'e> Steps<'s, 'e> {
    pub(super) fn new(
        on_event: &'s mut OnEvent<'e>,
        count: usize,
        time: DateTime<Zone>,
    ) -> Result<Steps<'s, 'e>, StudyError> {
        tell(on_event, Event::Started { instants: count, tiles: 1 })?;
        Ok(Steps { on_event, count, done: 0, time })
    }

    /// Reports that some more receivers are judged.
    pub(super) fn done(&mut self, more: usize) -> Result<(), StudyError> {
        self.done = (self.done + more).min(self.count);
        let index = self.done.saturating_sub(1);
        tell(self.on_event, Event::Drawn { index, count: self.count, time: self.time, mask: None, bits: None })
    }

    /// Gives the listener a chance to stop the work.
    pub(super) fn poll(&mut self) -> Result<(), StudyError> {
        tell(self.on_event, Event::Stage("judging"))
    }
}
