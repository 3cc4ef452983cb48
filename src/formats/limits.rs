//! Limits on the size of a model, and on the time and memory of reading it.

use std::time::Duration;
use sysinfo::{MemoryRefreshKind, RefreshKind, System};

/// The greatest number of triangles of a model, with instances counted. Their vertices take at most 7.2 GB, their
/// indices 1.2 GB.
pub const MAX_TRIANGLES: u64 = 100_000_000;

/// The greatest number of components of a model. Each has names and adjacency of its own, whatever its size.
pub const MAX_COMPONENTS: usize = 1_000_000;

/// Limits on the reading of one file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ReadLimits {
    /// The longest time.
    pub time: Duration,
    /// The most memory, bytes; by default three quarters of the machine's.
    pub memory: Option<u64>,
}

impl Default for ReadLimits {
    fn default() -> Self {
        Self { time: Duration::from_secs(600), memory: None }
    }
}

impl ReadLimits {
    /// Bytes; without a limit if the system does not report its memory.
    pub(super) fn memory_bytes(self) -> u64 {
        self.memory.unwrap_or_else(|| {
            let ram = RefreshKind::nothing().with_memory(MemoryRefreshKind::nothing().with_ram());
            let Ok(system) = System::new_with_specifics(ram) else { return u64::MAX };
            let of_machine = system.total_memory();
            let of_group = system.cgroup_limits().map_or(of_machine, |limits| limits.total_memory);
            match of_machine.min(of_group) {
                0 => u64::MAX,
                bytes => bytes / 4 * 3,
            }
        })
    }
}
