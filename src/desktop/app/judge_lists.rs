//! What is judged of the open site: lists of its areas, windows and plot, and the tools that draw them.

use crate::desktop::app::state::App;
use crate::desktop::parts::fields::{TypedText, refused};
use crate::desktop::state::eye::Stand;
use crate::desktop::state::judging::JudgeTool;
use crate::message::few;
use crate::site::file::SiteFile;
use crate::site::judged_tables::{AreaTable, PlotTable, WindowTable, WrittenNames};
use eframe::egui::{self, Ui};

/// The tools, and the lists of what they made.
pub(in crate::desktop) fn show(app: &mut App, ui: &mut Ui) {
    tools(app, ui);
    let fault =
        app.open.as_ref().filter(|open| open.judge.tool.is_some()).and_then(|open| open.judge.sketch.fault.clone());
    if let Some(fault) = fault {
        refused(ui, &fault);
    }
    let site = &mut app.settings.site;
    ui.weak(summary(site));
    if site.area.is_empty() && site.window.is_empty() && site.plot.is_none() {
        return;
    }
    let lists = egui::ScrollArea::vertical().id_salt("judged").max_height(170.0).auto_shrink([false, true]);
    lists.show(ui, |ui| {
        areas(ui, &mut app.typed, &mut site.area);
        windows(ui, &mut app.typed, &mut site.window);
        plot(ui, &mut site.plot);
    });
}

/// What is judged, in numbers.
fn summary(site: &SiteFile) -> String {
    let counted = |count: usize, one: &str, more: &str| match count {
        0 => None,
        1 => Some(format!("1 {one}")),
        count => Some(format!("{count} {more}")),
    };
    let before = site.before.as_ref().map(|before| match &before.site {
        Some(name) => format!("compared with {name}"),
        None => "compared with the state before".to_owned(),
    });
    let parts = [
        counted(site.area.len(), "entry of areas", "entries of areas"),
        counted(site.window.len(), "entry of windows", "entries of windows"),
        counted(site.facade.len(), "entry of façades", "entries of façades"),
        site.plot.as_ref().map(|_| "the plot".to_owned()),
        before,
    ];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    if parts.is_empty() { "Nothing to judge is drawn yet.".to_owned() } else { format!("Judged: {}", parts.join(", ")) }
}

/// The tools. One that is in use says what its clicks do.
fn tools(app: &mut App, ui: &mut Ui) {
    let Some(open) = &mut app.open else { return };
    let tool = &mut open.judge.tool;
    let mut taken = None;
    ui.horizontal_wrapped(|ui| {
        for (name, is_it, new) in [
            ("Draw an area", matches!(tool, Some(JudgeTool::Area(_))), JudgeTool::Area(Vec::new())),
            ("Pick windows", matches!(tool, Some(JudgeTool::Windows)), JudgeTool::Windows),
            ("Draw the plot", matches!(tool, Some(JudgeTool::Plot(_))), JudgeTool::Plot(Vec::new())),
        ] {
            if ui.add(egui::Button::selectable(is_it, name)).clicked() {
                taken = Some(Some(new).filter(|_| !is_it));
            }
        }
    });
    if let Some(taken) = taken {
        *tool = taken;
        if tool.as_ref().is_some_and(|tool| tool.corners().is_some()) {
            open.viewer.eye.stand = Stand::Plan;
        }
    }
    let said = match tool {
        None => return,
        Some(JudgeTool::Windows) => {
            "Click a pane: all of its component are windows, and a second click takes them away. With Ctrl: all \
             components with the same kind of name. Escape ends."
        }
        Some(_) if open.viewer.eye.stand != Stand::Plan => "It is drawn on the plan: press 2.",
        Some(_) => {
            "Click its corners. A double click, Enter, or a click on the first corner closes it; Backspace takes the \
             last corner back; Escape leaves."
        }
    };
    ui.add(egui::Label::new(egui::RichText::new(said).weak()).wrap());
}

fn areas(ui: &mut Ui, typed: &mut TypedText, areas: &mut Vec<AreaTable>) {
    let mut removed = None;
    for (index, area) in areas.iter_mut().enumerate() {
        entry(ui, &format!("Remove area {}", index + 1), &mut removed, index, |ui, width| {
            let said = area_said(area);
            let field = TextField { label: "area", name: &format!("Name of area {}", index + 1), hover: &said };
            text(ui, typed, &field, &mut area.name, width - 34.0);
        });
        properties(
            ui,
            typed,
            &format!("area {}", index + 1),
            [("Dwelling", "whose open space it is", &mut area.dwelling)],
        );
    }
    if let Some(removed) = removed {
        areas.remove(removed);
    }
}

/// Where an area comes from.
fn area_said(area: &AreaTable) -> String {
    match (&area.polygon, &area.file, &area.component) {
        (Some(corners), ..) => format!("{} corners", corners.len()),
        (_, Some(file), _) => format!("of {file}"),
        (_, _, Some(names)) => format!("the upper faces of {}", few(names.0.clone())),
        _ => "without corners".to_owned(),
    }
}

fn windows(ui: &mut Ui, typed: &mut TypedText, windows: &mut Vec<WindowTable>) {
    let mut removed = None;
    for (index, window) in windows.iter_mut().enumerate() {
        entry(ui, &format!("Remove windows {}", index + 1), &mut removed, index, |ui, _| {
            let of = match (&window.component, &window.name) {
                (Some(WrittenNames(names)), _) => format!("windows of {}", few(names.clone())),
                (None, Some(name)) => format!("window {name}"),
                (None, None) => format!("window {}", index + 1),
            };
            ui.add(egui::Label::new(&of).truncate()).on_hover_text(of);
        });
        let fields = [
            ("Room", "to which they belong", &mut window.room),
            ("Dwelling", "to which the room belongs", &mut window.dwelling),
            ("Use", "of the room, in the rule's own word", &mut window.usage),
        ];
        properties(ui, typed, &format!("windows {}", index + 1), fields);
    }
    if let Some(removed) = removed {
        windows.remove(removed);
    }
}

fn plot(ui: &mut Ui, plot: &mut Option<PlotTable>) {
    let Some(table) = plot else { return };
    let said = match (&table.border, &table.file) {
        (Some(corners), _) => format!("the plot, {} corners", corners.len()),
        (None, file) => format!("the plot of {}", file.as_deref().unwrap_or_default()),
    };
    let mut removed = None;
    entry(ui, "Remove the plot", &mut removed, 0, |ui, _| {
        ui.add(egui::Label::new(said).truncate());
    });
    if removed.is_some() {
        *plot = None;
    }
}

/// What rules about rooms and dwellings ask for, below a line of a list.
fn properties<const N: usize>(
    ui: &mut Ui,
    typed: &mut TypedText,
    of: &str,
    fields: [(&str, &str, &mut Option<String>); N],
) {
    ui.horizontal_wrapped(|ui| {
        ui.add_space(12.0);
        for (label, hover, value) in fields {
            let field = TextField { label: &label.to_lowercase(), name: &format!("{label} of {of}"), hover };
            text(ui, typed, &field, value, 62.0);
        }
    });
}

/// A field for a text that may be absent.
struct TextField<'a> {
    label: &'a str,
    /// For assistive technology; no other field has it.
    name: &'a str,
    hover: &'a str,
}

fn text(ui: &mut Ui, typed: &mut TypedText, field: &TextField<'_>, value: &mut Option<String>, width: f32) {
    let label = ui.weak(field.label).on_hover_text(field.hover);
    label.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, field.name));
    let said = value.clone().unwrap_or_default();
    let read = |text: &str| Ok(text.trim().to_owned());
    if let Some(text) = typed.text(ui, (field.name, label.id), &said, width, read) {
        *value = Some(text).filter(|text| !text.is_empty());
    }
}

/// A line of a list, with a button at its end that removes it.
fn entry(ui: &mut Ui, remove: &str, removed: &mut Option<usize>, index: usize, content: impl FnOnce(&mut Ui, f32)) {
    let size = egui::vec2(ui.available_width(), ui.spacing().interact_size.y);
    ui.allocate_ui_with_layout(size, egui::Layout::right_to_left(egui::Align::Center), |ui| {
        let response = ui.small_button("×").on_hover_text(remove);
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, remove));
        if response.clicked() {
            *removed = Some(index);
        }
        ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
            let width = ui.available_width();
            content(ui, width);
        });
    });
}
