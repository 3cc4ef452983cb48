//! Computes the hours of shadow on a plan.

use super::ProfileRequest;
use super::keeping::StudyStore;
use super::sums::Sums;
use crate::deliver::DeliverError;
use crate::deliver::shelf::Beside;
use crate::export::ExportError;
use crate::export::figure::Outline;
use crate::mesh::Mesh;
use crate::message::Message;
use crate::profile::{Profile, Provenance, Shaded, ShadedCells, Statistics, Timings};
use crate::site::Site;
use crate::study::{self, OnEvent, Outcome, TiledOutcome, TiledStudy};
use rayon::prelude::*;
use std::path::Path;
use std::sync::Arc;

/// The hours of shadow on a plan.
pub struct Hours {
    /// The shaded time.
    pub profile: Profile<Sums>,
    /// What drew the shadows.
    pub drawn: Provenance,
    /// The mesh whose faces the plan's cells see.
    pub surface_mesh: Mesh,
    /// The statistics of counting, if they were requested.
    pub statistics: Option<Statistics>,
    /// Notes of the study besides [`Site::notes`].
    pub notes: Vec<Message>,
    /// The duration of the stages.
    pub timings: Timings,
    /// The shadow at each instant with a sun, if that was requested and is in memory.
    pub outlines: Vec<Outline>,
}

/// The least and the most hours of shadow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// The hours in the cell that has the least.
    pub least: f64,
    /// The hours in the cell that has the most.
    pub most: f64,
    /// Hours of the window with the sun above the horizon.
    pub day: f64,
}

/// Computes the hours, and continues the folder's stopped study if it is the same. [`StudyStore`] removes the study's
/// files when it finishes.
pub(in crate::deliver) fn find<'a>(
    site: &Site,
    asked: &ProfileRequest<'a>,
    folder: Option<&'a Path>,
    beside: Beside<'_>,
    on_event: &mut OnEvent<'_>,
) -> Result<(Hours, StudyStore<'a>), DeliverError> {
    let study = TiledStudy::new(site, &asked.wants(site, folder.is_some()), on_event)?;
    let mut keeping = StudyStore::new(site, asked, folder, &study)?;
    keeping.look_around(beside, on_event)?;
    let begun = keeping.begun(&study, site, on_event)?;
    let worked = study::in_tiles(study, begun, &mut |event| keeping.hear(event, site, on_event));
    let worked = keeping.take_fault().map_or(worked.map_err(DeliverError::from), Err);
    let worked = worked.inspect_err(|_| keeping.leave(on_event))?;
    let TiledOutcome { drawn, day_and_night_secs: (day_secs, night_secs), surface_mesh, .. } = worked;
    let TiledOutcome { statistics, notes, timings, .. } = worked;
    let shaded = std::mem::replace(&mut keeping.sums, Sums::Memory(Arc::default()));
    let profile = Profile { grid: site.grid, shaded, day_secs, night_secs };
    let outlines = std::mem::take(&mut keeping.outlines);
    Ok((Hours { profile, drawn, surface_mesh, statistics, notes, timings, outlines }, keeping))
}

impl Hours {
    /// The sums, if they are in memory.
    pub fn shaded(&self) -> Option<&Arc<Shaded>> {
        match &self.profile.shaded {
            Sums::Memory(shaded) => Some(shaded),
            Sums::File(_) => None,
        }
    }

    /// Converts to the outcome of a study on the plan.
    ///
    /// # Errors
    /// If the sums are in a file that cannot be read.
    pub(crate) fn into_outcome(self) -> Result<Outcome, ExportError> {
        let Hours { profile, drawn, surface_mesh, statistics, notes, timings, .. } = self;
        let Profile { grid, shaded, day_secs, night_secs } = profile;
        let shaded = Arc::unwrap_or_clone(shaded.in_memory()?);
        let profile = Profile { grid, shaded, day_secs, night_secs };
        Ok(Outcome { profile, drawn, surface: None, surface_mesh, statistics, notes, timings })
    }

    /// Loads the sums into memory.
    pub(super) fn in_memory(mut self) -> Result<Hours, ExportError> {
        let shaded = std::mem::replace(&mut self.profile.shaded, Sums::Memory(Arc::default()));
        self.profile.shaded = Sums::Memory(shaded.in_memory()?);
        Ok(self)
    }

    /// The least and the most hours.
    pub fn range(&self) -> Range {
        let Profile { grid, shaded, day_secs, .. } = &self.profile;
        let width = grid.width as usize;
        let both =
            |[least, most]: [u64; 2], [its_least, its_most]: [u64; 2]| [least.min(its_least), most.max(its_most)];
        let of_row = |row: usize| {
            let part = shaded.part(row * width..(row + 1) * width);
            (0..width).map(|cell| [part.of(cell); 2]).fold([u64::MAX, 0], both)
        };
        let rows = (0..grid.height as usize).into_par_iter().with_min_len(64);
        let [least, most] = rows.map(of_row).reduce(|| [u64::MAX, 0], both);
        let hours = |secs: f64| secs / 3600.0;
        Range { least: hours(least as f64 / 255.0), most: hours(most as f64 / 255.0), day: hours(f64::from(*day_secs)) }
    }
}
