//! The part of the panel that chooses a rule and judges the site by it.

use crate::desktop::app::judge_lists;
use crate::desktop::app::menus::JUDGE;
use crate::desktop::app::panel_row::row;
use crate::desktop::app::state::App;
use crate::desktop::parts::fields::refused;
use crate::desktop::state::judging::{RuleChoice, option_label};
use crate::rules::{OptionType, OptionValue, Rule, RuleOption};
use eframe::egui::{self, Ui};

/// The section.
pub(in crate::desktop) fn show(app: &mut App, ui: &mut Ui) {
    let context = ui.ctx().clone();
    app.list_rules(false, &context);
    let lists = rules(app, ui);
    if lists {
        app.list_rules(true, &context);
    }
    judge_lists::show(app, ui);
    let goes = judge_button(app, ui);
    if goes {
        app.judge(&context);
    }
    results(app, ui);
}

/// The list of rules, what is known of the chosen one, and its options. Returns whether the list was opened.
fn rules(app: &mut App, ui: &mut Ui) -> bool {
    let Some(open) = &mut app.open else { return false };
    let desk = &mut open.judge;
    let (known, choice, is_listed) = (&desk.known, &mut desk.choice, desk.listing.is_none());
    let mut lists = false;
    row(ui, "Rule", |ui, label| {
        let named = choice.of(known).map(|rule| rule.as_ref().map_or(choice.name.clone(), titled));
        let list = egui::ComboBox::from_id_salt("rule").selected_text(named.unwrap_or_else(|| "choose one".to_owned()));
        let response = list.width(ui.available_width()).truncate().show_ui(ui, |ui| {
            for (name, rule) in known {
                match rule {
                    Ok(rule) => {
                        let entry = egui::Button::selectable(*name == choice.name, titled(rule));
                        if ui.add(entry).on_hover_text(format!("{name}\n{}", known_as(rule))).clicked() {
                            choice.take(name, rule);
                            ui.close();
                        }
                    }
                    Err(error) => {
                        let entry = ui.add_enabled(false, egui::Button::selectable(false, name));
                        entry.on_disabled_hover_text(error.to_string());
                    }
                }
            }
        });
        lists = response.response.clicked();
        response.response.labelled_by(label);
    });
    match choice.of(known) {
        Some(Ok(rule)) => {
            ui.add(egui::Label::new(egui::RichText::new(known_as(rule)).weak()).wrap());
            rule.options.iter().for_each(|option| option_row(ui, rule, option, choice));
        }
        Some(Err(error)) => refused(ui, &error.to_string()),
        None if !choice.name.is_empty() && is_listed => {
            refused(ui, &format!("the rule {} is gone; choose another one", choice.name));
        }
        None => drop(ui.weak("What an authority asks, built in or in a file beside the site.")),
    }
    lists
}

fn titled(rule: &Rule) -> String {
    format!("{}, {}", rule.source.name, rule.source.region)
}

/// How far a rule binds, its edition, and how well it is known.
fn known_as(rule: &Rule) -> String {
    let of = &rule.source;
    format!("{}: {}. Known as {}: {}.", of.kind, of.edition, of.confidence, of.confidence.meaning())
}

/// An option: a list where its values can be listed, otherwise a field.
fn option_row(ui: &mut Ui, rule: &Rule, option: &RuleOption, choice: &mut RuleChoice) {
    let value = choice.values.get(&option.name).cloned();
    let mut set = value.clone();
    let label = ui.weak(option_label(&option.name)).on_hover_text(&option.meaning).id;
    let field = option_field(ui, option, &mut set);
    field.labelled_by(label).on_hover_text(format!("{}: {}", option.meaning, option.takes()));
    match &set {
        Some(text) => {
            if let Err(error) = option.value(&rule.source.id, text) {
                refused(ui, &error.to_string());
            }
        }
        None if option.default.is_none() => refused(ui, &format!("must be chosen: {}", option.meaning)),
        None => {}
    }
    if set != value {
        match set {
            Some(text) => drop(choice.values.insert(option.name.clone(), text)),
            None => drop(choice.values.remove(&option.name)),
        }
    }
}

/// The list or the field of an option; `None` is its default, if it has one.
fn option_field(ui: &mut Ui, option: &RuleOption, set: &mut Option<String>) -> egui::Response {
    let default = option.default.as_ref().map(OptionValue::text);
    let value = set.clone();
    let chosen = listed(option);
    match chosen.is_empty() {
        false => {
            let text = |value: &str| chosen.iter().find(|(of, _)| of == value).map(|(_, text)| text.clone());
            let shown = match (&value, &default) {
                (Some(value), _) => text(value).unwrap_or_else(|| value.clone()),
                (None, Some(default)) => format!("{default} (default)"),
                (None, None) => "choose one".to_owned(),
            };
            let list = egui::ComboBox::from_id_salt(("option", &option.name)).selected_text(shown).truncate();
            let response = list.width(ui.available_width()).show_ui(ui, |ui| {
                if let Some(default) = &default {
                    ui.selectable_value(set, None, format!("{default} (default)"));
                }
                for (value, text) in &chosen {
                    ui.selectable_value(set, Some(value.clone()), text);
                }
            });
            response.response
        }
        true => {
            let mut text = value.unwrap_or_default();
            let hint = default.map_or_else(|| option.takes(), |default| format!("{default} (default)"));
            let response = ui.add(egui::TextEdit::singleline(&mut text).hint_text(hint).desired_width(f32::INFINITY));
            *set = Some(text).filter(|text| !text.trim().is_empty());
            response
        }
    }
}

/// The values of an option with their texts, if it has no others.
fn listed(option: &RuleOption) -> Vec<(String, String)> {
    let own = option.one_of.iter().map(|value| (value.text(), value.text()));
    let words = option.words.iter().map(|word| (word.clone(), word.clone()));
    let known = option.known.iter().map(|(name, value)| (name.clone(), format!("{name} ({})", value.text())));
    match option.kind {
        OptionType::Flag => ["true", "false"].map(|flag| (flag.to_owned(), flag.to_owned())).to_vec(),
        _ if option.one_of.is_empty() => Vec::new(),
        _ => own.chain(words).chain(known).collect(),
    }
}

/// The button, or how far the work is. Returns whether the button was clicked.
fn judge_button(app: &mut App, ui: &mut Ui) -> bool {
    let is_reading = app.is_reading;
    let Some(open) = &mut app.open else { return false };
    let desk = &mut open.judge;
    if let Some(judging) = &desk.judging {
        let (done, count) = judging.progress();
        let text = if count == 0 { "Preparing".to_owned() } else { format!("{done} of {count} judged") };
        ui.add(egui::ProgressBar::new(done as f32 / count.max(1) as f32).text(text));
        if ui.button("Cancel judging").clicked() {
            desk.judging = None;
        }
        return false;
    }
    let unready = desk.unready();
    let button = egui::Button::new("Judge").shortcut_text(ui.ctx().format_shortcut(&JUDGE));
    let response = ui.add_enabled(!is_reading && unready.is_none(), button);
    response.on_disabled_hover_text(unready.unwrap_or_default()).clicked()
}

/// What can be done with verdicts that are found.
fn results(app: &mut App, ui: &mut Ui) {
    let Some(open) = &mut app.open else { return };
    let desk = &mut open.judge;
    let Some(judged) = &desk.judged else { return };
    if !judged.is_asked(&open.project, &desk.choice, &desk.known) {
        ui.weak("The request has changed since: judge it again.");
    }
    ui.checkbox(&mut desk.shows, "Show the verdicts");
}
