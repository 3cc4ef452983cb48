//! The list of components: their colours and roles.

use crate::desktop::parts::theme;
use crate::desktop::state::project::Project;
use crate::desktop::state::settings::{Hidden, WindowSettings};
use crate::export::figure::without_middle;
use crate::site::file::Names;
use eframe::egui::{self, Color32, Sense};
use std::sync::Arc;

/// The tooltips of a component's switches, in the order of their columns.
const SWITCHES: [(&str, &str); 3] = [
    ("casts", "Takes the sun away from others"),
    ("receives", "Is judged, and drawn; what does not receive is looked through"),
    ("visible", "Is in this window's picture: what is hidden there counts all the same"),
];
/// The width of a column of switches, points.
const COLUMN: f32 = 52.0;

/// The list: colour, name, and three switches.
pub(in crate::desktop) fn list(ui: &mut egui::Ui, project: &Project, settings: &mut WindowSettings) {
    let site = &project.site;
    heading(ui, site.mesh.components.len());
    // includes switches whose settings are not read yet
    let roles = (settings.site.model != project.written.site.model)
        .then(|| [roles(project, settings, true), roles(project, settings, false)]);
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
            let states = [casts[index], receives[index], receives[index] && !settings.hidden.contains(name)];
            let switched = component(ui, (name, project.colours[index]), states, receives[index]);
            changes.extend(switched.map(|(what, on)| (index, what, on)));
        }
    });
    for (index, what, on) in changes {
        match what {
            "casts" => switch(project, settings, (index, true, on), casts),
            "receives" => switch(project, settings, (index, false, on), receives),
            _ => hide(settings, &site.mesh.components[index].name, !on),
        }
    }
    hidden_count(ui, project, settings);
}

/// The headings of the columns, and the number of components.
fn heading(ui: &mut egui::Ui, count: usize) {
    row(ui, |ui, column| match column {
        Some(column) => {
            let (what, means) = SWITCHES[column];
            ui.weak(what).on_hover_text(means);
        }
        None => {
            ui.weak(format!("{count} component{}", if count == 1 { "" } else { "s" }));
        }
    });
}

/// A component's row. Returns the switch that was used, and its new value.
fn component(
    ui: &mut egui::Ui,
    (name, [r, g, b]): (&str, [u8; 3]),
    states: [bool; 3],
    receives: bool,
) -> Option<(&'static str, bool)> {
    let mut switched = None;
    row(ui, |ui, column| {
        let Some(column) = column else {
            let (rect, _) = ui.allocate_exact_size(egui::vec2(12.0, 12.0), Sense::hover());
            ui.painter().rect_filled(rect, 3.0, Color32::from_rgb(r, g, b));
            // similar names usually differ at the end
            let fits = |text: &str| theme::width_of(ui, text) <= ui.available_width();
            let cut = without_middle(name, fits);
            ui.label(cut).on_hover_text(name);
            return;
        };
        let (mut on, what) = (states[column], SWITCHES[column].0);
        let can = what != "visible" || receives;
        let response = ui.add_enabled(can, egui::Checkbox::without_text(&mut on));
        let label = format!("{name} {what}");
        response.widget_info(|| egui::WidgetInfo::selected(egui::Role::CheckBox, can, on, label.clone()));
        response.on_disabled_hover_text("It does not receive, and is looked through");
        if on != states[column] {
            switched = Some((what, on));
        }
    });
    switched
}

/// The number of hidden components, and a button that shows them again.
fn hidden_count(ui: &mut egui::Ui, project: &Project, settings: &mut WindowSettings) {
    // names without remaining components hide nothing
    let roles = project.site.receives.iter().zip(&project.visible.receives);
    let hidden = roles.filter(|(receives, visible)| receives != visible).count();
    if hidden > 0 {
        ui.horizontal_wrapped(|ui| {
            ui.weak(format!("{hidden} hidden here, and counted all the same"));
            if ui.button("Show all").clicked() {
                settings.hidden = Hidden::default();
            }
        });
    }
}

/// A row: its content at the left, and the columns of switches at the right.
fn row(ui: &mut egui::Ui, mut content: impl FnMut(&mut egui::Ui, Option<usize>)) {
    let size = egui::vec2(ui.available_width(), ui.spacing().interact_size.y);
    ui.allocate_ui_with_layout(size, egui::Layout::right_to_left(egui::Align::Center), |ui| {
        ui.spacing_mut().item_spacing.x = 0.0;
        for column in (0..SWITCHES.len()).rev() {
            let size = egui::vec2(COLUMN, size.y);
            let centred = egui::Layout::centered_and_justified(egui::Direction::LeftToRight);
            ui.allocate_ui_with_layout(size, centred, |ui| content(ui, Some(column)));
        }
        ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
            ui.spacing_mut().item_spacing.x = 8.0;
            content(ui, None);
        });
    });
}

/// Hides a component, or shows it again.
pub(in crate::desktop) fn hide(settings: &mut WindowSettings, name: &str, hides: bool) {
    let hidden = Arc::make_mut(&mut settings.hidden);
    if hides {
        hidden.insert(name.to_owned());
    } else {
        hidden.remove(name);
    }
}

/// For each component, whether it casts, or whether it receives, by the settings.
fn roles(project: &Project, settings: &WindowSettings, casts: bool) -> Vec<bool> {
    let mut components = project.site.mesh.components.as_slice();
    let counts = project.models.component_counts().into_iter().zip(&settings.site.model).enumerate();
    let of_model = counts.flat_map(|(model, (count, table))| {
        let (of_it, others) = components.split_at(count);
        components = others;
        if casts { project.models.casts_of(model, &table.casts) } else { table.receives.chosen(of_it) }
    });
    of_model.collect()
}

/// Sets in the site whether a component casts, or whether it receives.
fn switch(project: &Project, settings: &mut WindowSettings, (index, casts, on): (usize, bool, bool), now: &[bool]) {
    let site = &project.site;
    let mut first = 0;
    for (model, count) in project.models.component_counts().into_iter().enumerate() {
        if (first..first + count).contains(&index) {
            let Some(table) = settings.site.model.get_mut(model) else { return };
            let is_on = |at: usize| if at == index { on } else { now[at] };
            let chosen: Vec<usize> = (first..first + count).filter(|at| is_on(*at)).collect();
            // the default: ground cover does not cast
            let usual = match casts {
                true => project.models.casts_of(model, &Names::All(true)),
                false => vec![true; count],
            };
            let names = match chosen.len() {
                0 => Names::All(false),
                _ if (first..first + count).map(is_on).eq(usual) => Names::All(true),
                _ => Names::Some(chosen.iter().map(|at| site.mesh.components[*at].name.clone()).collect()),
            };
            *(if casts { &mut table.casts } else { &mut table.receives }) = names;
            return;
        }
        first += count;
    }
}
