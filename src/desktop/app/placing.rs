//! Asks for the place of a model without a site file.

use crate::desktop::app::state::App;
use crate::desktop::parts::fields::refused;
use crate::desktop::parts::theme;
use crate::desktop::state::project::name_of;
use crate::desktop::work::loading::LoadRequest;
use crate::message::few;
use eframe::egui::{self, Key, Response, TextEdit, Ui};

/// A field, and below it why the typed text is refused, until something else is typed.
fn field(ui: &mut Ui, name: &str, hint: &str, text: &mut String, fault: &mut Option<String>) -> Response {
    let label = ui.label(name);
    let response = ui.vertical(|ui| {
        ui.set_width(260.0);
        let response = ui.add(TextEdit::singleline(text).hint_text(hint).desired_width(260.0)).labelled_by(label.id);
        if response.changed() {
            *fault = None;
        }
        if let Some(fault) = fault {
            refused(ui, fault);
        }
        response
    });
    ui.end_row();
    response.inner
}

impl App {
    /// Asks where the model stands.
    pub(in crate::desktop) fn ask_place(&mut self, context: &egui::Context) {
        // one question at a time
        let is_questioned = self.is_questioned();
        let Some(bare) = self.bare.as_mut().filter(|_| !is_questioned) else { return };
        let mut goes = false;
        let mut closes = false;
        let modal = theme::modal(context, "place").show(context, |ui| {
            ui.set_width(420.0);
            ui.heading("Where does it stand?");
            let names: Vec<String> = [&bare.path].into_iter().chain(&bare.beside).map(|file| name_of(file)).collect();
            let said = if names.len() == 1 { "is a model, and says" } else { "are models, and say" };
            ui.label(format!("{} {said} not where.", few(names)));
            ui.add_space(6.0);
            egui::Grid::new("bare").num_columns(2).spacing([12.0, 8.0]).show(ui, |ui| {
                let [of_place, of_north] = &mut bare.faults;
                let response = field(ui, "Latitude, longitude", "48.2082, 16.3738", &mut bare.place, of_place);
                // the first field, and the only required one
                if ui.memory(|memory| memory.focused().is_none()) && bare.place.is_empty() {
                    response.request_focus();
                }
                goes |= response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
                let response = field(ui, "Model north", "0", &mut bare.north, of_north);
                response.on_hover_text("Degrees clockwise from the model's north (−Z) to true north");
            });
            ui.weak("Degrees, north and east positive.");
            ui.add_space(8.0);
            ui.horizontal(|ui| {
                let is_said = !bare.place.trim().is_empty();
                goes |= ui.add_enabled(is_said, egui::Button::new("Open it there")).clicked();
                closes = ui.button("Cancel").clicked();
            });
        });
        if closes || modal.should_close() {
            self.bare = None;
        } else if goes && bare.is_read() {
            let bare = bare.clone();
            self.load(LoadRequest::Placed(bare), context);
        }
    }
}
