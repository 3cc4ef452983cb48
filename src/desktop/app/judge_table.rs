//! The table of verdicts beside the picture.

use crate::desktop::app::judge_view;
use crate::desktop::app::state::{App, Open};
use crate::desktop::parts::theme;
use crate::desktop::parts::verdict;
use crate::desktop::results::judged::{JudgedLine, JudgedResult, LineOf, SortBy};
use crate::desktop::state::judging::option_label;
use crate::export::judgement::CHECK;
use crate::rules::Verdict;
use eframe::egui::{self, Align2, FontSelection, Rect, RichText, Sense, Ui, pos2, vec2};
use std::sync::Arc;

/// The widths of the columns besides the name, points.
const SWATCH: f32 = 26.0;
const VALUE: f32 = 74.0;
const MARGIN: f32 = 78.0;
const DAY: f32 = 80.0;
/// Stands for the margin of a number that is accepted though it misses its limit.
const ACCEPTED: &str = "accepted";
/// From this width on there is a column for who takes the sun.
const WIDE: f32 = 540.0;

/// The table as a panel beside the picture, or below it in a narrow window.
pub(in crate::desktop) fn panel(app: &mut App, ui: &mut Ui, frame: egui::Frame) {
    let Some(judged) = app.open.as_ref().and_then(|open| open.judge.shown()).cloned() else { return };
    let room = ui.available_width();
    let is_beside = room >= 620.0;
    let panel = if is_beside {
        egui::Panel::right("verdicts").default_size(400.0).size_range(300.0..=(room - 300.0)).resizable(true)
    } else {
        egui::Panel::bottom("verdicts").default_size(180.0).size_range(100.0..=260.0).resizable(true)
    };
    panel.frame(frame).show(ui, |ui| {
        // keeps the width that the user set, whatever the contents
        let rect = ui.available_rect_before_wrap();
        let mut inner = ui.new_child(egui::UiBuilder::new().max_rect(rect));
        let ui_of_panel = &mut inner;
        heading(app, ui_of_panel, &judged);
        if let Some(open) = &mut app.open {
            open.judge.table.is_beside = is_beside;
            card(ui_of_panel, open);
        }
        rows(app, ui_of_panel, &judged);
        ui.advance_cursor_after_rect(rect);
    });
}

/// The card of the chosen line, below the table.
fn card(ui: &mut Ui, open: &mut Open) {
    if !open.judge.table.is_beside || open.judge.chosen().is_none() {
        return;
    }
    let most = (ui.available_height() - 80.0).max(120.0);
    let below = egui::Panel::bottom("verdict").default_size(most.min(290.0)).size_range(100.0..=most).resizable(true);
    below.frame(egui::Frame::NONE).show(ui, |ui| {
        let rect = ui.available_rect_before_wrap().shrink2(vec2(0.0, 5.0));
        let buttons = ui.spacing().interact_size.y + ui.spacing().item_spacing.y;
        judge_view::card(&mut ui.new_child(egui::UiBuilder::new().max_rect(rect)), open, buttons);
        ui.advance_cursor_after_rect(rect);
    });
}

/// The verdict over everything, the rule, and what can be done with the table.
fn heading(app: &mut App, ui: &mut Ui, judged: &JudgedResult) {
    let judgement = judged.judgement();
    let source = &judgement.source;
    ui.horizontal_wrapped(|ui| {
        verdict::swatch(ui, judgement.verdict);
        let grade = judgement.grade.as_ref().map_or_else(String::new, |grade| format!(", grade {grade}"));
        let said = format!("The site {}{grade}", verdict::word(judgement.verdict));
        ui.label(RichText::new(said).font(theme::bold(13.5)));
    });
    ui.label(format!("{}, {}", source.name, source.region)).on_hover_text(said_of(judged));
    ui.label(judged.totals());
    let chosen = judgement.rule.chosen.iter().map(|(name, value)| format!("{}: {}", option_label(name), value.text()));
    let chosen: Vec<String> = chosen.collect();
    if !chosen.is_empty() {
        ui.add(egui::Label::new(RichText::new(chosen.join(", ")).weak()).wrap());
    }
    ui.add(egui::Label::new(RichText::new(CHECK).weak().small()).wrap());
    let (mut exports, mut closes) = (false, false);
    let is_asked =
        app.open.as_ref().is_some_and(|open| judged.is_asked(&open.project, &open.judge.choice, &open.judge.known));
    ui.horizontal(|ui| {
        let hover = "JSON with everything, and the table as CSV, into a folder";
        exports = ui.button("Export…").on_hover_text(hover).clicked();
        closes = ui.button("Close the table").clicked();
    });
    if !is_asked {
        ui.weak("The request has changed since.");
    }
    let context = ui.ctx().clone();
    if exports {
        app.export_verdicts(&context);
    }
    if let Some(open) = app.open.as_mut().filter(|_| closes) {
        open.judge.shows = false;
    }
}

/// What the verdicts rest on.
fn said_of(judged: &JudgedResult) -> String {
    let judgement = judged.judgement();
    let source = &judgement.source;
    let assumed = source.assumes.iter().map(|assumed| format!("Assumed: {assumed}"));
    let known = format!("Known as {}: {}", source.confidence, source.confidence.meaning());
    let first = [format!("{} ({}), {}", source.id, source.kind, source.edition), source.sources.join(", "), known];
    first.into_iter().chain(assumed).collect::<Vec<_>>().join("\n")
}

/// The columns' right ends, from the left edge of a row.
struct Columns {
    name: f32,
    value: f32,
    margin: f32,
    day: f32,
    width: f32,
}

impl Columns {
    fn of(width: f32) -> Columns {
        let taker = if width >= WIDE { (width - WIDE) / 2.0 + 120.0 } else { 0.0 };
        let name = width - VALUE - MARGIN - DAY - taker;
        Columns { name, value: name + VALUE, margin: name + VALUE + MARGIN, day: name + VALUE + MARGIN + DAY, width }
    }
}

/// The lines, below headings that sort them.
fn rows(app: &mut App, ui: &mut Ui, judged: &Arc<JudgedResult>) {
    let columns = Columns::of(ui.available_width() - 10.0);
    let Some(open) = &mut app.open else { return };
    if let Some(by) = headings(ui, &columns, (open.judge.table.sort, open.judge.table.is_reversed)) {
        open.judge.sort_by(by);
    }
    let (order, chosen) = (open.judge.table.order.clone(), open.judge.table.chosen);
    let mut clicked = None;
    ui.spacing_mut().item_spacing.y = 0.0;
    let height = 22.0;
    let area = egui::ScrollArea::vertical().id_salt("verdicts").auto_shrink(false);
    area.show_rows(ui, height, order.len(), |ui, shown| {
        for index in shown {
            let Some(line) = order.get(index).and_then(|line| judged.lines.get(*line)) else { continue };
            if row(ui, &columns, line, chosen == Some(line.of), height) {
                clicked = Some(line.of);
            }
        }
    });
    if let Some(of) = clicked {
        judge_view::choose(open, of);
    }
}

/// The headings. Returns the one that was clicked.
fn headings(ui: &mut Ui, columns: &Columns, (sort, is_reversed): (SortBy, bool)) -> Option<SortBy> {
    let (rect, _) = ui.allocate_exact_size(vec2(columns.width, 22.0), Sense::hover());
    let mut clicked = None;
    let mut heading = |name: &str, from: f32, to: f32, by: Option<SortBy>, align: egui::Align| {
        let place = Rect::from_min_max(rect.min + vec2(from, 0.0), pos2(rect.left() + to, rect.bottom()));
        let layout = match align {
            egui::Align::Max => egui::Layout::right_to_left(egui::Align::Center),
            _ => egui::Layout::left_to_right(egui::Align::Center),
        };
        let builder = egui::UiBuilder::new().id_salt(name).max_rect(place).layout(layout);
        let mut cell = ui.new_child(builder);
        let text = RichText::new(name).weak();
        match by {
            None => drop(cell.label(text)),
            Some(by) => {
                let response = cell.add(egui::Button::new(text).frame(false));
                let label = format!("Sort by {name}");
                response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, label.clone()));
                if by == sort {
                    mark(ui, response.rect, is_reversed);
                }
                if response.clicked() {
                    clicked = Some(by);
                }
            }
        }
    };
    let (left, right) = (egui::Align::Min, egui::Align::Max);
    heading("verdict", 0.0, 56.0, Some(SortBy::Verdict), left);
    heading("name", 60.0, columns.name, Some(SortBy::Name), left);
    heading("value", columns.name, columns.value, None, right);
    heading("margin", columns.value, columns.margin, Some(SortBy::Margin), right);
    heading("day", columns.margin, columns.day, Some(SortBy::Day), right);
    if columns.width > columns.day + 1.0 {
        heading("taken by, or why", columns.day + 10.0, columns.width, None, left);
    }
    clicked
}

/// A triangle below the heading by which the lines are sorted; it points up where their order is the opposite one.
fn mark(ui: &Ui, heading: Rect, is_reversed: bool) {
    let (middle, way) = (pos2(heading.center().x, heading.bottom() - 2.0), if is_reversed { -1.0 } else { 1.0 });
    let corners = [vec2(-4.0, -2.0 * way), vec2(4.0, -2.0 * way), vec2(0.0, 2.0 * way)].map(|by| middle + by);
    let colour = theme::accent(ui.visuals());
    ui.painter().add(egui::Shape::convex_polygon(corners.to_vec(), colour, egui::Stroke::NONE));
}

/// A line. Returns whether it was clicked.
fn row(ui: &mut Ui, columns: &Columns, line: &JudgedLine, is_chosen: bool, height: f32) -> bool {
    let (rect, response) = ui.allocate_exact_size(vec2(columns.width, height), Sense::click());
    let label = said(line);
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, is_chosen, label.clone()));
    let visuals = ui.visuals();
    if is_chosen {
        ui.painter().rect_filled(rect, 3.0, visuals.selection.bg_fill);
    } else if response.hovered() {
        ui.painter().rect_filled(rect, 3.0, visuals.faint_bg_color);
    }
    let (ink, quiet) = (visuals.text_color(), visuals.weak_text_color());
    let swatch = Rect::from_min_size(rect.min + vec2(2.0, (height - 13.0) / 2.0), vec2(18.0, 13.0));
    verdict::paint_swatch(ui.painter(), swatch, line.verdict);
    let font = FontSelection::Default.resolve(ui.style());
    let text = |from: f32, to: f32, text: &str, align: Align2, colour| {
        let cell = Rect::from_min_max(pos2(rect.left() + from, rect.top()), pos2(rect.left() + to, rect.bottom()));
        let painter = ui.painter_at(cell.intersect(ui.clip_rect()));
        let at = if align == Align2::LEFT_CENTER { cell.left_center() } else { cell.right_center() };
        painter.text(at, align, text, font.clone(), colour);
    };
    let (left, right) = (Align2::LEFT_CENTER, Align2::RIGHT_CENTER);
    // the numbers of a group are a sentence
    let is_group = matches!(line.of, LineOf::Group(_));
    let name = crate::export::figure::without_middle(&line.name, |text| {
        theme::width_of(ui, text) <= columns.name - SWATCH - 6.0
    });
    text(SWATCH, columns.name, &name, left, ink);
    if is_group {
        text(columns.name, columns.day, &line.value, left, ink);
    } else {
        text(columns.name, columns.value, &line.value, right, ink);
        // a missed limit beside a pass would be a riddle; the pointer and the card say why, too
        let margin = if line.excuse.is_some() { ACCEPTED } else { &line.margin };
        text(columns.value, columns.margin, margin, right, ink);
        text(columns.margin, columns.day, &line.day, right, quiet);
        text(columns.day + 10.0, columns.width, line.excuse.as_ref().unwrap_or(&line.taker), left, quiet);
    }
    response.on_hover_text(label).clicked()
}

/// A line in words.
fn said(line: &JudgedLine) -> String {
    let mut said = format!("{} {}", line.name, verdict::word(line.verdict));
    if !line.value.is_empty() && line.value != "-" {
        said += &format!(": {}", line.value);
    }
    if !line.limit.is_empty() && line.limit != "-" {
        said += &format!(" for a limit of {}, margin {}", line.limit, line.margin);
    }
    if let Some(why) = &line.excuse {
        said += &format!(", {ACCEPTED}: {why}");
    }
    if !line.day.is_empty() && line.day != "-" {
        said += &format!(", on {}", line.day);
    }
    if line.verdict != Verdict::Pass && !line.taker.is_empty() {
        said += &format!(", taken by {}", line.taker);
    }
    said
}
