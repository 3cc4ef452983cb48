//! Measures how long the stages of the work take.

use crate::profile::Timings;
use std::time::{Duration, Instant};

/// Measures stages, one after another.
#[derive(Clone, Debug)]
pub struct Stopwatch {
    started: Instant,
    lap: Instant,
    pub(super) stages: Timings,
}

impl Stopwatch {
    /// Starts a stopwatch.
    pub fn start() -> Stopwatch {
        let now = Instant::now();
        Stopwatch { started: now, lap: now, stages: Timings::default() }
    }

    /// Starts a stopwatch that already has some stages.
    pub fn after(stages: Timings) -> Stopwatch {
        let now = Instant::now();
        let before: f64 = stages.0.iter().map(|(_, secs)| secs).sum();
        let started = Duration::try_from_secs_f64(before).ok().and_then(|before| now.checked_sub(before));
        Stopwatch { started: started.unwrap_or(now), lap: now, stages }
    }

    /// Ends a stage and begins the next.
    pub(crate) fn lap(&mut self, stage: &'static str) {
        let now = Instant::now();
        self.stages.0.push((stage, (now - self.lap).as_secs_f64()));
        self.lap = now;
    }

    /// Adds stages that were measured elsewhere, and begins the next.
    pub(crate) fn laps(&mut self, stages: Timings) {
        self.stages.0.extend(stages.0);
        self.lap = Instant::now();
    }

    /// The stages so far.
    pub fn stages(&self) -> Timings {
        self.stages.clone()
    }

    /// The stages so far, with `total`.
    pub fn timings(&self) -> Timings {
        let mut timings = self.stages.clone();
        timings.0.push(("total", self.started.elapsed().as_secs_f64()));
        timings
    }
}
