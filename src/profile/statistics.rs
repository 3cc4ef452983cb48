//! The work of counting shadow volumes over a whole study.

use crate::view::{Decider, FragmentCounts};

/// The work of counting shadow volumes, over all cells and instants.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// The number of cells, over all instants.
    pub cells: u64,
    /// The number of those that a map left to the volumes, if there was a map.
    pub silhouette_cells: Option<u64>,
    /// The number of fragments of walls and caps that reached the count.
    pub fragments: u64,
    /// The number of fragments that would have reached the count without the mask.
    pub fragments_without_mask: u64,
}

impl Statistics {
    /// Adds an instant.
    pub fn add(&mut self, counted: &FragmentCounts) {
        self.cells += counted.reached.len() as u64;
        self.fragments += counted.reached.iter().map(|&fragments| u64::from(fragments)).sum::<u64>();
        self.fragments_without_mask += counted.all;
        if let Some(decided) = &counted.decided {
            let by_volumes = |it: &&Decider| matches!(it, Decider::VolumeShadow | Decider::VolumeLight);
            *self.silhouette_cells.get_or_insert(0) += decided.iter().filter(by_volumes).count() as u64;
        }
    }

    /// The statistics of one instant.
    pub fn of(counted: &FragmentCounts) -> Statistics {
        let mut statistics = Statistics::default();
        statistics.add(counted);
        statistics
    }

    /// The fragments per cell, with the mask and without.
    pub fn overdraw(&self) -> [f64; 2] {
        [self.fragments, self.fragments_without_mask].map(|fragments| fragments as f64 / self.cells.max(1) as f64)
    }
}
