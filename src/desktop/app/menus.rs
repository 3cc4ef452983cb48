//! Menus and their shortcuts, and beside them what is under the pointer.

use crate::deliver::lines::Lines;
use crate::desktop::app::state::{App, Open};
use crate::desktop::parts::path_dialog::Purpose;
use crate::desktop::parts::theme;
use crate::desktop::parts::time::steps;
use crate::desktop::results::Findings;
use crate::desktop::state::clock::Play;
use crate::desktop::state::eye::Stand;
use crate::desktop::state::project::name_of;
use crate::desktop::state::unit::Unit;
use crate::desktop::work::loading::LoadRequest;
use crate::desktop::work::samples;
use eframe::egui::{self, Key, KeyboardShortcut, Modifiers, ThemePreference, Ui};

const OPEN: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::O);
const SAVE: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::S);
const SAVE_AS: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::S);
const RELOAD: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::R);
const RELOAD_TOO: KeyboardShortcut = KeyboardShortcut::new(Modifiers::NONE, Key::F5);
const EXPORT: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::E);
/// Judges the site.
pub(in crate::desktop) const JUDGE: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::J);
const UNDO: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::Z);
const REDO: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z);

/// A menu, which scrolls if it is longer than the window is high.
fn menu(ui: &mut Ui, name: &str, content: impl FnOnce(&mut Ui)) {
    ui.menu_button(name, |ui| {
        // otherwise it is 400 points, however high the window
        ui.set_max_height(ui.ctx().content_rect().bottom() - ui.next_widget_position().y - 12.0);
        egui::ScrollArea::vertical().show(ui, content)
    });
}

/// An entry of a menu, with its shortcut.
fn entry(context: &egui::Context, name: &str, keys: &KeyboardShortcut) -> egui::Button<'static> {
    egui::Button::new(name.to_owned()).shortcut_text(context.format_shortcut(keys))
}

fn themes(ui: &mut Ui) {
    let context = ui.ctx().clone();
    let mut theme = context.options(|options| options.theme_preference);
    for (name, choice) in
        [("As the system", ThemePreference::System), ("Light", ThemePreference::Light), ("Dark", ThemePreference::Dark)]
    {
        if ui.radio_value(&mut theme, choice, name).clicked() {
            context.set_theme(theme);
        }
    }
}

/// Larger, smaller, and the screen's own scale. The shortcuts are egui's.
fn interface_scale(ui: &mut Ui) {
    use egui::gui_zoom::{kb_shortcuts, zoom_in, zoom_out};
    let context = ui.ctx().clone();
    ui.weak(format!("Interface at {:.0}%", context.zoom_factor() * 100.0));
    let chosen = |ui: &mut Ui, name: &str, keys| ui.add(entry(&context, name, keys)).clicked();
    if chosen(ui, "Larger interface", &kb_shortcuts::ZOOM_IN) {
        zoom_in(&context);
    }
    if chosen(ui, "Smaller interface", &kb_shortcuts::ZOOM_OUT) {
        zoom_out(&context);
    }
    if chosen(ui, "Interface at its own size", &kb_shortcuts::ZOOM_RESET) {
        context.set_zoom_factor(1.0);
    }
}

impl App {
    pub(in crate::desktop) fn shortcuts(&mut self, context: &egui::Context) {
        if self.is_questioned() {
            return;
        }
        self.tool_keys(context);
        let pressed = |shortcut| context.input_mut(|input| input.consume_shortcut(&shortcut));
        let (redo, saves_as) = (pressed(REDO), pressed(SAVE_AS));
        let (undo, opens, saves, exports) = (pressed(UNDO), pressed(OPEN), pressed(SAVE), pressed(EXPORT));
        if pressed(RELOAD) || pressed(RELOAD_TOO) {
            self.reload(context);
        }
        if redo {
            let settings = self.history.redo();
            self.set(settings);
        }
        if undo {
            let settings = self.history.undo();
            self.set(settings);
        }
        if opens {
            self.ask(Purpose::Open, context);
        }
        if pressed(JUDGE) {
            self.judge(context);
        }
        if saves && self.open.is_some() && self.asking.is_none() {
            // typed text is taken over first, in this frame
            context.memory_mut(|memory| memory.stop_text_input());
            self.saving.saves = true;
        }
        if saves_as && self.open.is_some() {
            self.ask(Purpose::SaveSite, context);
        }
        if exports && self.open.is_some() {
            self.ask(Purpose::Drawing, context);
        }
        let free = context.memory(|memory| memory.focused().is_none());
        let Some(open) = self.open.as_mut().filter(|_| free) else { return };
        let minutes = steps(context, Key::ArrowLeft, Key::ArrowRight, 12) * 5;
        if minutes != 0 {
            open.clock.step_secs(minutes * 60);
        }
        let days = steps(context, Key::ArrowDown, Key::ArrowUp, 30);
        if days != 0 {
            open.clock.step_days(days);
        }
        if context.input(|input| input.key_pressed(Key::Space)) {
            open.clock.toggle(open.clock.play.unwrap_or(Play::Day));
        }
        let stands = [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5, Key::Num6];
        for (key, (stand, _)) in stands.into_iter().zip(Stand::ALL) {
            if context.input(|input| input.key_pressed(key)) {
                open.viewer.eye.stand = stand;
            }
        }
        if context.input(|input| input.key_pressed(Key::F)) {
            open.viewer.fit();
        }
    }

    pub(in crate::desktop) fn menus(&mut self, ui: &mut Ui) {
        egui::MenuBar::new().ui(ui, |ui| {
            menu(ui, "File", |ui| self.file_menu(ui));
            menu(ui, "Edit", |ui| self.edit_menu(ui));
            menu(ui, "View", |ui| self.view_menu(ui));
            if let Some(open) = &self.open {
                ui.separator();
                let name = egui::RichText::new(open.project.name()).font(theme::bold(13.5));
                ui.scope(|ui| {
                    ui.set_max_width(240.0);
                    ui.add(egui::Label::new(name).truncate());
                });
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| self.read_out(open, ui));
            }
        });
    }

    fn file_menu(&mut self, ui: &mut Ui) {
        let context = ui.ctx().clone();
        let is_open = self.open.is_some();
        if ui.add(entry(&context, "Open…", &OPEN)).clicked() {
            self.ask(Purpose::Open, &context);
        }
        if !self.kept.recent.is_empty() {
            ui.menu_button("Open again", |ui| {
                for path in self.kept.recent.clone() {
                    let name = name_of(&path);
                    if ui.button(name).on_hover_text(path.display().to_string()).clicked() {
                        self.load(LoadRequest::Files(vec![path]), &context);
                    }
                }
            });
        }
        ui.menu_button("Samples", |ui| {
            for name in samples::SAMPLES {
                if ui.button(name).clicked() {
                    self.open_sample(name, &context);
                }
            }
        });
        if ui.add_enabled(is_open, entry(&context, "Reload from the disk", &RELOAD)).clicked() {
            self.reload(&context);
        }
        ui.separator();
        if ui.add_enabled(is_open, entry(&context, "Save the site file", &SAVE)).clicked() {
            self.saving.saves = true;
        }
        if ui.add_enabled(is_open, entry(&context, "Save as…", &SAVE_AS)).clicked() {
            self.ask(Purpose::SaveSite, &context);
        }
        self.export_entries(ui);
    }

    /// The entries of the file menu that export what is shown and what was found.
    fn export_entries(&mut self, ui: &mut Ui) {
        let context = ui.ctx().clone();
        let is_open = self.open.is_some();
        if ui.add_enabled(is_open, entry(&context, "Export the drawing…", &EXPORT)).clicked() {
            self.ask(Purpose::Drawing, &context);
        }
        let result = self.open.as_ref().and_then(|open| open.result.as_ref());
        let has_verdicts = self.open.as_ref().is_some_and(|open| open.judge.judged.is_some());
        let has_lines = result.is_some_and(|result| matches!(result.found, Findings::Shadow(_)));
        for (name, purpose, is_there) in [
            ("Export the hours…", Purpose::Hours, result.is_some()),
            ("Export the iso-hour lines…", Purpose::Lines(Lines::Hours), has_lines),
            ("Export the outlines…", Purpose::Lines(Lines::Outlines), has_lines),
            ("Export the verdicts…", Purpose::Verdicts, has_verdicts),
        ] {
            let response = ui.add_enabled(is_there, egui::Button::new(name));
            let first = if purpose == Purpose::Verdicts {
                "Judge it by a rule first"
            } else {
                "Find the hours of shadow first"
            };
            if response.on_disabled_hover_text(first).clicked() {
                self.ask(purpose, &context);
            }
        }
        if ui.add_enabled(is_open, egui::Button::new("Export the animation…")).clicked() {
            self.ask(Purpose::Animation, &context);
        }
        if ui.add_enabled(is_open, egui::Button::new("Copy the picture")).clicked() {
            self.copy(&context);
        }
    }

    fn edit_menu(&mut self, ui: &mut Ui) {
        let context = ui.ctx().clone();
        let [undo, redo] = self.history.has();
        if ui.add_enabled(undo, entry(&context, "Undo", &UNDO)).clicked() {
            let settings = self.history.undo();
            self.set(settings);
        }
        if ui.add_enabled(redo, entry(&context, "Redo", &REDO)).clicked() {
            let settings = self.history.redo();
            self.set(settings);
        }
        ui.separator();
        if ui.add_enabled(self.open.is_some(), entry(&context, "Judge by the rule", &JUDGE)).clicked() {
            self.judge(&context);
        }
    }

    fn view_menu(&mut self, ui: &mut Ui) {
        if let Some(open) = &mut self.open {
            for (number, (stand, name)) in Stand::ALL.into_iter().enumerate() {
                let is_it = open.viewer.eye.stand == stand;
                let button = egui::Button::selectable(is_it, name).shortcut_text((number + 1).to_string());
                if ui.add(button).clicked() {
                    open.viewer.eye.stand = stand;
                }
            }
            if ui.add(egui::Button::new("Fit").shortcut_text("F")).clicked() {
                open.viewer.fit();
            }
            ui.separator();
        }
        let mut path = !self.kept.no_sun_path;
        ui.checkbox(&mut path, "The sun's path");
        self.kept.no_sun_path = !path;
        ui.checkbox(&mut self.kept.feet, "Lengths in feet");
        ui.separator();
        themes(ui);
        ui.separator();
        interface_scale(ui);
    }

    /// What is under the pointer, and where, shortened to the available room.
    fn read_out(&self, open: &Open, ui: &mut Ui) {
        let Some(under) = &open.viewer.under else { return };
        let unit = Unit::of(self.kept.feet);
        let at = (under.point / unit.metres * 10.0).round() / 10.0 + 0.0;
        let at = format!("{:.1} E  {:.1} N  {:.1} up, {}", at.x, at.y, at.z, unit.name).replace('-', "−");
        let result = open.result.as_ref().filter(|_| open.shows_hours);
        let hours = result.and_then(|result| result.said(under, unit)).unwrap_or_default();
        let parts = [hours, under.name.clone(), at].map(|part| Some(part).filter(|part| !part.is_empty()));
        let parts: Vec<String> = parts.into_iter().flatten().collect();
        let mut texts = (1..=parts.len()).rev().map(|count| parts[..count].join("    "));
        let fits = texts.clone().find(|text| theme::width_of(ui, text) < ui.available_width());
        if let Some(text) = fits.or_else(|| texts.next_back()) {
            ui.add(egui::Label::new(egui::RichText::new(text).weak()).truncate());
        }
    }
}
