//! The part of the panel that starts studies and comparisons, and shows their results.

use crate::choice::{Engine, Subject, listed};
use crate::desktop::app::state::{App, Open};
use crate::desktop::parts::path_dialog::Purpose;
use crate::desktop::parts::theme;
use crate::desktop::results::before::{self, BeforeState};
use crate::desktop::results::facades;
use crate::desktop::results::{Findings, StudyResult};
use crate::desktop::state::project::name_of;
use crate::desktop::state::settings::WindowSettings;
use crate::desktop::work::studies::{self, StudyOrder};
use eframe::egui::{self, Ui};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The buttons below the study's fields.
pub(in crate::desktop) fn show(app: &mut App, ui: &mut Ui) {
    let (context, studies) = (ui.ctx().clone(), app.studies.clone());
    let is_reading = app.is_reading;
    let Some(open) = &mut app.open else { return };
    if let Some(adding) = &open.adding {
        let (done, count) = adding.progress();
        let share = done as f32 / count.max(1) as f32;
        ui.add(egui::ProgressBar::new(share).text(if count == 0 {
            "Preparing".to_owned()
        } else {
            format!("{done} of {count} instants")
        }));
        if ui.button("Cancel the hours").clicked() {
            open.adding = None;
        }
    } else {
        let compares = app.settings.before.is_some();
        let mut goes = false;
        ui.horizontal(|ui| {
            let what = if compares { "Find the change" } else { "Find the hours" };
            goes = ui.add_enabled(!is_reading, egui::Button::new(what)).clicked();
            let facades = egui::Checkbox::new(&mut app.settings.shown.facades, "On façades, too");
            let response = ui.add_enabled(!compares, facades);
            response.on_disabled_hover_text("Two states are compared on ground and roofs");
        });
        if app.settings.shown.facades && !compares && facades::method(&app.settings) != app.settings.shown.method {
            let techniques = listed(&Subject::Patches.drawn_by(Engine::Auto), "or");
            ui.weak(format!("On façades auto chooses: {techniques}."));
        }
        if goes {
            find(open, &app.settings, studies, &context);
        }
    }
    let mut exports = false;
    if let Some(result) = &open.result {
        if !result.is_asked(&open.project, &app.settings) {
            ui.weak("The request has changed since: find it again.");
        }
        ui.horizontal(|ui| {
            ui.checkbox(&mut open.shows_hours, "Show the hours");
            exports = ui.button("Export…").on_hover_text("Drawing, raster and report, into a folder").clicked();
        });
    }
    if exports {
        app.ask(Purpose::Hours, &context);
    }
    compare(app, ui, &context);
    let Some(open) = &app.open else { return };
    if open.sunlight.is_none() && open.probing.is_none() {
        ui.weak("Click a point of the model: when does the sun reach it?");
    }
}

/// Starts finding what is requested.
pub(in crate::desktop) fn find(
    open: &mut Open,
    settings: &WindowSettings,
    studies: Option<PathBuf>,
    context: &egui::Context,
) {
    open.answers += 1;
    let of_facades = settings.before.is_none() && settings.shown.facades;
    let method = if of_facades { facades::method(settings) } else { settings.shown.method };
    let order = StudyOrder { method, number: open.answers, studies, context: context.clone() };
    open.adding = Some(match &settings.before {
        Some(before) => {
            let state = open.before.clone().filter(|state| state.before == *before);
            studies::change(&open.project, Arc::clone(before), state, order)
        }
        None if of_facades => studies::facades(&open.project, order),
        None => studies::hours(&open.project, order),
    });
}

/// The state that the open site is compared with.
fn compare(app: &mut App, ui: &mut Ui, context: &egui::Context) {
    let mut other = None;
    let mut asks = false;
    let Some(open) = &mut app.open else { return };
    let rests = open.adding.is_none() && !app.is_reading;
    // the result says so, too
    let is_told = open.result.as_ref().is_some_and(|result| result.change().is_some());
    if let Some(before) = app.settings.before.as_ref().filter(|_| !is_told) {
        let name = before::name_of(before);
        ui.add(egui::Label::new(format!("Before: {name}")).truncate()).on_hover_text(&before.file);
    }
    ui.horizontal(|ui| {
        let is_asked = |result: &&Arc<StudyResult>| result.is_asked(&open.project, &app.settings);
        let result =
            open.result.as_ref().filter(is_asked).filter(|result| matches!(result.found, Findings::Shadow(_))).cloned();
        if app.settings.before.is_some() {
            if ui.button("Stop comparing").clicked() {
                // a result in progress would bring it back
                (app.settings.before, open.adding) = (None, None);
                open.result = open.result.take().filter(|result| result.change().is_none());
            }
        } else if let Some(result) = result
            && ui.add_enabled(rests, egui::Button::new("Compare from here")).clicked()
        {
            let before = Arc::new(open.project.written.clone());
            app.settings.before = Some(Arc::clone(&before));
            open.before = Some(BeforeState { before, models: open.project.models.clone(), result: Some(result) });
        }
        ui.add_enabled_ui(rests, |ui| {
            ui.menu_button("Compare with", |ui| {
                asks = ui.button("Another file…").clicked();
                for path in &app.kept.recent {
                    let is_open = open.project.path.as_ref() == Some(path);
                    if !is_open && ui.button(name_of(path)).on_hover_text(path.display().to_string()).clicked() {
                        other = Some(path.clone());
                    }
                }
            });
        });
    });
    if asks {
        app.ask(Purpose::Compare, context);
    }
    if let Some(path) = other {
        app.compare_with(&path, context);
    }
}

impl App {
    /// The same window, which keeps stopped studies in a folder: they continue when the same study is requested again.
    pub fn keeping_studies_in(mut self, folder: &Path) -> App {
        self.studies = Some(folder.to_owned());
        self
    }

    /// Finds the change from the site in a file to the open one.
    pub(in crate::desktop) fn compare_with(&mut self, path: &Path, context: &egui::Context) {
        (self.fault, self.notice) = (None, None);
        let Some(open) = &mut self.open else { return };
        match before::read(path, &open.project) {
            Ok(before) => {
                open.answers += 1;
                let order = StudyOrder {
                    method: self.settings.shown.method,
                    number: open.answers,
                    studies: self.studies.clone(),
                    context: context.clone(),
                };
                open.adding = Some(studies::change(&open.project, Arc::new(before), None, order));
            }
            Err(error) => self.fault = Some(error.to_string()),
        }
    }
}

/// The areas of sun lost and gained, as the command prints them.
pub(in crate::desktop) fn areas(app: &App, ui: &mut Ui) {
    let Some(change) = app.open.as_ref().and_then(|open| open.result.as_ref()).and_then(|result| result.change())
    else {
        return;
    };
    let [before, after] = change.names();
    ui.add(egui::Label::new(format!("Before: {before}")).wrap());
    ui.add(egui::Label::new(format!("After: {after}")).wrap());
    let rows: Vec<_> = change.rows().into_iter().map(|row| row.map(|text| text.replace('-', "−"))).collect();
    // numbers first; their descriptions wrap if there is little room
    const APART: f32 = 10.0;
    let widest = |column: usize| rows.iter().map(|row| theme::width_of(ui, &row[column])).fold(0.0, f32::max).ceil();
    let [second, third] = [1, 2].map(widest);
    let first = (ui.available_width() - second - third - 2.0 * APART).max(60.0);
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing = egui::vec2(APART, 2.0);
        for [what, left, right] in &rows {
            ui.horizontal(|ui| {
                ui.spacing_mut().interact_size.y = 17.0;
                let cell = |ui: &mut Ui, width: f32, layout: egui::Layout, text: egui::RichText| {
                    ui.allocate_ui_with_layout(egui::vec2(width, 17.0), layout, |ui| {
                        ui.set_min_width(width);
                        ui.add(egui::Label::new(text).wrap());
                    });
                };
                let (to_left, to_right) =
                    (egui::Layout::top_down(egui::Align::Min), egui::Layout::top_down(egui::Align::Max));
                cell(ui, first, to_left, egui::RichText::new(what).weak());
                for (text, width) in [(left, second), (right, third)] {
                    let text = egui::RichText::new(text);
                    cell(ui, width, to_right, if what.is_empty() { text.weak() } else { text });
                }
            });
        }
    });
    ui.weak(change.extent());
}
