//! A copy of unsaved settings beside the window's own data, which survives a crash or a kill.

use crate::choice::Method;
use crate::desktop::state::project::Project;
use crate::export::recovery::{Slot, UnsavedSite, left_behind};
use crate::site::WrittenSite;
use crate::site::file::SiteFile;
use eframe::egui;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// How long settings must stay unchanged before they are stored.
const REST: Duration = Duration::from_secs(2);
/// How long they may keep changing before they are stored nevertheless.
const MOST: Duration = Duration::from_secs(10);

/// The site file as it would be written, and the technique.
type State = (SiteFile, Method);

/// The stored unsaved settings, and those of earlier windows.
#[derive(Default)]
pub(in crate::desktop) struct Recovery {
    /// The folder; `None` to store nothing.
    folder: Option<PathBuf>,
    slot: Option<Slot>,
    /// The contents of the slot.
    kept: Option<State>,
    /// The last seen state that is not stored: since when it differs from the slot, and since when it is unchanged.
    seen: Option<(State, Instant, Instant)>,
    /// The unsaved settings of windows that have ended.
    left: Vec<(Slot, UnsavedSite)>,
    /// Those that are being restored.
    restoring: Option<(Slot, SiteFile)>,
    /// Whether the user was told that settings cannot be stored.
    is_reported: bool,
}

impl Recovery {
    /// Uses a folder, and offers the settings there of windows that have ended.
    pub(in crate::desktop) fn begin_in(&mut self, folder: &Path) {
        self.left = left_behind(folder);
        self.folder = Some(folder.to_owned());
    }

    /// Whether there is an offer.
    pub(in crate::desktop) fn is_offering(&self) -> bool {
        !self.left.is_empty()
    }

    /// The first offer.
    pub(in crate::desktop) fn offer(&self) -> Option<&UnsavedSite> {
        self.left.first().map(|(_, unsaved)| unsaved)
    }

    /// Takes the first offer.
    pub(in crate::desktop) fn take_offer(&mut self) -> Option<(Slot, UnsavedSite)> {
        (!self.left.is_empty()).then(|| self.left.remove(0))
    }

    /// Makes no more offers until the next start.
    pub(in crate::desktop) fn offer_later(&mut self) {
        self.left.clear();
    }

    /// Remembers settings while their site is being opened.
    pub(in crate::desktop) fn restore(&mut self, slot: Slot, site: SiteFile) {
        self.restoring = Some((slot, site));
    }

    /// Takes the settings for the site that was opened.
    pub(in crate::desktop) fn take_restored(&mut self) -> Option<(Slot, SiteFile)> {
        self.restoring.take()
    }

    /// Forgets the settings of a site that could not be opened; they will be offered again.
    pub(in crate::desktop) fn let_go(&mut self) {
        self.restoring = None;
    }

    /// Continues with a slot that contains the current settings.
    pub(in crate::desktop) fn go_on_with(&mut self, slot: Slot, state: State) {
        if let Some(other) = self.slot.replace(slot) {
            other.empty();
        }
        self.kept = Some(state);
    }

    /// Removes the stored settings, as everything is saved or discarded.
    pub(in crate::desktop) fn empty(&mut self) {
        if self.folder.is_none() {
            return;
        }
        (self.kept, self.seen) = (None, None);
        if let Some(slot) = self.slot.take() {
            slot.empty();
        }
    }

    /// Stores a site's settings once they stop changing. Returns, once, why that is not possible.
    pub(in crate::desktop) fn keep(
        &mut self,
        project: &Project,
        (site, method): (&SiteFile, Method),
        context: &egui::Context,
    ) -> Option<String> {
        let folder = self.folder.clone()?;
        let is_now = |state: &State| state.0 == *site && state.1 == method;
        if self.kept.as_ref().is_some_and(is_now) {
            self.seen = None;
            return None;
        }
        let now = Instant::now();
        let (state, first, last) = match self.seen.take() {
            Some((state, first, last)) if is_now(&state) => (state, first, last),
            Some((_, first, _)) => ((site.clone(), method), first, now),
            None => ((site.clone(), method), now, now),
        };
        if last.elapsed() < REST && first.elapsed() < MOST {
            context.request_repaint_after(REST);
            self.seen = Some((state, first, last));
            return None;
        }
        let mut written = WrittenSite { site: site.clone(), ..project.written.clone() };
        written.site.study.technique = Some(method.word().to_owned());
        // after a failure, the next change is tried again
        self.kept = Some(state);
        let error = self.write(&folder, &UnsavedSite { path: project.path.clone(), written }).err()?;
        (!std::mem::replace(&mut self.is_reported, true)).then_some(error)
    }

    fn write(&mut self, folder: &Path, unsaved: &UnsavedSite) -> Result<(), String> {
        let slot = self.slot.take().map_or_else(|| Slot::new(folder), Ok);
        let slot = slot.map_err(|error| format!("{}: {error}", folder.display()))?;
        let written = slot.keep(unsaved).map_err(|error| error.to_string());
        self.slot = Some(slot);
        written
    }
}
