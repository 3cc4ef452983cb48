//! Files that are dropped on the window. A site is opened; models are opened, or added to the open site.

use crate::desktop::app::state::App;
use crate::desktop::parts::question::Question;
use crate::desktop::state::project::name_of;
use crate::desktop::work::loading::LoadRequest;
use crate::formats;
use crate::message::few;
use crate::site::file::ModelTable;
use eframe::egui;
use std::path::PathBuf;

impl App {
    /// Handles dropped files. A file that is not a model is opened as a site, to which dropped models are added; models
    /// alone are opened if no site is open. Of several sites the first is opened.
    pub(in crate::desktop) fn take_dropped(&mut self, context: &egui::Context) {
        let dropped = |input: &egui::InputState| {
            input.raw.dropped_files.iter().map(|file| file.path().to_owned()).collect::<Vec<PathBuf>>()
        };
        let mut files = context.input(dropped);
        // all files of a shapefile are dropped together, but only one of them is the model
        let all = files.clone();
        files.retain(|file| !formats::goes_with_one_of(file, &all));
        let is_model = |file: &PathBuf| formats::is_model(file) && !file.is_dir();
        match files.iter().find(|file| !is_model(file)) {
            _ if files.is_empty() => {}
            Some(site) => {
                let (models, sites): (Vec<PathBuf>, Vec<PathBuf>) = files.iter().cloned().partition(is_model);
                self.load(LoadRequest::Files([vec![site.clone()], models].concat()), context);
                if let [_, others @ ..] = sites.as_slice()
                    && !others.is_empty()
                {
                    let names = few(others.iter().map(|other| name_of(other)).collect());
                    self.notice = Some(format!("Not opened: {names}. One site is open at a time."));
                }
            }
            None if self.open.is_none() => self.load(LoadRequest::Files(files), context),
            None => self.dropped = files,
        }
    }

    /// Asks what to do with models that were dropped on an open site.
    pub(in crate::desktop) fn ask_dropped(&mut self, context: &egui::Context) {
        let files = std::mem::take(&mut self.dropped);
        if files.is_empty() {
            return;
        }
        let names = few(files.iter().map(|file| name_of(file)).collect());
        let (is, it) = if files.len() == 1 { ("is a model", "it") } else { ("are models", "them") };
        let open = self.open.as_ref().map(|open| open.project.name()).unwrap_or_default();
        let answer = Question {
            heading: "Add to the site?",
            text: &format!("{names} {is}. Add {it} to {open}, or open {it} instead?"),
            path: "",
            answers: ["Add to the site", "Open instead", "Cancel"],
            first: 0,
        };
        match answer.show(context) {
            None => self.dropped = files,
            Some(0) => self.add_models(&files),
            Some(1) => self.load(LoadRequest::Files(files), context),
            Some(_) => {}
        }
    }

    /// Adds models to the open site, which is read again.
    pub(in crate::desktop) fn add_models(&mut self, files: &[PathBuf]) {
        let Some(open) = &self.open else { return };
        let written = &open.project.written;
        let tables = files.iter().map(|file| ModelTable { path: Some(written.path_of(file)), ..ModelTable::default() });
        self.settings.site.model.extend(tables);
    }
}
