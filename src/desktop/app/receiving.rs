//! Receives the results of work in other threads.

use crate::desktop::app::state::App;
use crate::desktop::parts::point_sky::PointSky;
use crate::desktop::results::StudyResult;
use crate::desktop::results::before::BeforeState;
use crate::desktop::state::bare_model::BareModel;
use crate::desktop::state::saving::PendingAction;
use crate::desktop::work::Work;
use crate::desktop::work::loading::{LoadError, LoadJob};
use crate::desktop::work::studies::ClickedSun;
use eframe::egui;
use std::sync::Arc;

impl App {
    /// Receives the results of work in other threads.
    pub(in crate::desktop) fn receive(&mut self, context: &egui::Context) {
        self.receive_note();
        self.receive_site(context);
        self.receive_file();
        if let Some(open) = &mut self.open {
            open.viewer.receive(&self.stage, &self.render);
        }
        self.receive_study();
        self.receive_sunlight();
        self.receive_judged();
        self.sketch(context);
    }

    fn receive_note(&mut self) {
        let open = self.open.as_ref();
        let notes = [
            self.stage.note(),
            self.writing.as_ref().and_then(Work::note),
            open.and_then(|open| open.adding.as_ref()).and_then(Work::note),
            open.and_then(|open| open.probing.as_ref()).and_then(Work::note),
            open.and_then(|open| open.judge.judging.as_ref()).and_then(Work::note),
        ];
        if let Some(note) = notes.into_iter().flatten().next() {
            self.notice = Some(note);
        }
    }

    fn receive_site(&mut self, context: &egui::Context) {
        let Some(result) = self.loading.as_ref().and_then(LoadJob::done) else { return };
        let opens = self.loading.take().is_none_or(|loading| loading.opens);
        self.is_reading = false;
        match result {
            Ok(project) if opens => self.go_on_or_ask(PendingAction::Open(Box::new(project)), context),
            Ok(project) => self.take(project, false),
            Err(LoadError::Bare(paths)) => self.bare = Some(BareModel::new(paths)),
            Err(LoadError::Message(fault)) => {
                self.fault = Some(fault);
                if !opens {
                    self.refused = Some(self.settings.clone());
                }
            }
        }
    }

    fn receive_file(&mut self) {
        let Some(writing) = &self.writing else { return };
        let Some(result) = writing.done() else { return };
        let notes = writing.notes();
        self.writing = None;
        if let Some(open) = &mut self.open {
            open.export_notes = notes;
        }
        match result {
            Ok(path) => self.notice = Some(format!("Written: {}", path.display())),
            Err(fault) => self.fault = Some(fault),
        }
    }

    fn receive_study(&mut self) {
        let Some(open) = &mut self.open else { return };
        let Some(adding) = &open.adding else { return };
        let Some(result) = adding.done() else { return };
        let notes = adding.notes();
        open.adding = None;
        match result {
            // colours of faces belong to the model for which they were found
            Ok(result) if !result.lies_on(&open.project.site) => {
                self.notice = Some("The model has changed since: find the hours again".to_owned());
            }
            Ok(result) => self.lay(result.noted(notes)),
            Err(fault) => self.fault = Some(fault),
        }
    }

    /// Shows a result on the scene. After a comparison, the state before is kept for further ones.
    fn lay(&mut self, result: StudyResult) {
        let Some(open) = &mut self.open else { return };
        if let Some(change) = result.change() {
            let before = Arc::clone(&change.before);
            if open.before.as_ref().is_none_or(|state| state.before != before || state.result.is_none()) {
                let models = change.models.clone();
                open.before = Some(BeforeState { before: Arc::clone(&before), models, result: None });
            }
            self.settings.before = Some(before);
        }
        open.result = Some(Arc::new(result));
        open.shows_hours = true;
    }

    fn receive_sunlight(&mut self) {
        let Some(open) = &mut self.open else { return };
        let Some(result) = open.probing.as_ref().and_then(Work::done) else { return };
        open.probing = None;
        match result {
            Ok(ClickedSun { sunlight, sky }) => {
                (open.sunlight, open.sky) = (Some(sunlight), sky.map(PointSky::new));
            }
            Err(fault) => self.fault = Some(fault),
        }
    }
}
