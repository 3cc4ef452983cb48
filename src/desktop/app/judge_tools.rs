//! The tools that draw what is judged: corners of an area or of the plot on the plan, and clicks on panes.

use crate::desktop::app::state::App;
use crate::desktop::parts::sky;
use crate::desktop::parts::theme;
use crate::desktop::state::component_state::{chosen, naming};
use crate::desktop::state::eye::Stand;
use crate::desktop::state::judging::JudgeTool;
use crate::desktop::state::pick::PickedPoint;
use crate::desktop::state::unit::Unit;
use crate::mesh::Component;
use crate::message::few;
use crate::site::border_fault;
use crate::site::judged_tables::{AreaTable, PlotTable, WindowTable};
use crate::view::View;
use eframe::egui::{self, Align2, Color32, Key, Modifiers, Pos2, Rect, Shape, Stroke, Ui};
use glam::DVec2;

/// A click this near to the first corner closes the outline, points.
const NEAR: f32 = 9.0;

/// A click on the picture, as a tool takes it.
pub(in crate::desktop) struct ToolClick {
    pub(in crate::desktop) under: PickedPoint,
    pub(in crate::desktop) at: Pos2,
    pub(in crate::desktop) is_double: bool,
    pub(in crate::desktop) modifiers: Modifiers,
}

impl App {
    /// Lets the tool in use take a click. Returns whether there is one.
    pub(in crate::desktop) fn tool_click(&mut self, click: &ToolClick, view: &View, rect: Rect) -> bool {
        let Some(open) = &mut self.open else { return false };
        match &mut open.judge.tool {
            None => return false,
            Some(JudgeTool::Windows) => self.pick_windows(click),
            Some(tool) if open.viewer.eye.stand == Stand::Plan => {
                let Some(corners) = tool.corners_mut() else { return true };
                let first = corners.first().and_then(|first| sky::on_picture(view, rect, first.extend(0.0)));
                let closes = corners.len() > 2 && first.is_some_and(|first| first.distance(click.at) < NEAR);
                // to the millimetre, as everything that the window writes
                let corner = (click.under.point.truncate() * 1000.0).round() / 1000.0 + 0.0;
                if !closes && corners.last() != Some(&corner) && !click.is_double {
                    corners.push(corner);
                }
                if closes || click.is_double {
                    self.close_outline();
                }
            }
            Some(_) => self.notice = Some("It is drawn on the plan: press 2".to_owned()),
        }
        true
    }

    /// The keys of the tool in use. They come before all others.
    pub(in crate::desktop) fn tool_keys(&mut self, context: &egui::Context) {
        let is_free = context.memory(|memory| memory.focused().is_none());
        let Some(open) = self.open.as_mut().filter(|_| is_free) else { return };
        let Some(tool) = &mut open.judge.tool else { return };
        let pressed = |modifiers, key| context.input_mut(|input| input.consume_key(modifiers, key));
        if pressed(Modifiers::NONE, Key::Escape) {
            open.judge.tool = None;
            return;
        }
        let Some(corners) = tool.corners_mut() else { return };
        // undo takes corners back before it takes back what is written
        let undoes = !corners.is_empty() && pressed(Modifiers::COMMAND, Key::Z);
        if undoes || pressed(Modifiers::NONE, Key::Backspace) {
            corners.pop();
        }
        if pressed(Modifiers::NONE, Key::Enter) {
            self.close_outline();
        }
    }

    /// Writes the outline into the site, if it bounds an area.
    fn close_outline(&mut self) {
        let Some(open) = &mut self.open else { return };
        let Some(corners) = open.judge.tool.as_ref().and_then(JudgeTool::corners) else { return };
        if let Some(fault) = border_fault(corners) {
            self.fault = Some(format!("The outline {fault}"));
            return;
        }
        let written: Vec<[f64; 2]> = corners.iter().map(|corner| corner.to_array()).collect();
        let site = &mut self.settings.site;
        match open.judge.tool.take() {
            Some(JudgeTool::Area(_)) => {
                let name = Some(free_name(&site.area));
                site.area.push(AreaTable { name, polygon: Some(written), ..AreaTable::default() });
            }
            Some(JudgeTool::Plot(_)) => {
                let plot = site.plot.take().unwrap_or_default();
                if plot.roads.is_some() || plot.neighbours.is_some() {
                    // its sides are others now
                    self.notice =
                        Some("The roads and neighbours of the old border are left out: say them again".into());
                }
                site.plot =
                    Some(PlotTable { border: Some(written), mean_ground: plot.mean_ground, ..PlotTable::default() });
            }
            Some(JudgeTool::Windows) | None => {}
        }
        self.fault = None;
    }

    /// Adds the clicked component's panes to the windows, or takes them away.
    fn pick_windows(&mut self, click: &ToolClick) {
        let Some(open) = &self.open else { return };
        let components = &open.project.site.mesh.components;
        if click.under.face.is_none() {
            self.notice = Some("That is the ground: click a pane".to_owned());
            return;
        }
        let Some(clicked) = components.iter().find(|component| component.name == click.under.name) else { return };
        let wanted =
            if click.modifiers.command { alike(clicked, components) } else { of_name(&clicked.name, components) };
        let windows = &mut self.settings.site.window;
        let were = taken_away(windows, &wanted, components);
        let tried = std::iter::once(&clicked.name).chain(&clicked.aliases).map(|name| vec![name.clone()]);
        let names = naming(&wanted, components, tried);
        let Some(names) = names else { return };
        // what is all there already goes
        if wanted.iter().zip(were).all(|(wanted, was)| !wanted || was) {
            self.notice = Some(format!("No windows any more: {}", few(names.0)));
            return;
        }
        self.notice = Some(format!("Windows: {}", few(names.0.clone())));
        windows.push(WindowTable { component: Some(names), ..WindowTable::default() });
    }
}

/// A name that no area has yet.
fn free_name(areas: &[AreaTable]) -> String {
    let name = |number: usize| format!("area {number}");
    let is_free = |name: &String| !areas.iter().any(|area| area.name.as_ref() == Some(name));
    (areas.len() + 1..).map(name).find(is_free).unwrap_or_default()
}

fn of_name(name: &str, components: &[Component]) -> Vec<bool> {
    components.iter().map(|component| component.name == name).collect()
}

/// The components of the same kind: those whose name ends after its last slash as this one's does, apart from numbers. That
/// end is the material in glTF and IFC.
fn alike(clicked: &Component, components: &[Component]) -> Vec<bool> {
    let kind = |name: &str| {
        let end = name.rsplit('/').next().unwrap_or(name);
        end.trim_end_matches(|letter: char| !letter.is_alphabetic()).to_owned()
    };
    let of_clicked = kind(&clicked.name);
    components.iter().map(|component| kind(&component.name) == of_clicked).collect()
}

/// Takes components out of the windows. Returns of each component whether it was there.
fn taken_away(windows: &mut Vec<WindowTable>, unwanted: &[bool], components: &[Component]) -> Vec<bool> {
    let mut were = vec![false; components.len()];
    windows.retain_mut(|window| {
        let Some(names) = &window.component else { return true };
        let mut left = chosen(Some(names), components);
        let mut is_less = false;
        for ((left, unwanted), was) in left.iter_mut().zip(unwanted).zip(&mut were) {
            is_less |= *left && *unwanted;
            *was |= *left;
            *left &= !unwanted;
        }
        if is_less {
            window.component = naming(&left, components, []);
        }
        window.component.is_some()
    });
    were
}

/// Draws the outline that is not closed yet, with the length of its next side.
pub(in crate::desktop) fn draft(
    ui: &Ui,
    tool: Option<&JudgeTool>,
    view: &View,
    rect: Rect,
    (level, unit): (f64, Unit),
) {
    let Some(corners) = tool.and_then(JudgeTool::corners).filter(|_| matches!(view, View::Plan(_))) else { return };
    let place = |corner: &DVec2| sky::on_picture(view, rect, corner.extend(level));
    let mut points: Vec<Pos2> = corners.iter().filter_map(place).collect();
    let painter = ui.painter_at(rect);
    let corner_points = points.clone();
    let pointer = ui.input(|input| input.pointer.hover_pos()).filter(|at| rect.contains(*at));
    if let (Some(pointer), Some(last), View::Plan(grid)) = (pointer, corners.last(), view) {
        points.push(pointer);
        let share = (pointer - rect.min) / rect.size();
        let [width, height] = [grid.east() - grid.west, grid.north - grid.south()];
        let at = DVec2::new(grid.west + f64::from(share.x) * width, grid.north - f64::from(share.y) * height);
        let text = format!("{:.2} {}", at.distance(*last) / unit.metres, unit.name);
        sky::label(&painter, pointer + egui::vec2(12.0, -12.0), Align2::LEFT_BOTTOM, &text);
    }
    painter.add(Shape::line(points.clone(), Stroke::new(4.0, Color32::WHITE)));
    painter.add(Shape::line(points, Stroke::new(2.0, theme::ACCENT)));
    for at in corner_points {
        painter.circle(at, 4.0, Color32::WHITE, Stroke::new(2.0, theme::ACCENT));
    }
}
