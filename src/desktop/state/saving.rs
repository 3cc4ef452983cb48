//! What is saved, and the questions before something would be lost.

use crate::choice::Method;
use crate::desktop::state::project::Project;
use crate::desktop::state::recovery::Recovery;
use crate::site::file::SiteFile;
use std::path::PathBuf;

/// What is saved, and what is asked about what is not.
#[derive(Default)]
pub(in crate::desktop) struct SaveState {
    /// What the site file says, and by which technique; none yet for a bare model.
    pub(in crate::desktop) saved: Option<(SiteFile, Method)>,
    pub(in crate::desktop) question: Option<SaveQuestion>,
    /// What goes on once it is saved.
    pub(in crate::desktop) then: Option<PendingAction>,
    /// Ctrl+S, or the window's own way to close: once the fields have what is typed.
    pub(in crate::desktop) saves: bool,
    pub(in crate::desktop) closes: bool,
    /// Nobody wants what is not saved.
    pub(in crate::desktop) is_left: bool,
    pub(in crate::desktop) title: String,
    pub(in crate::desktop) recovery: Recovery,
}

/// What is asked.
pub(in crate::desktop) enum SaveQuestion {
    /// Asks what becomes of unsaved settings.
    Unsaved(PendingAction),
    /// Asks whether the site file, which has changed since it was read, is replaced.
    Replaced(PathBuf),
}

/// What would lose what is not saved.
pub(in crate::desktop) enum PendingAction {
    /// Closes the window.
    Close,
    /// Opens another site.
    Open(Box<Project>),
    /// Reads the site file again.
    Reload,
}

impl SaveState {
    /// Another window has no title yet.
    pub(in crate::desktop) fn forget_title(&mut self) {
        self.title.clear();
    }
}
