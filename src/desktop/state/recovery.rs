//! Unsaved settings, kept beside the window's own data, so that they survive a crash or a kill.

use crate::choice::Method;
use crate::desktop::state::project::Project;
use crate::export::recovery::{Slot, UnsavedSite, left_behind};
use crate::site::WrittenSite;
use crate::site::file::SiteFile;
use eframe::egui;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// How long nothing changes before it is kept.
const REST: Duration = Duration::from_secs(2);
/// How long it may go on changing before it is kept all the same.
const MOST: Duration = Duration::from_secs(10);

/// What a site file would say, and by which technique.
type State = (SiteFile, Method);

/// What is kept of what is not saved, and what was found of earlier windows.
#[derive(Default)]
pub(in crate::desktop) struct Recovery {
    /// Where it is kept; nowhere without one.
    folder: Option<PathBuf>,
    slot: Option<Slot>,
    /// What the slot has.
    kept: Option<State>,
    /// What was seen last that the slot has not, since when there is such, and since when it is this.
    seen: Option<(State, Instant, Instant)>,
    /// What windows that have ended had not saved.
    left: Vec<(Slot, UnsavedSite)>,
    /// What of it is being opened.
    restoring: Option<(Slot, SiteFile)>,
    /// The user knows that nothing can be kept.
    is_reported: bool,
}

impl Recovery {
    /// Keeps in a folder what is not saved, and offers what is there of windows that have ended.
    pub(in crate::desktop) fn begin_in(&mut self, folder: &Path) {
        self.left = left_behind(folder);
        self.folder = Some(folder.to_owned());
    }

    /// Whether something is offered.
    pub(in crate::desktop) fn is_offering(&self) -> bool {
        !self.left.is_empty()
    }

    /// What is offered first.
    pub(in crate::desktop) fn offer(&self) -> Option<&UnsavedSite> {
        self.left.first().map(|(_, unsaved)| unsaved)
    }

    /// Takes what is offered first.
    pub(in crate::desktop) fn take_offer(&mut self) -> Option<(Slot, UnsavedSite)> {
        (!self.left.is_empty()).then(|| self.left.remove(0))
    }

    /// Offers nothing more until the next start.
    pub(in crate::desktop) fn offer_later(&mut self) {
        self.left.clear();
    }

    /// A site is being opened to which this belongs.
    pub(in crate::desktop) fn restore(&mut self, slot: Slot, site: SiteFile) {
        self.restoring = Some((slot, site));
    }

    /// Takes what belongs to the site that was opened.
    pub(in crate::desktop) fn take_restored(&mut self) -> Option<(Slot, SiteFile)> {
        self.restoring.take()
    }

    /// Nothing is being opened any more; what was is offered another time.
    pub(in crate::desktop) fn let_go(&mut self) {
        self.restoring = None;
    }

    /// A slot that has what is set now stays this window's.
    pub(in crate::desktop) fn go_on_with(&mut self, slot: Slot, state: State) {
        if let Some(other) = self.slot.replace(slot) {
            other.empty();
        }
        self.kept = Some(state);
    }

    /// All is saved, or nobody wants what is not: nothing stays.
    pub(in crate::desktop) fn empty(&mut self) {
        if self.folder.is_none() {
            return;
        }
        (self.kept, self.seen) = (None, None);
        if let Some(slot) = self.slot.take() {
            slot.empty();
        }
    }

    /// Keeps what is set for a site, once it rests. Returns, once, why it cannot.
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
        // what cannot be kept now is tried again with the next change
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
