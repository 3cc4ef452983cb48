//! What all receivers share, and how progress is reported to the listener.

use super::super::{Event, OnEvent, StudyError, tell};
use super::days::JudgedDays;
use super::state_search::{StateSearch, WallPlane};
use crate::judgement::LitSpell;
use crate::rules::{ResolvedRule, Spell};
use crate::site::{JudgedSite, JudgedState};
use crate::sun::{SunError, Zone};
use crate::sunlight::JudgedPoint;
use chrono::DateTime;
use glam::DVec3;

/// A rule and a site.
pub(super) struct RuleOnSite<'a> {
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

/// When a point is lit: the spells of each day in the state that is judged, and in the one before.
pub(super) type LitInBoth = (Vec<Vec<LitSpell>>, Option<Vec<Vec<LitSpell>>>);

impl RuleOnSite<'_> {
    /// Both states, for points within the bounds of these.
    pub(super) fn states(&self, points: &[DVec3]) -> BothStates {
        match self.before {
            None => BothStates { now: StateSearch::of(&self.site.now, points), before: None },
            Some(before) => {
                let [now, before] = StateSearch::of_both([&self.site.now, before], points);
                BothStates { now, before: Some(before) }
            }
        }
    }
}

impl BothStates {
    /// When a point is lit, as each state places it. If a wall is given, only what lies in front of it takes the sun.
    pub(super) fn lit(
        &self,
        at: impl Fn(&StateSearch) -> JudgedPoint,
        wall: Option<WallPlane>,
        days: &JudgedDays<'_>,
        open: &[Vec<Spell>],
    ) -> Result<LitInBoth, SunError> {
        let of_now = at(&self.now);
        let Some(before) = &self.before else {
            return Ok((self.now.lit_before((&of_now, wall), days, open)?, None));
        };
        let both = [&of_now, &at(before)];
        let [now, before] = StateSearch::lit_in_both([&self.now, before], (both, wall), days, open)?;
        Ok((now, Some(before)))
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
