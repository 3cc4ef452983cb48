//! What is not saved is kept beside the window's own data, and offered after a crash or a kill.

use super::app::App;
use super::loading::{LoadRequest, name_of};
use super::question::Question;
use crate::choice::Method;
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
pub(super) struct Recovery {
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
    /// It was told that nothing can be kept.
    is_told: bool,
}

impl Recovery {
    /// Whether something is offered.
    pub(super) fn is_offering(&self) -> bool {
        !self.left.is_empty()
    }

    /// Nothing is being opened any more; what was is offered another time.
    pub(super) fn let_go(&mut self) {
        self.restoring = None;
    }
}

impl App {
    /// The same window, which keeps what is not saved beside what eframe keeps of it.
    pub(super) fn recovering(self) -> App {
        match eframe::storage_dir("gnomon") {
            Some(folder) => self.recovering_in(&folder.join("recovery")).keeping_studies_in(&folder.join("studies")),
            None => self,
        }
    }

    /// The same window, which keeps in a folder what is not saved, and offers what it finds there of windows that have ended.
    pub fn recovering_in(mut self, folder: &Path) -> App {
        let recovery = &mut self.saving.recovery;
        recovery.left = left_behind(folder);
        recovery.folder = Some(folder.to_owned());
        self
    }

    /// Keeps what is not saved, once it rests; and nothing where all is saved.
    pub(super) fn keep_unsaved(&mut self, context: &egui::Context) {
        let is_wanted = self.is_unsaved() && !self.is_left();
        let Some(open) = &self.open else { return };
        let recovery = &mut self.saving.recovery;
        let Some(folder) = &recovery.folder else { return };
        if !is_wanted {
            (recovery.kept, recovery.seen) = (None, None);
            if let Some(slot) = recovery.slot.take() {
                slot.empty();
            }
            return;
        }
        let (site, method) = (&self.settings.site, self.settings.shown.method);
        let is_now = |state: &State| state.0 == *site && state.1 == method;
        if recovery.kept.as_ref().is_some_and(is_now) {
            recovery.seen = None;
            return;
        }
        let now = Instant::now();
        let (state, first, last) = match recovery.seen.take() {
            Some((state, first, last)) if is_now(&state) => (state, first, last),
            Some((_, first, _)) => ((site.clone(), method), first, now),
            None => ((site.clone(), method), now, now),
        };
        if last.elapsed() < REST && first.elapsed() < MOST {
            context.request_repaint_after(REST);
            recovery.seen = Some((state, first, last));
            return;
        }
        let mut written = WrittenSite { site: site.clone(), ..open.project.written.clone() };
        written.site.study.technique = Some(method.word().to_owned());
        let unsaved = UnsavedSite { path: open.project.path.clone(), written };
        // what cannot be kept now is tried again with the next change
        recovery.kept = Some(state);
        let kept = recovery.slot.take().map_or_else(|| Slot::new(folder), Ok);
        let kept = kept.map_err(|error| format!("{}: {error}", folder.display())).and_then(|slot| {
            let kept = slot.keep(&unsaved).map_err(|error| error.to_string());
            recovery.slot = Some(slot);
            kept
        });
        if let Err(error) = kept
            && !std::mem::replace(&mut recovery.is_told, true)
        {
            self.fault = Some(format!("what is not saved cannot be kept against a crash: {error}"));
        }
    }

    /// Offers what a window that has ended had not saved.
    pub(super) fn offer_recovered(&mut self, context: &egui::Context) {
        let Some((_, unsaved)) = self.saving.recovery.left.first() else { return };
        let file = unsaved.path.as_deref().unwrap_or(Path::new(&unsaved.written.file));
        let answer = Question {
            heading: "Restore what was not saved?",
            text: &format!("Gnomon was ended before what was set for {} was saved.", name_of(file)),
            path: &file.display().to_string(),
            answers: ["Restore", "Discard", "Ask me later"],
            first: 0,
        };
        let Some(answer) = answer.show(context) else { return };
        let (slot, unsaved) = self.saving.recovery.left.remove(0);
        match answer {
            0 => {
                // one at a time: the others are offered at the next start
                self.saving.recovery.left.clear();
                self.restore(slot, unsaved, context);
            }
            1 => slot.empty(),
            _ => self.saving.recovery.left.clear(),
        }
    }

    /// Opens the site as its file was, and sets what was not saved: a change like any other, which undo takes back.
    fn restore(&mut self, slot: Slot, unsaved: UnsavedSite, context: &egui::Context) {
        let UnsavedSite { path, written } = unsaved;
        let set = written.site.clone();
        let site = match written.text.as_str() {
            // a bare model stands where it was put
            "" => SiteFile { place: set.place.clone(), model: set.model.clone(), ..SiteFile::default() },
            text => match SiteFile::parse(&written.file, text) {
                Ok(site) => site,
                Err(error) => {
                    self.fault = Some(error.to_string());
                    return;
                }
            },
        };
        self.load(LoadRequest::Left(path, Box::new(WrittenSite { site, ..written })), context);
        self.saving.recovery.restoring = Some((slot, set));
    }

    /// A site was opened to which something belongs that was not saved.
    pub(super) fn set_recovered(&mut self) {
        let Some((slot, mut site)) = self.saving.recovery.restoring.take() else { return };
        let technique = site.study.technique.take();
        self.settings.shown.method = technique.and_then(|word| word.parse().ok()).unwrap_or_default();
        site.study.technique.clone_from(&self.settings.site.study.technique);
        self.settings.site = site;
        // it stays kept
        let recovery = &mut self.saving.recovery;
        if let Some(other) = recovery.slot.replace(slot) {
            other.empty();
        }
        recovery.kept = Some((self.settings.site.clone(), self.settings.shown.method));
        let changed = self.open.as_ref().and_then(|open| open.project.changed_file());
        self.changed = changed.map(name_of);
    }
}
