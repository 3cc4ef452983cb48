//! The commands of the window: open, write, copy, show everything.

use crate::desktop::app::state::App;
use crate::desktop::parts::path_dialog::{PathDialog, Purpose};
use crate::desktop::results::judged::JudgedResult;
use crate::desktop::state::project::{Project, name_of};
use crate::desktop::state::saving::PendingAction;
use crate::desktop::work::export;
use crate::desktop::work::judging;
use crate::desktop::work::loading::{LoadJob, LoadRequest};
use crate::desktop::work::samples;
use eframe::egui;
use std::path::{Path, PathBuf};
use std::sync::Arc;

impl App {
    pub(in crate::desktop) fn ask(&mut self, purpose: Purpose, context: &egui::Context) {
        if self.asking.is_none() {
            let proposed =
                if purpose == Purpose::SaveSite { self.proposed_site() } else { self.folder().join(purpose.name()) };
            let result = self.open.as_ref().and_then(|open| open.result.as_ref());
            let files = match purpose {
                Purpose::Hours => result.map_or(Vec::new(), |result| result.names()),
                Purpose::Lines(lines) => lines.names().map(PathBuf::from).to_vec(),
                Purpose::Verdicts => JudgedResult::names(),
                _ => Vec::new(),
            };
            self.asking = Some(PathDialog::start(purpose, proposed, files, context.clone()));
        }
    }

    /// Checks, when the window gets the focus back, whether the site's files have changed since they were read.
    pub(in crate::desktop) fn look_for_changes(&mut self, context: &egui::Context) {
        let has_focus = context.input(|input| input.focused);
        if has_focus && !std::mem::replace(&mut self.had_focus, has_focus) {
            let changed = self.open.as_ref().and_then(|open| open.project.changed_file());
            self.changed = changed.map(name_of);
        }
        self.had_focus = has_focus;
    }

    /// Reads the open site's files again. Settings of the window stay if the site file has not changed on the disk;
    /// otherwise the window asks about them, and undo restores them.
    pub(in crate::desktop) fn reload(&mut self, context: &egui::Context) {
        let Some(open) = &self.open else { return };
        if open.project.path.as_ref().is_some_and(|path| open.project.written.has_changed_at(path)) {
            self.go_on_or_ask(PendingAction::Reload, context);
        } else {
            self.reload_now(context);
        }
    }

    pub(in crate::desktop) fn reload_now(&mut self, context: &egui::Context) {
        let Some(open) = self.open.as_ref().filter(|_| self.loading.is_none()) else { return };
        (self.fault, self.notice, self.changed) = (None, None, None);
        match open.project.on_disk(&self.settings.site) {
            Ok(written) => {
                let is_of_file = written.text != open.project.written.text;
                self.settings.site = written.site.clone();
                let hidden = Arc::clone(&self.settings.hidden);
                let wanted = LoadRequest::Again(Box::new(written), hidden, Box::new(open.project.loaded(true)));
                self.loading = Some(LoadJob::start(wanted, &self.reading, context.clone()));
                self.is_reading = true;
                if is_of_file {
                    let technique = self.settings.site.study.technique.as_deref();
                    self.settings.shown.method = technique.and_then(|word| word.parse().ok()).unwrap_or_default();
                    self.note_saved();
                }
            }
            Err(error) => self.fault = Some(error.to_string()),
        }
    }

    pub(in crate::desktop) fn folder(&self) -> PathBuf {
        let is_own = |project: &Project| !project.path.as_deref().is_some_and(samples::is_sample);
        let of_site = self.open.as_ref().map(|open| &open.project).filter(|project| is_own(project));
        let of_site = of_site.map(|project| project.written.folder.clone());
        let recent = || self.kept.recent.iter().find(|path| !samples::is_sample(path));
        let of_recent = || recent().and_then(|path| path.parent()).map(Path::to_owned);
        let folder = of_site.or_else(of_recent).filter(|folder| folder.is_dir());
        folder.or_else(|| std::env::current_dir().ok()).unwrap_or_default()
    }

    pub(in crate::desktop) fn answer(&mut self, purpose: Purpose, path: PathBuf, context: &egui::Context) {
        self.notice = None;
        match purpose {
            Purpose::Open => return self.load(LoadRequest::Files(vec![path]), context),
            Purpose::Compare => return self.compare_with(&path, context),
            Purpose::SaveSite => return self.write_site(path, context),
            _ => {}
        }
        if self.writing.is_some() {
            self.fault = Some("An export is under way: wait for it or cancel it, then export this".to_owned());
            return;
        }
        let Some(open) = &mut self.open else { return };
        match purpose {
            Purpose::Open | Purpose::Compare | Purpose::SaveSite => {}
            Purpose::Drawing => {
                let (eye, time) = (open.viewer.eye, open.clock.now.time);
                self.writing = Some(export::drawing(&open.project, &self.settings, eye, time, path, context.clone()));
            }
            Purpose::Animation => {
                let eye = open.viewer.eye;
                self.writing = Some(export::animation(&open.project, &self.settings, eye, path, context.clone()));
            }
            Purpose::Verdicts => {
                if let Some(judged) = open.judge.judged.clone() {
                    self.writing = Some(judging::written(&open.project, judged, path, context.clone()));
                }
            }
            Purpose::Hours => {
                if let Some(result) = open.result.clone() {
                    let work = export::found(&open.project, &self.settings, result, None, path, context.clone());
                    self.writing = Some(work);
                }
            }
            Purpose::Lines(lines) => {
                if let Some(result) = open.result.clone() {
                    let work = export::found(&open.project, &self.settings, result, Some(lines), path, context.clone());
                    self.writing = Some(work);
                }
            }
        }
    }

    pub(in crate::desktop) fn copy(&mut self, context: &egui::Context) {
        match self.picture() {
            Ok((width, height, pixels)) => {
                let size = [width as usize, height as usize];
                let image = egui::ColorImage::from_rgba_unmultiplied(size, bytemuck::cast_slice(&pixels));
                context.copy_image(image);
                self.notice = Some("The picture is on the clipboard".to_owned());
            }
            Err(error) => self.fault = Some(error.to_string()),
        }
    }
}
