//! The state that the open site is compared with.

use crate::desktop::results::{Findings, StudyResult};
use crate::desktop::state::project::{self, Project};
use crate::site::{Models, Overrides, Site, SiteError, WrittenSite};
use crate::study::Outcome;
use std::path::Path;
use std::sync::Arc;

/// The state that the open site is compared with.
#[derive(Clone)]
pub(in crate::desktop) struct BeforeState {
    /// The state as it was written.
    pub(in crate::desktop) before: Arc<WrittenSite>,
    /// Its models. Those of a kept state stay as they were, whatever happens to their files; those of another file are
    /// read from it.
    pub(in crate::desktop) models: Models,
    /// The hours of a state that was kept.
    pub(in crate::desktop) result: Option<Arc<StudyResult>>,
}

impl BeforeState {
    /// Its models, if they need not be read again.
    pub(in crate::desktop) fn models(&self) -> Option<Models> {
        let holds = self.result.is_some() || self.models.changed_file().is_none();
        holds.then(|| self.models.clone())
    }

    /// Its hours, if they belong to the same study.
    pub(in crate::desktop) fn outcome(&self, site: &Site) -> Option<Outcome> {
        let result = self.result.as_ref()?;
        let its = &result.site;
        let same = its.track == site.track
            && its.grid == site.grid
            && its.ground.level == site.ground.level
            && result.method == site.method;
        match &result.found {
            Findings::Shadow(hours) if same => Some(hours.outcome()),
            _ => None,
        }
    }
}

/// Reads another file as the state before. If it has no place, it gets that of the open site.
///
/// # Errors
/// The command's errors of reading it.
pub(in crate::desktop) fn read(path: &Path, project: &Project) -> Result<WrittenSite, SiteError> {
    WrittenSite::read_beside(path, &project.written, &Overrides::default())
}

/// The name of the path that a state came from.
pub(in crate::desktop) fn name_of(before: &WrittenSite) -> String {
    let named = before.site.place.as_ref().and_then(|place| place.name.clone());
    named.filter(|name| !name.trim().is_empty()).unwrap_or_else(|| project::name_of(Path::new(&before.file)))
}
