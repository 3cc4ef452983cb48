//! The timestamps that passes write on the adapter, two per pass.

use std::sync::Mutex;
use wgpu::{Buffer, QuerySet};

/// The greatest number of passes between two readings; more are not timed.
pub(super) const MOST: u32 = 2048;

/// Two timestamps per pass.
pub(super) struct Timers {
    pub(super) times: QuerySet,
    pub(super) resolved: Buffer,
    /// The labels of the passes, in order.
    pub(super) labels: Mutex<Vec<String>>,
}

impl Timers {
    /// Where the next pass writes its two timestamps.
    pub(super) fn place(&self, label: &str) -> Option<(&QuerySet, u32)> {
        let mut labels = self.labels.lock().ok()?;
        let at = labels.len() as u32;
        (at < MOST).then(|| {
            labels.push(label.to_owned());
            (&self.times, at * 2)
        })
    }
}
