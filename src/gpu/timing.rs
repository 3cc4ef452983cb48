//! The time of passes on the adapter. Timing is off until [`Gpu::time_passes`] is called, and costs nothing until then.

use super::timers::{MOST, Timers};
use super::{Gpu, GpuError, readback};
use std::sync::Mutex;
use wgpu::*;

impl Gpu {
    /// Starts timing passes.
    ///
    /// # Errors
    /// [`GpuError::Failed`] if the adapter has no timestamps.
    pub fn time_passes(&self) -> Result<(), GpuError> {
        if !self.device.features().contains(Features::TIMESTAMP_QUERY) {
            return Err(self.failed("timing passes needs timestamps, which the adapter does not have"));
        }
        let size = u64::from(MOST * 2 * QUERY_SIZE);
        let timers = Timers {
            times: self.device.create_query_set(&QuerySetDescriptor {
                label: Some("timers"),
                ty: QueryType::Timestamp,
                count: MOST * 2,
            }),
            resolved: self.buffer("timers", size, BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC)?,
            labels: Mutex::default(),
        };
        // a second call has no effect
        let _ = self.timers.set(timers);
        self.check()
    }

    /// The timestamps that a render pass which begins now must write, if any.
    pub fn timed(&self, label: &str) -> Option<RenderPassTimestampWrites<'_>> {
        let (query_set, at) = self.timers.get()?.place(label)?;
        Some(RenderPassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(at),
            end_of_pass_write_index: Some(at + 1),
        })
    }

    /// The same for a compute pass.
    pub fn timed_compute(&self, label: &str) -> Option<ComputePassTimestampWrites<'_>> {
        let (query_set, at) = self.timers.get()?.place(label)?;
        Some(ComputePassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(at),
            end_of_pass_write_index: Some(at + 1),
        })
    }

    /// Returns the label and the milliseconds of each pass since the last reading, in order; all must be submitted.
    /// `None` if passes are not timed.
    ///
    /// # Errors
    /// [`GpuError::Failed`]
    pub fn pass_times(&self) -> Result<Vec<(String, f64)>, GpuError> {
        let Some(timers) = self.timers.get() else { return Ok(Vec::new()) };
        let labels = timers.labels.lock().map(|mut labels| std::mem::take(&mut *labels)).unwrap_or_default();
        if labels.is_empty() {
            return Ok(Vec::new());
        }
        let mut encoder = self.device.create_command_encoder(&CommandEncoderDescriptor::default());
        encoder.resolve_query_set(&timers.times, 0..labels.len() as u32 * 2, &timers.resolved, 0);
        self.queue.submit([encoder.finish()]);
        let times: Vec<[u64; 2]> = readback::values(self, &timers.resolved)?;
        let tick_ms = f64::from(self.queue.get_timestamp_period()) * 1e-6;
        let millis = |[from, to]: [u64; 2]| to.saturating_sub(from) as f64 * tick_ms;
        Ok(labels.into_iter().zip(times.into_iter().map(millis)).collect())
    }
}
