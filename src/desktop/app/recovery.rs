//! Stores unsaved settings, and offers them after a crash or a kill.

use crate::desktop::app::state::App;
use crate::desktop::parts::question::Question;
use crate::desktop::state::project::name_of;
use crate::desktop::work::loading::LoadRequest;
use crate::export::recovery::{Slot, UnsavedSite};
use crate::site::WrittenSite;
use crate::site::file::SiteFile;
use eframe::egui;
use std::path::Path;

impl App {
    /// The same window, which stores unsaved settings beside eframe's own data.
    pub(in crate::desktop) fn recovering(self) -> App {
        match eframe::storage_dir("gnomon") {
            Some(folder) => self.recovering_in(&folder.join("recovery")).keeping_studies_in(&folder.join("studies")),
            None => self,
        }
    }

    /// The same window, which stores unsaved settings in a folder, and offers those of windows that have ended.
    pub fn recovering_in(mut self, folder: &Path) -> App {
        self.saving.recovery.begin_in(folder);
        self
    }

    /// Stores unsaved settings once they stop changing, and removes them if everything is saved.
    pub(in crate::desktop) fn keep_unsaved(&mut self, context: &egui::Context) {
        let is_wanted = self.is_unsaved() && !self.is_left();
        let Some(open) = &self.open else { return };
        let recovery = &mut self.saving.recovery;
        if !is_wanted {
            recovery.empty();
            return;
        }
        let settings = (&self.settings.site, self.settings.shown.method);
        if let Some(error) = recovery.keep(&open.project, settings, context) {
            self.fault = Some(format!("what is not saved cannot be kept against a crash: {error}"));
        }
    }

    /// Offers the unsaved settings of a window that has ended.
    pub(in crate::desktop) fn offer_recovered(&mut self, context: &egui::Context) {
        let Some(unsaved) = self.saving.recovery.offer() else { return };
        let file = unsaved.path.as_deref().unwrap_or(Path::new(&unsaved.written.file));
        let answer = Question {
            heading: "Restore what was not saved?",
            text: &format!("Gnomon was ended before what was set for {} was saved.", name_of(file)),
            path: &file.display().to_string(),
            answers: ["Restore", "Discard", "Ask me later"],
            first: 0,
        };
        let Some(answer) = answer.show(context) else { return };
        let Some((slot, unsaved)) = self.saving.recovery.take_offer() else { return };
        match answer {
            0 => {
                // one at a time: the others are offered at the next start
                self.saving.recovery.offer_later();
                self.restore(slot, unsaved, context);
            }
            1 => slot.empty(),
            _ => self.saving.recovery.offer_later(),
        }
    }

    /// Opens the site with the site file that the settings were based on, and applies the unsaved settings as a change
    /// that undo can revert.
    fn restore(&mut self, slot: Slot, unsaved: UnsavedSite, context: &egui::Context) {
        let UnsavedSite { path, written } = unsaved;
        let set = written.site.clone();
        let site = match written.text.as_str() {
            // a bare model keeps the place that was set
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
        self.saving.recovery.restore(slot, set);
    }

    /// Applies recovered settings once their site is open.
    pub(in crate::desktop) fn set_recovered(&mut self) {
        let Some((slot, mut site)) = self.saving.recovery.take_restored() else { return };
        let technique = site.study.technique.take();
        self.settings.shown.method = technique.and_then(|word| word.parse().ok()).unwrap_or_default();
        site.study.technique.clone_from(&self.settings.site.study.technique);
        self.settings.site = site;
        // they stay stored until they are saved
        self.saving.recovery.go_on_with(slot, (self.settings.site.clone(), self.settings.shown.method));
        let changed = self.open.as_ref().and_then(|open| open.project.changed_file());
        self.changed = changed.map(name_of);
    }
}
