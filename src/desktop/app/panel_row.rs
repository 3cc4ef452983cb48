//! Rows of the panel.

use eframe::egui::{self, Ui, vec2};

/// A label and the fields beside it, aligned with all others.
pub(in crate::desktop) fn row(ui: &mut Ui, name: &str, field: impl FnOnce(&mut Ui, egui::Id)) {
    ui.horizontal(|ui| {
        let size = vec2(78.0, ui.spacing().interact_size.y);
        let label = ui.allocate_ui_with_layout(size, egui::Layout::left_to_right(egui::Align::Center), |ui| {
            ui.set_min_size(size);
            ui.weak(name).id
        });
        field(ui, label.inner);
    });
}
