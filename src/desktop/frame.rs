//! The window's frame: keys, menus, messages, and what is shown before anything is open.

use super::app::{App, Open};
use super::clock::Play;
use super::export;
use super::eye::Stand;
use super::files::{self, Purpose};
use super::hours::Findings;
use super::loading::{LoadRequest, name_of};
use super::look;
use super::time::steps;
use super::unit::Unit;
use crate::deliver::lines::Lines;
use eframe::egui::{self, Key, KeyboardShortcut, Modifiers, ThemePreference, Ui};

const OPEN: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::O);
const SAVE: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::S);
const SAVE_AS: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::S);
const RELOAD: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::R);
const RELOAD_TOO: KeyboardShortcut = KeyboardShortcut::new(Modifiers::NONE, Key::F5);
const EXPORT: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::E);
const UNDO: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::Z);
const REDO: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z);

/// A menu; what is longer than the window is high is scrolled.
fn menu(ui: &mut Ui, name: &str, content: impl FnOnce(&mut Ui)) {
    ui.menu_button(name, |ui| {
        // else 400 points, however high the window
        ui.set_max_height(ui.ctx().content_rect().bottom() - ui.next_widget_position().y - 12.0);
        egui::ScrollArea::vertical().show(ui, content)
    });
}

/// Larger, smaller, and as the screen has it. The keys are egui's own.
fn interface_scale(ui: &mut Ui) {
    use egui::gui_zoom::{kb_shortcuts, zoom_in, zoom_out};
    let context = ui.ctx().clone();
    ui.weak(format!("Interface at {:.0}%", context.zoom_factor() * 100.0));
    let entry = |ui: &mut Ui, name: &str, keys| {
        ui.add(egui::Button::new(name).shortcut_text(context.format_shortcut(keys))).clicked()
    };
    if entry(ui, "Larger interface", &kb_shortcuts::ZOOM_IN) {
        zoom_in(&context);
    }
    if entry(ui, "Smaller interface", &kb_shortcuts::ZOOM_OUT) {
        zoom_out(&context);
    }
    if entry(ui, "Interface at its own size", &kb_shortcuts::ZOOM_RESET) {
        context.set_zoom_factor(1.0);
    }
}

impl App {
    pub(super) fn shortcuts(&mut self, context: &egui::Context) {
        if self.is_questioned() {
            return;
        }
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
        if saves && self.open.is_some() && self.asking.is_none() {
            // what is typed is taken first, in this very frame
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

    pub(super) fn menus(&mut self, ui: &mut Ui) {
        let context = ui.ctx().clone();
        let is_open = self.open.is_some();
        egui::MenuBar::new().ui(ui, |ui| {
            menu(ui, "File", |ui| {
                let button = |text: &str, shortcut: &KeyboardShortcut| {
                    egui::Button::new(text.to_owned()).shortcut_text(context.format_shortcut(shortcut))
                };
                if ui.add(button("Open…", &OPEN)).clicked() {
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
                    for name in files::SAMPLES {
                        if ui.button(name).clicked() {
                            self.open_sample(name, &context);
                        }
                    }
                });
                if ui.add_enabled(is_open, button("Reload from the disk", &RELOAD)).clicked() {
                    self.reload(&context);
                }
                ui.separator();
                if ui.add_enabled(is_open, button("Save the site file", &SAVE)).clicked() {
                    self.saving.saves = true;
                }
                if ui.add_enabled(is_open, button("Save as…", &SAVE_AS)).clicked() {
                    self.ask(Purpose::SaveSite, &context);
                }
                if ui.add_enabled(is_open, button("Export the drawing…", &EXPORT)).clicked() {
                    self.ask(Purpose::Drawing, &context);
                }
                let laid = self.open.as_ref().and_then(|open| open.laid.as_ref());
                let has_lines = laid.is_some_and(|laid| matches!(laid.found, Findings::Shadow(_)));
                for (name, purpose, is_there) in [
                    ("Export the hours…", Purpose::Hours, laid.is_some()),
                    ("Export the iso-hour lines…", Purpose::Lines(Lines::Hours), has_lines),
                    ("Export the outlines…", Purpose::Lines(Lines::Outlines), has_lines),
                ] {
                    let response = ui.add_enabled(is_there, egui::Button::new(name));
                    if response.on_disabled_hover_text("Find the hours of shadow first").clicked() {
                        self.ask(purpose, &context);
                    }
                }
                if ui.add_enabled(is_open, egui::Button::new("Export the animation…")).clicked() {
                    self.ask(Purpose::Animation, &context);
                }
                if ui.add_enabled(is_open, egui::Button::new("Copy the picture")).clicked() {
                    self.copy(&context);
                }
            });
            menu(ui, "Edit", |ui| {
                let [undo, redo] = self.history.has();
                let undo_text = egui::Button::new("Undo").shortcut_text(context.format_shortcut(&UNDO));
                if ui.add_enabled(undo, undo_text).clicked() {
                    let settings = self.history.undo();
                    self.set(settings);
                }
                let redo_text = egui::Button::new("Redo").shortcut_text(context.format_shortcut(&REDO));
                if ui.add_enabled(redo, redo_text).clicked() {
                    let settings = self.history.redo();
                    self.set(settings);
                }
            });
            menu(ui, "View", |ui| {
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
                let mut theme = context.options(|options| options.theme_preference);
                for (name, choice) in [
                    ("As the system", ThemePreference::System),
                    ("Light", ThemePreference::Light),
                    ("Dark", ThemePreference::Dark),
                ] {
                    if ui.radio_value(&mut theme, choice, name).clicked() {
                        context.set_theme(theme);
                    }
                }
                ui.separator();
                interface_scale(ui);
            });
            if let Some(open) = &self.open {
                ui.separator();
                let name = egui::RichText::new(open.project.name()).font(look::bold(13.5));
                ui.scope(|ui| {
                    ui.set_max_width(240.0);
                    ui.add(egui::Label::new(name).truncate());
                });
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| self.read_out(open, ui));
            }
        });
    }

    /// What lies under the pointer, and where; the less of it, the less room there is.
    fn read_out(&self, open: &Open, ui: &mut Ui) {
        let Some(under) = &open.viewer.under else { return };
        let unit = Unit::of(self.kept.feet);
        let at = (under.point / unit.metres * 10.0).round() / 10.0 + 0.0;
        let at = format!("{:.1} E  {:.1} N  {:.1} up, {}", at.x, at.y, at.z, unit.name).replace('-', "−");
        let laid = open.laid.as_ref().filter(|_| open.shows_hours);
        let hours = laid.and_then(|laid| laid.said(under, unit)).unwrap_or_default();
        let parts = [hours, under.name.clone(), at].map(|part| Some(part).filter(|part| !part.is_empty()));
        let parts: Vec<String> = parts.into_iter().flatten().collect();
        let mut texts = (1..=parts.len()).rev().map(|count| parts[..count].join("    "));
        let fits = texts.clone().find(|text| look::width_of(ui, text) < ui.available_width());
        if let Some(text) = fits.or_else(|| texts.next_back()) {
            ui.add(egui::Label::new(egui::RichText::new(text).weak()).truncate());
        }
    }

    /// What goes on, and what went wrong.
    pub(super) fn messages(&mut self, ui: &mut Ui) {
        if let Some(loading) = &self.loading
            && loading.reads
        {
            let (share, what) = loading.stage();
            let mut cancels = false;
            ui.horizontal(|ui| {
                ui.label(format!("Loading {}", loading.name));
                ui.add(egui::ProgressBar::new(share).desired_width(220.0).text(what));
                cancels = ui.button("Cancel").clicked();
            });
            if cancels {
                loading.cancel();
                // settings of the open site that were to be read are refused until they change
                self.refused = (!loading.opens).then(|| self.settings.clone());
                (self.loading, self.is_reading) = (None, false);
            }
        }
        if self.writing.as_ref().is_some_and(|writing| export::progress(writing, ui)) {
            self.writing = None;
        }
        if let Some(name) = &self.changed {
            let mut reloads = false;
            let mut leaves = false;
            ui.horizontal(|ui| {
                ui.label(format!("{name} has changed on the disk."));
                reloads = ui.button("Reload").clicked();
                leaves = ui.button("Leave it").clicked();
            });
            if reloads {
                self.reload(&ui.ctx().clone());
            }
            if leaves {
                self.changed = None;
            }
        }
        let of_view = self.open.as_ref().and_then(|open| open.viewer.fault.clone());
        let (fault, notice) = (self.fault.clone().or(of_view), self.notice.clone());
        // a grave accent would be set above the letter behind it
        if let Some(text) = fault.as_ref().or(notice.as_ref()).map(|text| text.replace('`', "")) {
            ui.horizontal(|ui| {
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                    if ui.button("Close").clicked() {
                        self.hush();
                    }
                    ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                        let colour =
                            if fault.is_some() { ui.visuals().error_fg_color } else { ui.visuals().text_color() };
                        ui.add(egui::Label::new(egui::RichText::new(text).color(colour)).wrap());
                    });
                });
            });
        }
    }

    /// Forgets what was told, as the button does.
    pub fn hush(&mut self) {
        (self.fault, self.notice) = (None, None);
        if let Some(open) = &mut self.open {
            open.viewer.fault = None;
        }
    }

    pub(super) fn has_message(&self) -> bool {
        self.fault.is_some()
            || self.notice.is_some()
            || self.writing.is_some()
            || self.changed.is_some()
            || self.loading.as_ref().is_some_and(|loading| loading.reads)
            || self.open.as_ref().is_some_and(|open| open.viewer.fault.is_some())
    }

    /// Nothing is open yet.
    pub(super) fn welcome(&mut self, ui: &mut Ui) {
        let context = ui.ctx().clone();
        ui.vertical_centered(|ui| {
            ui.add_space((ui.available_height() * 0.30).max(20.0));
            ui.label(egui::RichText::new("Gnomon").font(look::bold(34.0)).color(look::accent(ui.visuals())));
            ui.label("Where, when and for how long does this building take the sun away?");
            ui.add_space(16.0);
            if ui.button("Open a site or a model…").clicked() {
                self.ask(Purpose::Open, &context);
            }
            ui.weak("or drop sites and models on this window");
            ui.add_space(16.0);
            ui.weak("Samples");
            for name in files::SAMPLES {
                if ui.link(name).clicked() {
                    self.open_sample(name, &context);
                }
            }
        });
    }
}
