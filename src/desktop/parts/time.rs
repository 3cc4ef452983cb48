//! The bar below the picture: a slider for the day, one for the year, fields for typing, and the play buttons.

use crate::desktop::parts::fields::refused;
use crate::desktop::parts::theme::{self, SUN};
use crate::desktop::state::clock::{Clock, Play};
use crate::desktop::state::words::PanelWords;
use crate::message::Worded;
use crate::site::typed::{self, TypedError};
use crate::sun::{Day, Reading, Zone};
use chrono::{Datelike, NaiveDate, Offset, TimeDelta};
use eframe::egui::{self, Align2, Color32, CornerRadius, FontId, Key, Rect, Response, Sense, Stroke, Ui, pos2, vec2};

impl Clock {
    /// The bar below the picture.
    pub(in crate::desktop) fn bar(&mut self, ui: &mut Ui) {
        // room for the longest texts, so that no date changes the layout
        let zone = self.place.time_zone;
        let widest = format!("{zone} (UTC+00:00, daylight saving), tz {}", zone.version());
        let widest = theme::width_of(ui, &(widest + "azimuth 000.0° altitude −00.0° night"));
        let is_one_row = ui.available_width() > 420.0 + widest;
        ui.horizontal(|ui| {
            self.play_button(ui, Play::Day, "Play the day");
            self.play_button(ui, Play::Year, "Play the year at this hour");
            ui.add_space(6.0);
            self.field(ui, 0, "Date", 92.0);
            self.field(ui, 1, "Clock", 62.0);
            if is_one_row {
                self.zone_and_sun(ui);
            }
        });
        if !is_one_row {
            ui.horizontal(|ui| self.zone_and_sun(ui));
        }
        if let Some(doubt) = Zone::doubt(&self.now.time) {
            ui.weak(doubt);
        }
        if let Some(fault) = &self.fault {
            refused(ui, fault);
        }
        self.day_slider(ui);
        self.year_slider(ui);
    }

    /// The time zone, and the position of the sun.
    fn zone_and_sun(&self, ui: &mut Ui) {
        let offset = self.now.time.offset().fix().to_string();
        let standard = self.solstices.iter().flatten().map(|instant| instant.time.offset().fix().local_minus_utc());
        let summer = standard.min().is_some_and(|least| self.now.time.offset().fix().local_minus_utc() > least);
        let saving = if summer { ", daylight saving" } else { "" };
        let zone = self.place.time_zone;
        ui.weak(format!("{zone} (UTC{offset}{saving}), tz {}", zone.version()));
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            if self.now.night {
                ui.label(egui::RichText::new("night").font(theme::bold(13.5)));
            }
            ui.label(format!("altitude {:.1}°", self.now.altitude_deg()).replace('-', "−"));
            ui.label(format!("azimuth {:.1}°", self.now.azimuth_deg()));
        });
    }

    fn play_button(&mut self, ui: &mut Ui, play: Play, name: &str) {
        let is_on = self.play == Some(play);
        let (rect, response) = ui.allocate_exact_size(vec2(30.0, 24.0), Sense::click());
        let visuals = ui.style().interact_selectable(&response, is_on);
        ui.painter().rect(rect, 5.0, visuals.weak_bg_fill, visuals.bg_stroke, egui::StrokeKind::Inside);
        let middle = rect.center();
        let ink = visuals.text_color();
        if is_on {
            for x in [-4.0, 1.0] {
                ui.painter().rect_filled(Rect::from_min_size(middle + vec2(x, -5.0), vec2(3.0, 10.0)), 0.0, ink);
            }
        } else {
            let triangle = [vec2(-3.5, -5.5), vec2(5.5, 0.0), vec2(-3.5, 5.5)].map(|corner| middle + corner);
            ui.painter().add(egui::Shape::convex_polygon(triangle.to_vec(), ink, Stroke::NONE));
            if play == Play::Year {
                ui.painter().rect_filled(Rect::from_min_size(middle + vec2(6.5, -5.0), vec2(2.0, 10.0)), 0.0, ink);
            }
        }
        response.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, is_on, name));
        if response.on_hover_text(name).clicked() {
            self.toggle(play);
        }
    }

    /// Date or clock as text, which is read when it is finished.
    fn field(&mut self, ui: &mut Ui, which: usize, name: &str, width: f32) {
        let said = if which == 0 { "%Y-%m-%d" } else { "%H:%M" };
        let mut text = self.typed[which].clone().unwrap_or_else(|| self.now.time.format(said).to_string());
        let label = ui.weak(name);
        let response = ui.add(egui::TextEdit::singleline(&mut text).desired_width(width)).labelled_by(label.id);
        if response.changed() {
            self.typed[which] = Some(text.clone());
        }
        if response.lost_focus()
            && let Some(text) = self.typed[which].take()
        {
            self.fault = self.read(which, &text).err().map(|error| error.in_words(&PanelWords));
        }
    }

    fn read(&mut self, which: usize, text: &str) -> Result<(), TypedError> {
        if which == 0 {
            let date = typed::date(text)?;
            // checks the year, too
            Day::of(&self.place, date)?;
            self.set_date(date);
        } else {
            let reading: Reading = typed::clock(text)?.parse()?;
            let time = reading.at(&self.place, self.date())?;
            self.set(time);
        }
        Ok(())
    }

    fn day_slider(&mut self, ui: &mut Ui) {
        let length = self.length_secs;
        let now = self.now.time.format("%H:%M").to_string();
        let (rect, response) = rail(ui, "Time of day", self.secs(), &now);
        let x = |secs: f64| rect.left() + (secs / length) as f32 * rect.width();
        self.daylight(ui, rect);
        self.hour_marks(ui, rect);
        self.sun_events(ui, rect, &response);
        handle(ui, pos2(x(self.secs()), rect.center().y), &response, self.now.night);
        if let Some(share) = dragged(&response, rect) {
            // to the minute, as the fields show it
            self.set_secs((share * length / 60.0).round() * 60.0);
        }
        let steps = keys(ui, &response);
        if steps != 0 {
            self.step_secs(steps * 300);
        }
    }

    /// Day and night along the day's slider.
    fn daylight(&self, ui: &Ui, rect: Rect) {
        let length = self.length_secs;
        let x = |secs: f64| rect.left() + (secs / length) as f32 * rect.width();
        let dark = ui.visuals().dark_mode;
        let [night, day] = if dark { [40, 74] } else { [196, 236] };
        let (night, day) = (Color32::from_rgb(night - 8, night, night + 14), Color32::from_rgb(day + 6, day, day - 14));
        let painter = ui.painter();
        // computed from the sun itself, so polar day and night need no special case
        painter.rect_filled(rect, CornerRadius::same(4), night);
        let mut up: Option<f64> = None;
        for (index, instant) in self.day.iter().enumerate() {
            let secs = (instant.time - self.midnight).num_seconds() as f64;
            let is_last = index + 1 == self.day.len();
            match (up, instant.to_sun.z >= 0.0 && !is_last) {
                (None, true) => up = Some(secs),
                (Some(from), false) => {
                    let lit = Rect::from_x_y_ranges(x(from)..=x(secs.min(length)), rect.y_range());
                    painter.rect_filled(lit, CornerRadius::same(2), day);
                    up = None;
                }
                _ => {}
            }
        }
    }

    fn hour_marks(&self, ui: &Ui, rect: Rect) {
        let x = |secs: f64| rect.left() + (secs / self.length_secs) as f32 * rect.width();
        let painter = ui.painter();
        let quiet = ui.visuals().weak_text_color();
        for (hour, instant) in &self.hours {
            let at = x((instant.time - self.midnight).num_seconds() as f64);
            let tall = if hour % 6 == 0 { 6.0 } else { 3.0 };
            painter.vline(at, rect.bottom() - tall..=rect.bottom(), Stroke::new(1.0, quiet));
            if hour % 3 == 0 {
                let text = format!("{hour}");
                painter.text(
                    pos2(at, rect.bottom() + 2.0),
                    Align2::CENTER_TOP,
                    text,
                    FontId::proportional(11.0),
                    quiet,
                );
            }
        }
    }

    /// Sunrise, noon and sunset.
    fn sun_events(&self, ui: &Ui, rect: Rect, slider: &Response) {
        let x = |secs: f64| rect.left() + (secs / self.length_secs) as f32 * rect.width();
        let painter = ui.painter();
        let ink = ui.visuals().text_color();
        for (event, name) in
            [(self.events.sunrise, "sunrise"), (self.events.noon, "noon"), (self.events.sunset, "sunset")]
        {
            let Some(event) = event else { continue };
            let at = x((event - self.midnight).num_seconds() as f64);
            painter.vline(at, rect.y_range(), Stroke::new(1.5, theme::ACCENT));
            // to the nearest minute, as in drawings
            let text = format!("{name} {}", (event + TimeDelta::seconds(30)).format("%H:%M"));
            let (at, font) = (pos2(at, rect.top() - 1.0), FontId::proportional(11.0));
            let letters = painter.text(at, Align2::CENTER_BOTTOM, &text, font, ink);
            let response = ui.interact(letters, slider.id.with(name), Sense::hover());
            response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, &text));
        }
    }

    fn year_slider(&mut self, ui: &mut Ui) {
        let date = self.date();
        let days = if date.leap_year() { 366.0 } else { 365.0 };
        let said = date.format("%-d %B").to_string();
        let (rect, response) = rail(ui, "Day of the year", f64::from(date.ordinal()), &said);
        let x = |ordinal0: f64| rect.left() + (ordinal0 / days) as f32 * rect.width();
        let painter = ui.painter();
        let visuals = ui.visuals();
        let quiet = visuals.weak_text_color();
        painter.rect_filled(rect, CornerRadius::same(4), visuals.widgets.inactive.bg_fill);
        for month in 1..=12 {
            let Some(first) = NaiveDate::from_ymd_opt(date.year(), month, 1) else { continue };
            let at = x(f64::from(first.ordinal0()));
            painter.vline(at, rect.bottom() - 4.0..=rect.bottom(), Stroke::new(1.0, quiet));
            let middle = pos2(at + rect.width() / 24.0, rect.bottom() + 2.0);
            painter.text(middle, Align2::CENTER_TOP, first.format("%b").to_string(), FontId::proportional(11.0), quiet);
        }
        for (month, day, name) in [(3, 20, "equinox"), (6, 21, "solstice"), (9, 23, "equinox"), (12, 21, "solstice")] {
            let Some(mark) = NaiveDate::from_ymd_opt(date.year(), month, day) else { continue };
            let at = x(f64::from(mark.ordinal0()) + 0.5);
            painter.vline(at, rect.y_range(), Stroke::new(1.5, theme::ACCENT));
            let (at, align) = (pos2(at, rect.top() - 1.0), Align2::CENTER_BOTTOM);
            painter.text(at, align, name, FontId::proportional(11.0), visuals.text_color());
        }
        handle(ui, pos2(x(f64::from(date.ordinal0()) + 0.5), rect.center().y), &response, false);
        if let Some(share) = dragged(&response, rect) {
            let ordinal = (share * days).floor().clamp(0.0, days - 1.0) as u32 + 1;
            if let Some(date) = NaiveDate::from_yo_opt(date.year(), ordinal) {
                self.set_date(date);
            }
        }
        let steps = keys(ui, &response);
        if steps != 0 {
            self.step_days(steps);
        }
    }
}

/// A slider's rail with room for labels above and below.
fn rail(ui: &mut Ui, name: &str, value: f64, said: &str) -> (Rect, Response) {
    let (whole, response) = ui.allocate_exact_size(vec2(ui.available_width(), 47.0), Sense::click_and_drag());
    let label = format!("{name}: {said}");
    response.widget_info(|| egui::WidgetInfo::slider(true, value, &label));
    let rect = Rect::from_min_max(whole.min + vec2(14.0, 15.0), whole.max - vec2(14.0, 17.0));
    if response.has_focus() {
        let accent = theme::accent(ui.visuals());
        ui.painter().rect_stroke(rect.expand(2.0), 5.0, Stroke::new(1.5, accent), egui::StrokeKind::Outside);
    }
    (rect, response)
}

fn handle(ui: &Ui, at: egui::Pos2, response: &Response, night: bool) {
    let fill = if night { Color32::from_rgb(96, 104, 124) } else { SUN };
    let radius = if response.hovered() || response.dragged() { 9.5 } else { 8.0 };
    ui.painter().circle(at, radius, fill, Stroke::new(1.5, theme::ACCENT));
}

/// The position of the pointer along the rail, 0 to 1, while it drags or clicks.
fn dragged(response: &Response, rect: Rect) -> Option<f64> {
    if response.clicked() || response.drag_started() {
        response.request_focus();
    }
    let pointer = response.interact_pointer_pos().filter(|_| response.dragged() || response.clicked())?;
    Some(f64::from((pointer.x - rect.left()) / rect.width()).clamp(0.0, 1.0))
}

/// The steps that the arrow keys move a focused slider, with Shift twelve at a time.
fn keys(ui: &Ui, response: &Response) -> i64 {
    if !response.has_focus() {
        return 0;
    }
    let arrows = egui::EventFilter { horizontal_arrows: true, ..egui::EventFilter::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, arrows));
    steps(ui.ctx(), Key::ArrowLeft, Key::ArrowRight, 12)
}

/// The difference between the presses of two keys. With Shift each press counts as `many`; each press carries its own
/// Shift state, which may have changed when the frame begins.
pub(in crate::desktop) fn steps(context: &egui::Context, back: Key, on: Key, many: i64) -> i64 {
    context.input(|input| {
        let step = |event: &egui::Event| match event {
            egui::Event::Key { key, pressed: true, modifiers, .. } if *key == back || *key == on => {
                (if modifiers.shift { many } else { 1 }) * (if *key == on { 1 } else { -1 })
            }
            _ => 0,
        };
        input.events.iter().map(step).sum()
    })
}
