//! What a person asks of the window: to open, to write, to copy, to see all.

use super::app::App;
use super::files::{Asking, Purpose};
use super::handing;
use super::loading::{Loading, Wanted, name_of};
use crate::export::file;
use eframe::egui;
use std::path::{Path, PathBuf};
use std::sync::Arc;

impl App {
    pub(super) fn ask(&mut self, purpose: Purpose, context: &egui::Context) {
        if self.asking.is_none() {
            self.asking = Some(Asking::start(purpose, Some(self.folder()), context.clone()));
        }
    }

    /// Looks whether the site's files are still what was read: when the window gets the focus back.
    pub(super) fn look_for_changes(&mut self, context: &egui::Context) {
        let has_focus = context.input(|input| input.focused);
        if has_focus && !std::mem::replace(&mut self.had_focus, has_focus) {
            let changed = self.open.as_ref().and_then(|open| open.project.changed_file());
            self.changed = changed.map(name_of);
        }
        self.had_focus = has_focus;
    }

    /// Reads the open site's files anew. What was set in the window stays where the site file has not changed on the disk,
    /// and else is what undo brings back.
    pub(super) fn reload(&mut self, context: &egui::Context) {
        let Some(open) = self.open.as_ref().filter(|_| self.loading.is_none()) else { return };
        (self.fault, self.notice, self.changed) = (None, None, None);
        match open.project.on_disk(&self.settings.site) {
            Ok(written) => {
                self.settings.site = written.site.clone();
                let hidden = Arc::clone(&self.settings.hidden);
                let wanted = Wanted::Again(Box::new(written), hidden, Box::new(open.project.before(true)));
                self.loading = Some(Loading::start(wanted, context.clone()));
                self.is_reading = true;
            }
            Err(error) => self.fault = Some(error.to_string()),
        }
    }

    pub(super) fn folder(&self) -> PathBuf {
        let of_site = self.open.as_ref().map(|open| open.project.written.folder.clone());
        let of_recent = || self.kept.recent.first().and_then(|path| path.parent()).map(Path::to_owned);
        let folder = of_site.or_else(of_recent).filter(|folder| folder.is_dir());
        folder.or_else(|| std::env::current_dir().ok()).unwrap_or_default()
    }

    pub(super) fn answer(&mut self, purpose: Purpose, path: PathBuf, context: &egui::Context) {
        self.notice = None;
        match purpose {
            Purpose::Open => return self.load(Wanted::File(path), context),
            Purpose::Compare => return self.compare_with(&path, context),
            _ => {}
        }
        let Some(open) = &mut self.open else { return };
        match purpose {
            Purpose::Open | Purpose::Compare => {}
            Purpose::SaveSite => {
                let mut written = handing::written(&open.project, &self.settings, &open.viewer.eye, &path);
                let text = written.site.to_toml_in(&written.text).map_err(anyhow::Error::from);
                match text.and_then(|text| file::write(&path, text.as_bytes()).map(|()| text).map_err(Into::into)) {
                    Ok(text) => {
                        written.text = text;
                        // what undo brings back is read from the new place, too
                        let from = open.project.written.folder.clone();
                        self.history.change_all(|site| handing::move_models(site, &from, &written.folder));
                        self.notice = Some(format!("Written: {}", path.display()));
                        open.project.path = Some(path);
                        self.settings.site = written.site.clone();
                        open.project.written = written;
                        self.history.note(&self.settings);
                    }
                    Err(error) => self.fault = Some(error.to_string()),
                }
            }
            Purpose::Drawing => {
                let (eye, time) = (open.viewer.eye, open.clock.now.time);
                self.writing = Some(handing::drawing(&open.project, &self.settings, eye, time, path, context.clone()));
            }
            Purpose::Animation => {
                let eye = open.viewer.eye;
                self.writing = Some(handing::animation(&open.project, &self.settings, eye, path, context.clone()));
            }
            Purpose::Hours => {
                if let Some(laid) = open.laid.clone() {
                    let files = move || laid.files();
                    let work = handing::found(&open.project, &self.settings, files, path, context.clone());
                    self.writing = Some(work);
                }
            }
            Purpose::Lines(lines) => {
                if let Some(laid) = open.laid.clone() {
                    let files = move || laid.lines(lines);
                    let work = handing::found(&open.project, &self.settings, files, path, context.clone());
                    self.writing = Some(work);
                }
            }
        }
    }

    pub(super) fn copy(&mut self, context: &egui::Context) {
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
