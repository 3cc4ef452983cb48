//! Components: their colours, and what each of them does.

use super::loading::Project;
use super::settings::Settings;
use crate::export::figure::component_colours;
use crate::mesh::Component;
use crate::site::Site;
use crate::site::file::{ModelTable, Names};
use eframe::egui::{self, Color32, Sense};
use rustc_hash::FxHashSet;

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
    // what is switched already and not read yet counts, too
    let roles = (settings.site.model != project.written.site.model).then(|| {
        let of = |names: fn(&ModelTable) -> &Names| roles(project, settings, names);
        [of(|table| &table.casts), of(|table| &table.receives)]
    });
    let [casts, receives] = match &roles {
        Some([casts, receives]) => [casts, receives],
        None => [&site.casts, &site.receives],
    };
    let mut changes = Vec::new();
    let height = ui.spacing().interact_size.y;
    let area = egui::ScrollArea::vertical()
        .min_scrolled_height(160.0)
        .max_height(220.0)
        .auto_shrink([false, true])
        .id_salt("components");
    area.show_rows(ui, height, site.mesh.components.len(), |ui, rows| {
        for index in rows {
            let name = &site.mesh.components[index].name;
            ui.horizontal(|ui| {
                let [r, g, b] = project.colours[index];
                let (rect, _) = ui.allocate_exact_size(egui::vec2(12.0, 12.0), Sense::hover());
                ui.painter().rect_filled(rect, 3.0, Color32::from_rgb(r, g, b));
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                    let switches = [("seen", receives[index]), ("casts", casts[index])];
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
        let now = if what == "casts" { casts } else { receives };
        switch(project, settings, (index, what == "casts", on), now);
    }
}

/// Per component whether it has a role, as the settings say it.
fn roles(project: &Project, settings: &Settings, names: fn(&ModelTable) -> &Names) -> Vec<bool> {
    let mut components = project.site.mesh.components.iter();
    let counts = project.models.component_counts().into_iter().zip(&settings.site.model);
    let of_model = counts.flat_map(|(count, table)| {
        let names = match names(table) {
            Names::All(all) => Err(*all),
            Names::Some(names) => Ok(names.iter().map(String::as_str).collect::<FxHashSet<_>>()),
        };
        let means = move |of: &Component| match &names {
            Err(all) => *all,
            Ok(names) => of.aliases.iter().chain([&of.name]).any(|name| names.contains(name.as_str())),
        };
        components.by_ref().take(count).map(means).collect::<Vec<_>>()
    });
    of_model.collect()
}

/// Writes into the site that a component casts, or is seen, or not.
fn switch(project: &Project, settings: &mut Settings, (index, casts, on): (usize, bool, bool), now: &[bool]) {
    let site = &project.site;
    let mut first = 0;
    for (model, count) in project.models.component_counts().into_iter().enumerate() {
        if (first..first + count).contains(&index) {
            let Some(table) = settings.site.model.get_mut(model) else { return };
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
