//! The window's frame: menus above, panel beside, time below, the picture in the middle.

use crate::desktop::app::cards;
use crate::desktop::app::judge_table;
use crate::desktop::app::judge_tools::{self, ToolClick};
use crate::desktop::app::judge_view;
use crate::desktop::app::panel;
use crate::desktop::app::state::{App, Open};
use crate::desktop::parts::path_dialog::{DialogAnswer, Purpose};
use crate::desktop::parts::view::ViewRequest;
use crate::desktop::parts::{screen, theme};
use crate::desktop::state::unit::Unit;
use crate::desktop::work::{samples, studies};
use crate::view::Probe;
use eframe::egui::{self, Ui};

impl eframe::App for App {
    fn logic(&mut self, context: &egui::Context, _frame: &mut eframe::Frame) {
        self.watch_closing(context);
        self.keep_unsaved(context);
    }

    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        let context = ui.ctx().clone();
        self.receive(&context);
        self.shortcuts(&context);
        self.take_dropped(&context);
        ui.painter().add(screen::ground(ui.max_rect(), ui.visuals().panel_fill));
        let on_ground = egui::Frame::side_top_panel(ui.style()).fill(egui::Color32::TRANSPARENT);
        egui::Panel::top("menus").frame(on_ground).show(ui, |ui| self.menus(ui));
        if self.has_message() {
            egui::Panel::top("messages").frame(on_ground).show(ui, |ui| {
                ui.add_space(2.0);
                self.messages(ui);
                ui.add_space(2.0);
            });
        }
        if self.open.is_none() {
            egui::CentralPanel::default().show(ui, |ui| self.welcome(ui));
        } else {
            egui::Panel::bottom("time").frame(on_ground).resizable(false).show(ui, |ui| {
                ui.add_space(4.0);
                if let Some(open) = &mut self.open {
                    open.clock.bar(ui);
                }
            });
            // the picture keeps some room
            let most = (ui.available_width() - 240.0).clamp(300.0, 460.0);
            let beside = egui::Panel::left("panel").default_size(308.0).size_range(300.0..=most).resizable(true);
            beside.frame(on_ground).show(ui, |ui| {
                // keeps the width that the user set, whatever the contents
                let rect = ui.available_rect_before_wrap();
                panel::show(self, &mut ui.new_child(egui::UiBuilder::new().max_rect(rect)));
                ui.advance_cursor_after_rect(rect);
            });
            judge_table::panel(self, ui, on_ground);
            egui::CentralPanel::no_frame().show(ui, |ui| self.view(ui));
        }
        self.ask_place(&context);
        self.ask_dropped(&context);
        self.look_for_changes(&context);
        if let Some(mut asking) = self.asking.take() {
            match asking.show(&context) {
                DialogAnswer::None => self.asking = Some(asking),
                DialogAnswer::Nothing => self.give_up_saving(),
                DialogAnswer::Path(purpose, path) => self.answer(purpose, path, &context),
            }
        }
        self.save_and_ask(&context);
        self.follow_settings(&context);
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        eframe::set_value(storage, eframe::APP_KEY, &self.kept);
    }
}

impl App {
    fn view(&mut self, ui: &mut Ui) {
        let software = self.is_software();
        let context = ui.ctx().clone();
        let Some(open) = &mut self.open else { return };
        open.clock.tick(&context);
        let shows_verdicts = open.judge.shown().is_some();
        let Open { project, number, clock, viewer, result, shows_hours, .. } = open;
        let request = ViewRequest {
            project,
            number: *number,
            choice: self.settings.shown,
            result: result.as_ref().filter(|_| *shows_hours && !shows_verdicts),
            sun_path: !self.kept.no_sun_path,
            feet: self.kept.feet,
        };
        let rect = ui.available_rect_before_wrap();
        let mut clicked = viewer.show(ui, &self.stage, software, &request, clock);
        if let Some(view) = viewer.shown().map(|shown| shown.wish.view) {
            judge_view::show(ui, open, &view, rect);
            let level = open.project.site.ground.level;
            judge_tools::draft(ui, open.judge.tool.as_ref(), &view, rect, (level, Unit::of(self.kept.feet)));
            cards::mark(ui, open, &view, rect);
            if let Some(under) = clicked.clone()
                && let Some(at) = ui.input(|input| input.pointer.interact_pos())
            {
                let is_double = ui.input(|input| input.pointer.button_double_clicked(egui::PointerButton::Primary));
                let modifiers = ui.input(|input| input.modifiers);
                if self.tool_click(&ToolClick { under, at, is_double, modifiers }, &view, rect) {
                    clicked = None;
                }
            }
        }
        let Some(open) = &mut self.open else { return };
        cards::show(ui, open, &mut self.settings, rect, Unit::of(self.kept.feet));
        if let Some(under) = clicked {
            open.clicked = Some(under.clone());
            let name = if under.name.is_empty() { "the point".to_owned() } else { under.name };
            let normal = under.normal.try_normalize();
            let probe = Probe { name, point: under.point, normal };
            open.probing = Some(studies::probe(&open.project, probe, open.clock.date(), context));
        }
    }

    /// The window while nothing is open.
    fn welcome(&mut self, ui: &mut Ui) {
        let context = ui.ctx().clone();
        ui.vertical_centered(|ui| {
            ui.add_space((ui.available_height() * 0.30).max(20.0));
            ui.label(egui::RichText::new("Gnomon").font(theme::bold(34.0)).color(theme::accent(ui.visuals())));
            ui.label("Where, when and for how long does this building take the sun away?");
            ui.add_space(16.0);
            if ui.button("Open a site or a model…").clicked() {
                self.ask(Purpose::Open, &context);
            }
            ui.weak("or drop sites and models on this window");
            ui.add_space(16.0);
            ui.weak("Samples");
            for name in samples::SAMPLES {
                if ui.link(name).clicked() {
                    self.open_sample(name, &context);
                }
            }
        });
    }
}
