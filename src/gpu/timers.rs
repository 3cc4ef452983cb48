//! The timestamps that passes write on the adapter, two per pass.

use std::sync::Mutex;
use wgpu::{Buffer, QuerySet};

/// Passes that are timed between two readings; further ones are not.
pub(super) const MOST: u32 = 2048;

/// Two times a pass.
pub(super) struct Timers {
    pub(super) times: QuerySet,
    pub(super) resolved: Buffer,
    /// Those of the passes, in order.
    pub(super) labels: Mutex<Vec<String>>,
}

impl Timers {
    /// Where the next pass writes its two times.
    pub(super) fn place(&self, label: &str) -> Option<(&QuerySet, u32)> {
        let mut labels = self.labels.lock().ok()?;
        let at = labels.len() as u32;
        (at < MOST).then(|| {
            labels.push(label.to_owned());
            (&self.times, at * 2)
        })
    }
}
