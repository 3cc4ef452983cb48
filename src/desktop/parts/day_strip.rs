//! The day of something that is judged, as bars along its hours.

use crate::desktop::parts::theme::{self, SUN};
use crate::export::judgement::{BarKind, DayStrip, StripBar};
use crate::sun::Zone;
use chrono::{DateTime, TimeDelta, Timelike};
use eframe::egui::{self, Align2, Color32, FontId, Rect, Sense, Stroke, Ui, pos2, vec2};

/// The height of a bar and the gap below it, points.
const BAR: f32 = 13.0;
const GAP: f32 = 4.0;
/// The room for the bars' names, and for the hours.
const NAMES: f32 = 78.0;
const HOURS: f32 = 15.0;

/// The bars, with their names at the left and the hours below.
pub(in crate::desktop) fn show(ui: &mut Ui, strip: &DayStrip) {
    let bars = strip.bars.len() as f32;
    let size = vec2(ui.available_width(), bars * (BAR + GAP) + HOURS);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    let label = format!("The day of {}", strip.date);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, label.clone()));
    let across = Rect::from_min_max(rect.min + vec2(NAMES, 0.0), rect.max - vec2(6.0, HOURS));
    let [from, to] = &strip.ends;
    let length = (*to - *from).num_seconds().max(1) as f32;
    let x = |time: &DateTime<Zone>| across.left() + across.width() * ((*time - *from).num_seconds() as f32 / length);
    let painter = ui.painter_at(rect.expand(2.0));
    let quiet = ui.visuals().weak_text_color();
    let font = FontId::proportional(11.5);
    for (number, bar) in strip.bars.iter().enumerate() {
        let top = rect.top() + number as f32 * (BAR + GAP);
        let middle = pos2(rect.left(), top + BAR / 2.0);
        painter.text(middle, Align2::LEFT_CENTER, bar.kind.label(), font.clone(), quiet);
        let line = Rect::from_min_max(pos2(across.left(), top), pos2(across.right(), top + BAR));
        painter.rect_filled(line, 2.0, ui.visuals().faint_bg_color);
        let (fill, edge) = colours(bar.kind);
        for spell in &bar.spells {
            let [left, right] = [x(&spell.start), x(&spell.end)];
            let part = Rect::from_min_max(pos2(left, top), pos2(right.max(left + 1.0), top + BAR));
            painter.rect(part, 1.0, fill, Stroke::new(1.0, edge), egui::StrokeKind::Inside);
        }
    }
    // every hour has a tick, and as many have numbers as there is room for
    let apart = across.width() / (length / 3600.0).max(0.1);
    let each = [1, 2, 3, 6].into_iter().find(|each| apart * *each as f32 > 24.0).unwrap_or(12);
    let mut hour = from.with_minute(0).and_then(|time| time.with_second(0)).map(|time| time + TimeDelta::hours(1));
    while let Some(time) = hour.filter(|time| time <= to) {
        let at = x(&time);
        let ends = [pos2(at, rect.top()), pos2(at, across.bottom())];
        painter.line_segment(ends, Stroke::new(0.5, quiet.gamma_multiply(0.5)));
        if time.hour() % each == 0 {
            let below = pos2(at, across.bottom());
            painter.text(below, Align2::CENTER_TOP, time.hour().to_string(), font.clone(), quiet);
        }
        hour = Some(time + TimeDelta::hours(1));
    }
}

fn colours(kind: BarKind) -> (Color32, Color32) {
    let gray = Color32::from_gray;
    match kind {
        BarKind::Window => (gray(150), gray(120)),
        BarKind::Open => (SUN.gamma_multiply(0.35), SUN.gamma_multiply(0.6)),
        BarKind::Before => (SUN.gamma_multiply(0.6), theme::ACCENT),
        BarKind::Now => (SUN, theme::ACCENT),
        BarKind::NewShadow => (Color32::from_rgb(74, 96, 138), Color32::from_rgb(44, 60, 96)),
    }
}

/// The stretches of a bar in words, and what blocks the sun around each.
pub(in crate::desktop) fn spells(ui: &mut Ui, bar: &StripBar) {
    for spell in &bar.spells {
        let secs = (spell.end - spell.start).num_seconds();
        let (start, end) = (spell.start.format("%H:%M:%S"), spell.end.format("%H:%M:%S"));
        ui.label(format!("{start} – {end}, {}:{:02}:{:02}", secs / 3600, secs / 60 % 60, secs % 60));
        if let Some([before, after]) = &spell.bounds {
            ui.weak(format!("before: {}, after: {}", bound(before), bound(after)));
        }
    }
}

/// What blocks the sun, in words.
fn bound(word: &str) -> &str {
    match word {
        "window" => "the counted time",
        "horizon" => "the horizon",
        "behind" => "the sun is behind it",
        "cut" => "the rule does not count that sun",
        "reveal" => "the wall around it",
        "ground" => "the ground above it",
        name => name,
    }
}
