//! The state that the open site is compared with.

use crate::desktop::results::{Findings, StudyResult};
use crate::desktop::state::project::{self, Project};
use crate::site::{Models, Overrides, Site, SiteError, WrittenSite};
use crate::study::Outcome;
use std::path::Path;
use std::sync::Arc;

/// What is known of the state that is compared with.
#[derive(Clone)]
pub(in crate::desktop) struct BeforeState {
    /// As it was written.
    pub(in crate::desktop) before: Arc<WrittenSite>,
    /// Its models. Those of a kept state stay as they were, whatever becomes of their files; those of another file are that
    /// file's.
    pub(in crate::desktop) models: Models,
    /// The hours of a state that was kept.
    pub(in crate::desktop) result: Option<Arc<StudyResult>>,
}

impl BeforeState {
    /// Its models, where they need not be read again.
    pub(in crate::desktop) fn models(&self) -> Option<Models> {
        let holds = self.result.is_some() || self.models.changed_file().is_none();
        holds.then(|| self.models.clone())
    }

    /// Its hours, where they are those of such a study.
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

/// Reads another file as the state before; what names no place stands in that of the open site.
///
/// # Errors
/// As the command reads it.
pub(in crate::desktop) fn read(path: &Path, project: &Project) -> Result<WrittenSite, SiteError> {
    WrittenSite::read_beside(path, &project.written, &Overrides::default())
}

/// A path that a state came from, as people call it.
pub(in crate::desktop) fn name_of(before: &WrittenSite) -> String {
    let named = before.site.place.as_ref().and_then(|place| place.name.clone());
    named.filter(|name| !name.trim().is_empty()).unwrap_or_else(|| project::name_of(Path::new(&before.file)))
}
