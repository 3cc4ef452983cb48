//! Cards over the picture: the legend of hours, and the times when a point lies in the sun.

use crate::desktop::app::judge_view;
use crate::desktop::app::state::Open;
use crate::desktop::parts::components;
use crate::desktop::parts::sky;
use crate::desktop::parts::theme;
use crate::desktop::results::StudyResult;
use crate::desktop::state::settings::WindowSettings;
use crate::desktop::state::unit::Unit;
use crate::export::figure::scale::Rgb;
use crate::site::file::ProbeTable;
use crate::sunlight::{IntervalBound, ProbeIntervals, Sunlight, secs};
use crate::view::{Probe, View};
use eframe::egui::{self, Align2, Color32, Id, Rect, Sense, Ui, Vec2, vec2};
use std::sync::Arc;

/// The greatest width of a card, points.
const WIDTH: f32 = 290.0;
const AROUND: f32 = 14.0;
/// The margin within a card's border.
const WITHIN: f32 = 10.0;

/// Shows the cards over a picture: side by side, or in one column if there is no room for two.
pub(in crate::desktop) fn show(ui: &Ui, open: &mut Open, settings: &mut WindowSettings, rect: Rect, unit: Unit) {
    let result = open.result.clone().filter(|_| open.shows_hours && open.judge.shown().is_none());
    let is_probed = open.probing.is_some() || open.sunlight.is_some();
    let is_wide = rect.width() > 2.0 * WIDTH;
    if let Some(result) = result.as_ref().filter(|_| is_wide || !is_probed) {
        card(ui, "hours", rect, Align2::LEFT_TOP, Vec2::splat(AROUND), |ui| legend(ui, result));
    }
    if is_probed {
        // below the north arrow if there is room
        let below = if rect.height() > 400.0 { 88.0 } else { AROUND };
        let result = result.as_ref().filter(|_| !is_wide);
        card(ui, "probe", rect, Align2::RIGHT_TOP, vec2(-AROUND, below), |ui| probe(open, settings, unit, result, ui));
    } else if !open.judge.table.is_beside && open.judge.chosen().is_some() {
        let buttons = ui.spacing().interact_size.y + ui.spacing().item_spacing.y;
        card(ui, "verdict", rect, Align2::LEFT_TOP, Vec2::splat(AROUND), |ui| judge_view::card(ui, open, buttons));
    }
}

fn card(ui: &Ui, name: &str, rect: Rect, corner: Align2, offset: Vec2, content: impl FnOnce(&mut Ui)) {
    let area = egui::Area::new(Id::unique(name)).order(egui::Order::Middle).pivot(corner).constrain_to(rect);
    area.fixed_pos(corner.pos_in_rect(&rect) + offset).show(ui.ctx(), |ui| {
        let frame = egui::Frame::popup(ui.style()).inner_margin(WITHIN);
        frame.show(ui, |ui| {
            ui.set_max_width(WIDTH.min(rect.width() - 2.0 * (AROUND + WITHIN)));
            ui.set_max_height(rect.height() - offset.y - AROUND - 2.0 * WITHIN);
            content(ui);
        });
    });
}

/// A part of a card that scrolls if it is longer than the picture is high; `below` is the room kept below it.
fn scrolled(ui: &mut Ui, below: f32, content: impl FnOnce(&mut Ui)) {
    let most = (ui.available_height() - below).max(24.0);
    egui::ScrollArea::vertical().max_height(most).auto_shrink(true).min_scrolled_height(24.0).show(ui, content);
}

/// Marks the point that is being searched, or was found.
pub(in crate::desktop) fn mark(ui: &Ui, open: &Open, view: &View, rect: Rect) {
    let found = open.sunlight.as_ref().and_then(|sunlight| sunlight.probes.first());
    let Some(probed) = found else { return };
    if let Some(at) = sky::on_picture(view, rect, probed.probe.point) {
        let painter = ui.painter_at(rect);
        painter.circle(at, 5.0, Color32::WHITE, egui::Stroke::new(2.5, theme::ACCENT));
    }
}

/// A colour and what it means.
pub(in crate::desktop) fn swatch(ui: &mut Ui, [r, g, b]: Rgb, what: &str) {
    ui.horizontal(|ui| {
        let height = ui.spacing().interact_size.y.min(16.0) - 1.0;
        let (rect, _) = ui.allocate_exact_size(vec2(30.0, height), Sense::hover());
        ui.painter().rect_filled(rect, 2.0, Color32::from_rgb(r, g, b));
        ui.label(what);
    });
}

/// The legend of the colours on the scene.
fn legend(ui: &mut Ui, result: &StudyResult) {
    let (head, entries) = result.legend();
    ui.label(head);
    scrolled(ui, 0.0, |ui| swatches(ui, &entries));
}

fn swatches(ui: &mut Ui, entries: &[(Rgb, String)]) {
    ui.scope(|ui| {
        // rows have the height of their text; long legends use a small font, to hide less of the picture
        let is_long = entries.len() > 10;
        (ui.spacing_mut().item_spacing.y, ui.spacing_mut().interact_size.y) =
            if is_long { (0.0, 13.0) } else { (1.0, 16.0) };
        ui.style_mut().override_text_style = is_long.then_some(egui::TextStyle::Small);
        entries.iter().for_each(|(colour, what)| swatch(ui, *colour, what));
    });
}

fn probe(open: &mut Open, settings: &mut WindowSettings, unit: Unit, result: Option<&Arc<StudyResult>>, ui: &mut Ui) {
    if open.probing.is_some() {
        ui.horizontal(|ui| {
            ui.add(egui::Spinner::new().size(16.0));
            ui.label("Searching the day of the point");
        });
        return;
    }
    let (sky, Some(sunlight)) = (&mut open.sky, &open.sunlight) else { return };
    let Some(probed) = sunlight.probes.first() else { return };
    ui.label(egui::RichText::new(format!("Sun at {}", probed.probe.name)).font(theme::bold(13.5)));
    let point = probed.probe.point;
    // the buttons stay visible
    let buttons = ui.spacing().interact_size.y + ui.spacing().item_spacing.y;
    let mut closes = false;
    scrolled(ui, buttons, |ui| {
        // the hover text stays when the pointer moves on
        let under = open.clicked.as_ref().filter(|under| under.point == point);
        let said = open.result.as_ref().zip(under).and_then(|(result, under)| result.said(under, unit));
        place(ui, probed, said, unit);
        intervals(ui, sunlight);
        if let Some(sky) = sky {
            sky.show(ui);
        }
        if let Some(under) = under.filter(|under| under.face.is_some())
            && ui.button("Hide this component").clicked()
        {
            components::hide(settings, &under.name, true);
            closes = true;
        }
        if let Some(result) = result {
            ui.separator();
            let (head, entries) = result.legend();
            ui.label(head);
            swatches(ui, &entries);
        }
    });
    ui.horizontal(|ui| {
        keep_button(ui, &probed.probe, settings);
        closes |= ui.button("Forget the point").clicked();
    });
    if closes {
        (open.sunlight, open.sky) = (None, None);
    }
}

/// The position of a point, and the value of the shown study there.
fn place(ui: &mut Ui, probed: &ProbeIntervals, said: Option<String>, unit: Unit) {
    let (at, name) = (probed.probe.point / unit.metres, unit.name);
    ui.weak(format!("{:.2} {name} east, {:.2} {name} north, {:.2} {name} up", at.x, at.y, at.z).replace('-', "−"));
    if let Some(said) = said {
        ui.label(format!("In the study: {said}"));
    }
    if let Some(below) = probed.below_ground_m {
        ui.label(format!("It lies {:.2} {name} below the ground", below / unit.metres));
    }
}

/// The intervals in which the first point lies in the sun on the first day.
fn intervals(ui: &mut Ui, sunlight: &Sunlight) {
    let day = sunlight.days.first();
    let Some((day, intervals)) = day.zip(sunlight.probes.first().and_then(|probed| probed.days.first())) else {
        return;
    };
    let clock = |secs: i64| format!("{}:{:02}:{:02}", secs / 3600, secs / 60 % 60, secs % 60);
    ui.label(format!("{}: {} of sun", day.window.day.date, clock(secs(intervals))));
    for interval in intervals {
        let (start, end) = (interval.start.format("%H:%M:%S"), interval.end.format("%H:%M:%S"));
        ui.label(format!("{start} – {end}"));
        let (before, after) = (named(sunlight, interval.before), named(sunlight, interval.after));
        ui.weak(format!("before: {before}, after: {after}"));
    }
}

/// A button that writes the point into the site as a probe, unless it is already there.
fn keep_button(ui: &mut Ui, probe: &Probe, settings: &mut WindowSettings) {
    let millimetres = |value: f64| (value * 1000.0).round() / 1000.0 + 0.0;
    let table = ProbeTable {
        name: None,
        point: Some(probe.point.to_array().map(millimetres)),
        normal: probe.normal.map(|normal| normal.to_array().map(|part| (part * 1e6).round() / 1e6 + 0.0)),
    };
    let is_kept = settings.site.probe.iter().any(|probe| probe.point == table.point);
    let keep = egui::Button::new(if is_kept { "In the site file" } else { "Keep in the site file" });
    if ui.add_enabled(!is_kept, keep).clicked() {
        settings.site.probe.push(table);
    }
}

fn named(sunlight: &Sunlight, blocked: IntervalBound) -> String {
    match sunlight.name(blocked).as_str() {
        "horizon" => "the horizon".to_owned(),
        "behind" => "the sun is behind it".to_owned(),
        "ground" => "the ground above it".to_owned(),
        "window" => "midnight".to_owned(),
        name => name.to_owned(),
    }
}
