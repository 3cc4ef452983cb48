//! The list of components: their colours and roles.

use crate::desktop::parts::theme;
use crate::desktop::state::component_state::{self, ComponentState};
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
    let states = component_state::states(&settings.site, &site.mesh.components);
    let stands = |index: usize| states[index] != ComponentState::Demolished;
    // includes switches whose settings are not read yet
    let (now, read) = (&settings.site, &project.written.site);
    let roles = (now.model != read.model || now.before != read.before).then(|| {
        let mut roles = [roles(project, settings, true), roles(project, settings, false)];
        roles.iter_mut().flat_map(|role| role.iter_mut().enumerate()).for_each(|(index, role)| *role &= stands(index));
        roles
    });
    let [casts, receives] = match &roles {
        Some([casts, receives]) => [casts, receives],
        None => [&site.casts, &site.receives],
    };
    let is_other_file = settings.site.before.as_ref().is_some_and(|before| before.site.is_some());
    let (mut changes, mut state) = (Vec::new(), None);
    let height = ui.spacing().interact_size.y;
    let area = egui::ScrollArea::vertical()
        .min_scrolled_height(160.0)
        .max_height(220.0)
        .auto_shrink([false, true])
        .id_salt("components");
    area.show_rows(ui, height, site.mesh.components.len(), |ui, rows| {
        for index in rows {
            let name = &site.mesh.components[index].name;
            let switches = [casts[index], receives[index], receives[index] && !settings.hidden.contains(name)];
            let listed = ListedComponent { name, colour: project.colours[index], state: states[index], is_other_file };
            match component(ui, &listed, switches) {
                Some(ComponentChange::Switch(what, on)) => changes.push((index, what, on)),
                Some(ComponentChange::State(chosen)) => state = Some((index, chosen)),
                None => {}
            }
        }
    });
    if let Some(change) = state {
        component_state::set(&mut settings.site, &site.mesh.components, change);
    }
    for (index, what, on) in changes {
        match what {
            "casts" => switch(project, settings, (index, true, on)),
            "receives" => switch(project, settings, (index, false, on)),
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

/// A component, as its row shows it.
struct ListedComponent<'a> {
    name: &'a str,
    colour: [u8; 3],
    state: ComponentState,
    /// Whether the state before is another file, which says what stands there.
    is_other_file: bool,
}

/// What was changed in a row.
enum ComponentChange {
    /// A switch, by its column's name.
    Switch(&'static str, bool),
    /// In which states it stands.
    State(ComponentState),
}

/// A component's row. Returns what was changed.
fn component(ui: &mut egui::Ui, of: &ListedComponent<'_>, switches: [bool; 3]) -> Option<ComponentChange> {
    let mut changed = None;
    let is_gone = of.state == ComponentState::Demolished;
    row(ui, |ui, column| {
        let Some(column) = column else {
            let chosen = named(ui, of);
            changed = chosen.map(ComponentChange::State).or(changed.take());
            return;
        };
        let (mut on, what) = (switches[column], SWITCHES[column].0);
        let can = !is_gone && (what != "visible" || switches[1]);
        let response = ui.add_enabled(can, egui::Checkbox::without_text(&mut on));
        let label = format!("{} {what}", of.name);
        response.widget_info(|| egui::WidgetInfo::selected(egui::Role::CheckBox, can, on, label.clone()));
        response.on_disabled_hover_text(if is_gone {
            "It is demolished: it stands in the state before alone"
        } else {
            "It does not receive, and is looked through"
        });
        if on != switches[column] {
            changed = Some(ComponentChange::Switch(what, on));
        }
    });
    changed
}

/// The colour and the name, which opens a list of states. Returns the one that was chosen.
fn named(ui: &mut egui::Ui, of: &ListedComponent<'_>) -> Option<ComponentState> {
    let (rect, _) = ui.allocate_exact_size(egui::vec2(12.0, 12.0), Sense::hover());
    let [r, g, b] = of.colour;
    let colour = Color32::from_rgb(r, g, b);
    match of.state {
        ComponentState::Demolished => {
            ui.painter().rect_stroke(rect, 3.0, egui::Stroke::new(1.5, colour), egui::StrokeKind::Inside);
        }
        ComponentState::Existing | ComponentState::Proposed => {
            ui.painter().rect_filled(rect, 3.0, colour);
        }
    }
    // similar names usually differ at the end
    let whole = format!("{}{}", of.name, of.state.mark());
    let fits = |text: &str| theme::width_of(ui, text) <= ui.available_width();
    let cut = without_middle(&whole, fits);
    let response = ui.add(egui::Label::new(&cut).sense(Sense::click()));
    response.widget_info(|| egui::WidgetInfo {
        current_text_value: Some(cut.clone()),
        ..egui::WidgetInfo::labeled(egui::Role::Button, true, &whole)
    });
    let hover =
        if of.is_other_file { "the state before is another file" } else { "click: existing, proposed or demolished" };
    let response = response.on_hover_text(format!("{whole}\n{hover}"));
    let mut chosen = None;
    egui::Popup::menu(&response).show(|ui| {
        for (state, name, means) in ComponentState::ALL {
            let entry = egui::Button::selectable(state == of.state, name);
            let entry = ui.add_enabled(!of.is_other_file, entry).on_hover_text(means);
            if entry.on_disabled_hover_text("The state before is another file, which says what stands there").clicked()
            {
                chosen = Some(state);
                // a choice by assistive technology is no click of a pointer, which would close it
                ui.close();
            }
        }
    });
    chosen
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
fn switch(project: &Project, settings: &mut WindowSettings, (index, casts, on): (usize, bool, bool)) {
    let site = &project.site;
    // what is demolished keeps its own
    let now = roles(project, settings, casts);
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
