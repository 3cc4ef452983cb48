//! Components: their colours, and what each of them does.

use super::loading::Project;
use super::settings::Settings;
use crate::export::figure::component_colours;
use crate::site::Site;
use crate::site::file::Names;
use eframe::egui::{self, Color32, Sense};

/// The colour of every face that is seen, as the picture takes them.
pub(super) fn face_colours(site: &Site) -> impl Iterator<Item = [u8; 3]> {
    let colours = component_colours(&site.mesh, &site.casts);
    let seen = site.mesh.components.iter().zip(colours).zip(&site.receives).filter(|(_, seen)| **seen);
    let faces: Vec<_> = seen.map(|((component, colour), _)| (component.faces.len(), colour)).collect();
    faces.into_iter().flat_map(|(count, colour)| std::iter::repeat_n(colour, count))
}

/// The list: name, colour, and two switches.
pub(super) fn list(ui: &mut egui::Ui, project: &Project, settings: &mut Settings) {
    let site = &project.site;
    ui.horizontal(|ui| {
        ui.weak(format!("{} components", site.mesh.components.len()));
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.weak("seen");
            ui.weak("casts");
        });
    });
    let mut changes = Vec::new();
    let height = ui.spacing().interact_size.y;
    let area = egui::ScrollArea::vertical().max_height(220.0).auto_shrink([false, true]).id_salt("components");
    area.show_rows(ui, height, site.mesh.components.len(), |ui, rows| {
        for index in rows {
            let name = &site.mesh.components[index].name;
            ui.horizontal(|ui| {
                let [r, g, b] = project.colours[index];
                let (rect, _) = ui.allocate_exact_size(egui::vec2(12.0, 12.0), Sense::hover());
                ui.painter().rect_filled(rect, 3.0, Color32::from_rgb(r, g, b));
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                    let switches = [("seen", site.receives[index]), ("casts", site.casts[index])];
                    for (what, is_on) in switches {
                        let mut on = is_on;
                        let response = ui.add(egui::Checkbox::without_text(&mut on));
                        let label = format!("{name} {what}");
                        response
                            .widget_info(|| egui::WidgetInfo::selected(egui::Role::CheckBox, true, on, label.clone()));
                        if on != is_on {
                            changes.push((index, what, on));
                        }
                    }
                    ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                        ui.add(egui::Label::new(name).truncate());
                    });
                });
            });
        }
    });
    for (index, what, on) in changes {
        switch(project, settings, index, what == "casts", on);
    }
}

/// Writes into the site that a component casts, or is seen, or not.
fn switch(project: &Project, settings: &mut Settings, index: usize, casts: bool, on: bool) {
    let site = &project.site;
    let mut first = 0;
    for (model, count) in project.models.component_counts().into_iter().enumerate() {
        if (first..first + count).contains(&index) {
            let Some(table) = settings.site.model.get_mut(model) else { return };
            let now = if casts { &site.casts } else { &site.receives };
            let is_on = |at: usize| if at == index { on } else { now[at] };
            let chosen: Vec<usize> = (first..first + count).filter(|at| is_on(*at)).collect();
            let names = match chosen.len() {
                0 => Names::All(false),
                all if all == count => Names::All(true),
                _ => Names::Some(chosen.iter().map(|at| site.mesh.components[*at].name.clone()).collect()),
            };
            *(if casts { &mut table.casts } else { &mut table.receives }) = names;
            return;
        }
        first += count;
    }
}
