//! What is saved, and the questions before something is lost.

use crate::choice::Method;
use crate::desktop::state::project::Project;
use crate::desktop::state::recovery::Recovery;
use crate::site::file::SiteFile;
use std::path::PathBuf;

/// What is saved, and the open questions.
#[derive(Default)]
pub(in crate::desktop) struct SaveState {
    /// The saved site file and technique; `None` for a bare model.
    pub(in crate::desktop) saved: Option<(SiteFile, Method)>,
    pub(in crate::desktop) question: Option<SaveQuestion>,
    /// The action after saving.
    pub(in crate::desktop) then: Option<PendingAction>,
    /// Set by Ctrl+S or by closing the window: saves once fields have taken over the typed text.
    pub(in crate::desktop) saves: bool,
    pub(in crate::desktop) closes: bool,
    /// Whether the unsaved settings were discarded.
    pub(in crate::desktop) is_left: bool,
    pub(in crate::desktop) title: String,
    pub(in crate::desktop) recovery: Recovery,
}

/// A question about saving.
pub(in crate::desktop) enum SaveQuestion {
    /// Asks what becomes of unsaved settings.
    Unsaved(PendingAction),
    /// Asks whether the site file, which has changed since it was read, is replaced.
    Replaced(PathBuf),
}

/// An action that would lose unsaved settings.
pub(in crate::desktop) enum PendingAction {
    /// Closes the window.
    Close,
    /// Opens another site.
    Open(Box<Project>),
    /// Reads the site file again.
    Reload,
}

impl SaveState {
    /// Makes the title be set again, for a new window.
    pub(in crate::desktop) fn forget_title(&mut self) {
        self.title.clear();
    }
}
