//! The slow twin of the search: casts rays at the instants of a grid, and bisects between two that differ.

use super::{Interval, IntervalBound};
use crate::sun::{DayWindow, Instant, Sky, SunError, Zone};
use chrono::{DateTime, TimeDelta};

/// Returns the intervals in which nothing blocks. Intervals shorter than the step may be missed; at a step of one
/// second, none is.
pub(super) fn by_grid(
    window: &DayWindow,
    sky: &Sky<'_>,
    step: TimeDelta,
    blocked: impl Fn(&Instant) -> Option<IntervalBound>,
) -> Result<Vec<Interval>, SunError> {
    intervals(&grid(window, sky, step)?, sky, blocked)
}

/// The window's instants a step apart, and its end, without those deep in the night. If the sun rises and sets between
/// two of them, one more is added, so that no sunlight and no night is missed.
fn grid(window: &DayWindow, sky: &Sky<'_>, step: TimeDelta) -> Result<Vec<Instant>, SunError> {
    let mut last = sky.at(window.from)?;
    let mut grid = vec![last.clone()];
    while last.time < window.to {
        let night_secs = if last.night { sky.least_secs_to_horizon(&last) as i64 } else { 0 };
        let steps = (night_secs / step.num_seconds()).max(1) as i32;
        let next = sky.at((last.time + step * steps).min(window.to))?;
        grid.extend(sky.cut(&last, &next)?.into_iter().flat_map(|cut| cut.between));
        grid.push(next.clone());
        last = next;
    }
    Ok(grid)
}

/// Returns the intervals in which nothing blocks. Between instants that agree no change is assumed; between two that
/// differ the change is bisected.
fn intervals(
    grid: &[Instant],
    sky: &Sky<'_>,
    blocked: impl Fn(&Instant) -> Option<IntervalBound>,
) -> Result<Vec<Interval>, SunError> {
    let mut found = Vec::new();
    // the start of the open interval, and what blocked before it
    let mut open = None;
    let mut before: Option<(DateTime<Zone>, Option<IntervalBound>)> = None;
    for instant in grid {
        let now = (instant.time, blocked(instant));
        match before {
            None => open = now.1.is_none().then_some((now.0, IntervalBound::Window)),
            Some((time, state)) if state.is_none() != now.1.is_none() => {
                let (mut low, mut high) = ((time, state), now);
                while high.0 - low.0 > TimeDelta::seconds(1) {
                    let middle = sky.at(low.0 + TimeDelta::seconds((high.0 - low.0).num_seconds() / 2))?;
                    let state = blocked(&middle);
                    let half = if state.is_none() == low.1.is_none() { &mut low } else { &mut high };
                    *half = (middle.time, state);
                }
                if let Some(before) = low.1 {
                    open = Some((high.0, before));
                } else if let (Some((start, before)), Some(after)) = (open.take(), high.1) {
                    found.push(Interval { start, end: high.0, before, after });
                }
            }
            Some(_) => {}
        }
        before = Some(now);
    }
    if let (Some((start, why)), Some((end, _))) = (open, before)
        && start < end
    {
        found.push(Interval { start, end, before: why, after: IntervalBound::Window });
    }
    Ok(found)
}
