//! Saves the site file, and asks before unsaved settings would be lost.

use crate::desktop::app::state::App;
use crate::desktop::parts::path_dialog::Purpose;
use crate::desktop::parts::question::Question;
use crate::desktop::state::project::name_of;
use crate::desktop::state::saving::{PendingAction, SaveQuestion};
use crate::desktop::work::export;
use crate::desktop::work::samples;
use crate::export::file;
use eframe::egui::{self, ViewportCommand};
use std::path::{Path, PathBuf};

impl App {
    /// Whether there are settings that are not in a file.
    pub fn is_unsaved(&self) -> bool {
        self.open.is_some()
            && self
                .saving
                .saved
                .as_ref()
                .is_none_or(|(site, method)| *site != self.settings.site || *method != self.settings.shown.method)
    }

    /// The title of the window: the file, with a mark while there are unsaved settings.
    pub fn title(&self) -> String {
        match self.file_name() {
            Some(name) => format!("{}{name} — Gnomon", if self.is_unsaved() { "• " } else { "" }),
            None => "Gnomon".to_owned(),
        }
    }

    /// The name of the open file in the title; a `site.toml` has its folder's name.
    fn file_name(&self) -> Option<String> {
        let project = &self.open.as_ref()?.project;
        let path = project.path.as_deref().unwrap_or(Path::new(&project.written.file));
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
        let folder = name_of(path);
        Some(if folder == name { name } else { format!("{folder}/{name}") })
    }

    /// Records the current settings as saved, or as those of a bare model.
    pub(in crate::desktop) fn note_saved(&mut self) {
        let saved = || (self.settings.site.clone(), self.settings.shown.method);
        let has_file = self.open.as_ref().is_some_and(|open| open.project.path.is_some());
        self.saving.saved = has_file.then(saved);
    }

    /// Writes the open site file; asks for a path for a bare model or a sample.
    pub(in crate::desktop) fn save_site(&mut self, context: &egui::Context) {
        let Some(open) = &self.open else { return };
        match &open.project.path {
            Some(path) if !samples::is_sample(path) => {
                let path = path.clone();
                if open.project.written.has_changed_at(&path) {
                    self.saving.question = Some(SaveQuestion::Replaced(path));
                } else {
                    self.write_site(path, context);
                }
            }
            _ => self.ask_where(context),
        }
    }

    /// Asks for the path of the site file. If another path dialog is open, nothing is saved.
    fn ask_where(&mut self, context: &egui::Context) {
        self.ask(Purpose::SaveSite, context);
        if !self.asking.as_ref().is_some_and(|asking| asking.purpose() == Purpose::SaveSite) {
            self.give_up_saving();
        }
    }

    /// The proposed path of the site file: where it is, or a new one.
    pub(in crate::desktop) fn proposed_site(&self) -> PathBuf {
        let open = self.open.as_ref().map(|open| (&open.project.path, &open.project.written.file));
        let Some((path, file)) = open else { return self.folder().join("site.toml") };
        match path.as_deref().filter(|path| !samples::is_sample(path)) {
            Some(path) => path.to_owned(),
            None => {
                let named = path.as_deref().unwrap_or(Path::new(file));
                let name = Path::new(&name_of(named)).with_extension("toml");
                let plain = self.folder().join("site.toml");
                if plain.exists() { self.folder().join(name) } else { plain }
            }
        }
    }

    /// Writes the site file, which becomes the open one.
    pub(in crate::desktop) fn write_site(&mut self, path: PathBuf, context: &egui::Context) {
        let then = self.saving.then.take();
        self.notice = None;
        let Some(open) = &mut self.open else { return };
        let mut written = export::written(&open.project, &self.settings, &open.viewer.eye, &path);
        // a model must not be overwritten by a site file
        let models = file::check_inputs(&open.project.written.model_files(), std::slice::from_ref(&path));
        let text = models.map_err(anyhow::Error::from).and_then(|()| Ok(written.site.to_toml_in(&written.text)?));
        match text.and_then(|text| file::write(&path, text.as_bytes()).map(|()| text).map_err(Into::into)) {
            Ok(text) => {
                written.text = text;
                // states that undo restores must also be read from the new folder
                let from = open.project.written.folder.clone();
                self.history.change_all(|site| export::move_files(site, &from, &written.folder));
                self.notice = Some(format!("Written: {}", path.display()));
                open.project.path = Some(path);
                let is_read = open.project.written.site == self.settings.site;
                self.settings.site = written.site.clone();
                // a load in progress would restore the old file
                let loading = self.loading.take_if(|loading| !loading.opens);
                if let Some(loading) = &loading {
                    loading.cancel();
                    self.is_reading = false;
                }
                // an interrupted load, or a change in this frame, must be read from the settings
                if loading.is_some() || !is_read {
                    written.site.clone_from(&open.project.written.site);
                    export::move_files(&mut written.site, &from, &written.folder);
                }
                open.project.written = written;
                self.history.note(&self.settings);
                // a model may have changed
                self.changed = open.project.changed_file().map(name_of);
                // an error in the site itself stays visible
                self.fault = self.fault.take().filter(|_| self.refused.is_some());
                self.note_saved();
                if let Some(then) = then {
                    self.go_on(then, context);
                }
            }
            Err(error) => self.fault = Some(error.to_string()),
        }
    }

    /// Performs an action if nothing would be lost; otherwise asks first.
    pub(in crate::desktop) fn go_on_or_ask(&mut self, then: PendingAction, context: &egui::Context) {
        if self.is_unsaved() {
            self.question_unsaved(then);
        } else {
            self.go_on(then, context);
        }
    }

    /// Asks what to do with unsaved settings, and forgets the action of an earlier question.
    fn question_unsaved(&mut self, then: PendingAction) {
        self.give_up_saving();
        self.saving.question = Some(SaveQuestion::Unsaved(then));
    }

    fn go_on(&mut self, then: PendingAction, context: &egui::Context) {
        match then {
            PendingAction::Close => {
                self.saving.is_left = true;
                self.keep_unsaved(context);
                context.send_viewport_cmd(ViewportCommand::Close);
            }
            PendingAction::Open(project) => self.take(*project, true),
            PendingAction::Reload => self.reload_now(context),
        }
    }

    /// After nothing was saved: forgets the action that was to follow.
    pub(in crate::desktop) fn give_up_saving(&mut self) {
        self.saving.then = None;
    }

    /// Whether the unsaved settings were discarded.
    pub(in crate::desktop) fn is_left(&self) -> bool {
        self.saving.is_left
    }

    /// Whether a question is open, so that nothing else may happen.
    pub(in crate::desktop) fn is_questioned(&self) -> bool {
        self.saving.question.is_some() || self.saving.recovery.is_offering() || !self.dropped.is_empty()
    }

    /// Keeps the window open while there are unsaved settings, even while it is hidden.
    pub(in crate::desktop) fn watch_closing(&mut self, context: &egui::Context) {
        let is_asked = context.input(|input| input.viewport().close_requested());
        if !is_asked || self.saving.is_left {
            return;
        }
        let is_hidden = context.input(|input| input.viewport().visible() == Some(false));
        if !is_hidden && context.memory(|memory| memory.focused().is_some()) {
            // typed text is taken over first, in this frame
            context.memory_mut(|memory| memory.stop_text_input());
            context.send_viewport_cmd(ViewportCommand::CancelClose);
            self.saving.closes = true;
        } else if self.is_unsaved() {
            context.send_viewport_cmd(ViewportCommand::CancelClose);
            self.question_unsaved(PendingAction::Close);
            if is_hidden {
                context.send_viewport_cmd(ViewportCommand::Minimized(false));
                context.send_viewport_cmd(ViewportCommand::Focus);
            }
        }
    }

    /// Runs at the end of a frame, after fields have taken over the typed text: saves, closes, asks, and sets the
    /// title.
    pub(in crate::desktop) fn save_and_ask(&mut self, context: &egui::Context) {
        if std::mem::take(&mut self.saving.saves) {
            // only the answer to its own question can follow
            self.give_up_saving();
            self.save_site(context);
        }
        if std::mem::take(&mut self.saving.closes) {
            self.go_on_or_ask(PendingAction::Close, context);
        }
        match self.saving.question.take() {
            Some(SaveQuestion::Unsaved(then)) => self.ask_unsaved(then, context),
            Some(SaveQuestion::Replaced(path)) => self.ask_replaced(path, context),
            None => self.offer_recovered(context),
        }
        let title = self.title();
        if title != self.saving.title {
            context.send_viewport_cmd(ViewportCommand::Title(title.clone()));
            self.saving.title = title;
        }
    }

    fn ask_unsaved(&mut self, then: PendingAction, context: &egui::Context) {
        let name = self.file_name().unwrap_or_default();
        let what = match &then {
            PendingAction::Close => "before the window closes",
            PendingAction::Open(_) => "before another site takes its place",
            PendingAction::Reload => "before the file, which has changed on the disk, takes its place",
        };
        let answer = Question {
            heading: "Save what was set?",
            text: &format!("What was set for {name} is not saved. Save it {what}?"),
            path: "",
            answers: ["Save", "Don't save", "Cancel"],
            first: 0,
        };
        match answer.show(context) {
            None => self.saving.question = Some(SaveQuestion::Unsaved(then)),
            Some(0) => {
                self.saving.then = Some(then);
                self.save_site(context);
            }
            Some(1) => self.go_on(then, context),
            Some(_) => {}
        }
    }

    fn ask_replaced(&mut self, path: PathBuf, context: &egui::Context) {
        let answer = Question {
            heading: "Replace the file?",
            text: &format!("{} has changed on the disk since it was read here.", name_of(&path)),
            path: &path.display().to_string(),
            answers: ["Replace it", "Save as…", "Cancel"],
            first: 2,
        };
        match answer.show(context) {
            None => self.saving.question = Some(SaveQuestion::Replaced(path)),
            Some(0) => self.write_site(path, context),
            Some(1) => self.ask_where(context),
            Some(_) => self.give_up_saving(),
        }
    }
}
