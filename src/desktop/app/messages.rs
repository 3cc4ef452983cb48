//! The window's messages: work in progress, work that is done, and errors.

use crate::desktop::app::state::App;
use crate::desktop::work::export;
use crate::desktop::work::loading::LoadJob;
use eframe::egui::{self, Ui};

impl App {
    /// The work in progress, and what went wrong.
    pub(in crate::desktop) fn messages(&mut self, ui: &mut Ui) {
        self.loading_message(ui);
        if self.writing.as_ref().is_some_and(|writing| export::progress(writing, ui)) {
            self.writing = None;
        }
        self.changed_message(ui);
        self.fault_or_notice(ui);
    }

    /// How far loading is.
    fn loading_message(&mut self, ui: &mut Ui) {
        let Some(loading) = &self.loading else { return };
        // updates the elapsed time
        ui.ctx().request_repaint_after(std::time::Duration::from_millis(500));
        if !loading.is_shown() {
            return;
        }
        let (share, what) = loading.stage();
        let mut cancels = false;
        ui.horizontal(|ui| {
            ui.label(format!("Loading {}", loading.name));
            ui.add(egui::ProgressBar::new(share).desired_width(280.0).text(what));
            cancels = ui.button("Cancel").clicked();
        });
        if cancels {
            self.cancel_loading();
        }
    }

    /// Gives loading up: the open site stays as it is, without what was set since it was read.
    fn cancel_loading(&mut self) {
        let Some(loading) = self.loading.take() else { return };
        loading.cancel();
        self.is_reading = false;
        match &self.open {
            Some(open) if !loading.opens && !loading.reads => {
                self.settings.site = open.project.written.site.clone();
                self.settings.hidden = open.project.hidden.clone();
            }
            // what is on the disk is refused until the settings change
            _ => self.refused = (!loading.opens).then(|| self.settings.clone()),
        }
    }

    /// Says that a file of the open site has changed since it was read.
    fn changed_message(&mut self, ui: &mut Ui) {
        if let Some(name) = &self.changed {
            let mut reloads = false;
            let mut leaves = false;
            ui.horizontal(|ui| {
                ui.label(format!("{name} has changed on the disk."));
                reloads = ui.button("Reload").clicked();
                leaves = ui.button("Leave it").clicked();
            });
            if reloads {
                self.reload(&ui.ctx().clone());
            }
            if leaves {
                self.changed = None;
            }
        }
    }

    fn fault_or_notice(&mut self, ui: &mut Ui) {
        let of_view = self.open.as_ref().and_then(|open| open.viewer.fault.clone());
        let (fault, notice) = (self.fault.clone().or(of_view), self.notice.clone());
        // a grave accent would be drawn above the letter after it
        if let Some(text) = fault.as_ref().or(notice.as_ref()).map(|text| text.replace('`', "")) {
            ui.horizontal(|ui| {
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                    if ui.button("Close").clicked() {
                        self.hush();
                    }
                    ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                        let colour =
                            if fault.is_some() { ui.visuals().error_fg_color } else { ui.visuals().text_color() };
                        ui.add(egui::Label::new(egui::RichText::new(text).color(colour)).wrap());
                    });
                });
            });
        }
    }

    /// Clears the message, as its button does.
    pub fn hush(&mut self) {
        (self.fault, self.notice) = (None, None);
        if let Some(open) = &mut self.open {
            open.viewer.fault = None;
        }
    }

    pub(in crate::desktop) fn has_message(&self) -> bool {
        self.fault.is_some()
            || self.notice.is_some()
            || self.writing.is_some()
            || self.changed.is_some()
            || self.loading.as_ref().is_some_and(LoadJob::is_shown)
            || self.open.as_ref().is_some_and(|open| open.viewer.fault.is_some())
    }
}
