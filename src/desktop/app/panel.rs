//! The panel beside the picture: shadows, hours, components, place.

use crate::choice::{Method, TABLE};
use crate::desktop::app::cards;
use crate::desktop::app::judge_desk::SECTION;
use crate::desktop::app::judge_section;
use crate::desktop::app::panel_row::row;
use crate::desktop::app::state::App;
use crate::desktop::app::study;
use crate::desktop::parts::components;
use crate::desktop::parts::fields::{NumberField, TypedText};
use crate::desktop::parts::theme;
use crate::desktop::results::StudyResult;
use crate::desktop::state::bare_model::NORTH;
use crate::desktop::state::eye::Stand;
use crate::desktop::state::technique;
use crate::desktop::state::unit::Unit;
use crate::desktop::state::words;
use crate::export::figure::{self, Diagram};
use crate::message::Message;
use crate::site::file::{ModelTable, PlaceTable, Text};
use crate::site::typed::{Axis, TypedError, clock, date, resolution, step};
use crate::site::{Ground, Mend, ModelReference};
use eframe::egui::{self, Ui};
use std::ops::RangeInclusive;

/// The range of metres per unit of a model.
const SCALE: RangeInclusive<f64> = 1e-6..=1e6;

/// A sentence on what a technique is good for.
fn good_for(method: Method) -> String {
    let text = method.row().good_for;
    let (first, rest) = text.split_at(text.chars().next().map_or(0, char::len_utf8));
    format!("{}{rest}.", first.to_uppercase())
}

/// The whole panel.
pub(in crate::desktop) fn show(app: &mut App, ui: &mut Ui) {
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        section_of_notes(app, ui);
        section(ui, "Shadows", true, |ui| shadows(app, ui));
        section(ui, "Hours of shadow", true, |ui| study(app, ui));
        if app.open.as_ref().and_then(|open| open.result.as_ref()).is_some_and(|result| result.change().is_some()) {
            section(ui, "Sun lost and gained", true, |ui| study::areas(app, ui));
        }
        judge(app, ui);
        section(ui, "Components", false, |ui| {
            if let Some(open) = &app.open {
                ui.checkbox(&mut app.settings.shown.tinted, "In their own colours");
                components::list(ui, &open.project, &mut app.settings);
            }
        });
        // already reported when the site was opened
        section(ui, "Place", true, |ui| place(app, ui));
    });
}

/// The command's notes on the models, also on those before if two states are compared, on what was found, and on what was
/// exported last; also those on the verdicts that are shown.
fn notes(app: &App) -> Vec<&Message> {
    let Some(open) = &app.open else { return Vec::new() };
    let mut notes: Vec<&Message> = open.project.site.notes.iter().collect();
    let result = open.result.as_deref();
    let before = result.and_then(StudyResult::change).map_or(&[][..], |change| change.notes_before());
    let of_result = result.map_or(&[][..], |result| &result.notes);
    let of_verdicts = open.judge.shown().map_or(&[][..], |judged| &judged.answer.notes);
    for note in before.iter().chain(of_result).chain(of_verdicts).chain(&open.export_notes) {
        if !notes.contains(&note) {
            notes.push(note);
        }
    }
    notes
}

/// The notes on the models, with buttons for the keys that would correct what looks wrong.
fn section_of_notes(app: &mut App, ui: &mut Ui) {
    let words = words::of_panel(app.settings.site.model.len());
    let notes: Vec<String> = notes(app).into_iter().map(|note| note.in_words(words)).collect();
    let Some(open) = app.open.as_ref().filter(|_| !notes.is_empty()) else { return };
    let models = &mut app.settings.site.model;
    let are_several = models.len() > 1;
    section(ui, "Notes", true, |ui| {
        for note in &notes {
            // a grave accent would be drawn above the letter after it
            ui.label(note.replace('`', ""));
        }
        for likeness in &open.project.site.likenesses {
            let Some(model) = models.get_mut(likeness.model) else { continue };
            ui.horizontal_wrapped(|ui| {
                for mend in &likeness.mends {
                    let of = model
                        .path
                        .as_deref()
                        .filter(|_| are_several)
                        .map_or(String::new(), |path| format!(" for {path}"));
                    if ui.button(format!("Set {mend}{of}")).clicked() {
                        match mend {
                            Mend::Scale(scale) => model.scale = Some(*scale),
                            Mend::Up(up) => model.up = Some(up.word().to_owned()),
                        }
                    }
                }
            });
        }
    });
}

/// The section of rules, which opens by itself where something has to be chosen.
fn judge(app: &mut App, ui: &mut Ui) {
    let opens = app.open.as_mut().is_some_and(|open| std::mem::take(&mut open.judge.opens));
    header(ui, SECTION, false, opens, |ui| judge_section::show(app, ui));
}

fn section(ui: &mut Ui, name: &str, open: bool, content: impl FnOnce(&mut Ui)) {
    header(ui, name, open, false, content);
}

/// A section, which may open now.
fn header(ui: &mut Ui, name: &str, open: bool, opens: bool, content: impl FnOnce(&mut Ui)) {
    let title = egui::RichText::new(name).font(theme::bold(13.5)).color(theme::accent(ui.visuals()));
    let header = egui::CollapsingHeader::new(title).id_salt(name).default_open(open).open(opens.then_some(true));
    header.show_unindented(ui, |ui| {
        content(ui);
        ui.add_space(8.0);
    });
}

/// The label before a second field in a row.
fn then(ui: &mut Ui, name: &str) -> egui::Id {
    ui.weak(name).id
}

fn place(app: &mut App, ui: &mut Ui) {
    let unit = Unit::of(app.kept.feet);
    let typed = &mut app.typed;
    let Some(table) = &mut app.settings.site.place else { return };
    coordinates(ui, typed, table);
    elevation(ui, typed, table, unit);
    if let Some(open) = &app.open {
        ground(ui, typed, &mut app.settings.site.ground.level, &open.project.site.ground, unit);
    }
    if let [model] = app.settings.site.model.as_mut_slice() {
        let said = app.open.as_ref().and_then(|open| open.project.models.references().first());
        placement(ui, typed, model, said);
    }
}

/// The place's name, latitude and longitude. Both angles can be typed into either field.
fn coordinates(ui: &mut Ui, typed: &mut TypedText, table: &mut PlaceTable) {
    let name = table.name.clone().unwrap_or_default();
    row(ui, "Name", |ui, label| {
        if let Some(name) = typed.text(ui, ("Name", label), &name, f32::INFINITY, |text| Ok(text.to_owned())) {
            // an empty name is no name
            table.name = Some(name).filter(|name| !name.trim().is_empty());
        }
    });
    let mut pasted = None;
    let coordinates =
        [("Latitude", &mut table.latitude, Axis::Latitude), ("Longitude", &mut table.longitude, Axis::Longitude)];
    for (name, slot, axis) in coordinates {
        let mut value = slot.unwrap_or_default();
        row(ui, name, |ui, label| {
            let (is_changed, place) = typed.degrees(ui, (name, label), &mut value, axis);
            if is_changed {
                *slot = Some(value);
            }
            pasted = pasted.or(place);
        });
        typed.show_faults(ui, &[name]);
    }
    if let Some([latitude, longitude]) = pasted {
        (table.latitude, table.longitude) = (Some(latitude), Some(longitude));
    }
}

fn elevation(ui: &mut Ui, typed: &mut TypedText, table: &mut PlaceTable, unit: Unit) {
    row(ui, "Elevation", |ui, label| {
        let mut value = table.elevation.unwrap_or_default() / unit.metres;
        let range = -500.0 / unit.metres..=9000.0 / unit.metres;
        let suffix = &format!(" {}", unit.name);
        let number = NumberField { speed: 1.0, range, unit: unit.name, suffix, decimals: 0..=2 };
        if typed.number(ui, ("Elevation", label), &mut value, &number).changed() {
            // rounded to the millimetre, since a typed foot is converted to metres
            table.elevation = Some((value * unit.metres * 1000.0).round() / 1000.0);
        }
    });
    typed.show_faults(ui, &["Elevation"]);
}

/// The rotation and the scale of a single model. The file's values are shown until others are set.
fn placement(ui: &mut Ui, typed: &mut TypedText, model: &mut ModelTable, said: Option<&ModelReference>) {
    let by_file = said.is_some_and(|said| said.said_by.is_some());
    let has_unit = said.is_some_and(|said| said.unit_is_said);
    row(ui, "Model north", |ui, label| {
        let mut north = model.north.or(said.map(|said| said.north_deg)).unwrap_or_default();
        let number = NumberField { speed: 0.5, range: NORTH, unit: "degrees", suffix: "°", decimals: 0..=3 };
        let response = typed.number(ui, ("Model north", label), &mut north, &number);
        let response = response.on_hover_text("Degrees clockwise from the model's north to true north");
        if response.changed() {
            model.north = Some(north).filter(|north| by_file || *north != 0.0);
        }
        let label = then(ui, "scale");
        let mut scale = model.scale.or(said.map(|said| said.unit_m)).unwrap_or(1.0);
        let number = NumberField { speed: 0.01, range: SCALE, unit: "metres per unit", suffix: "", decimals: 0..=6 };
        let response = typed.number(ui, ("scale", label), &mut scale, &number);
        let response = response.on_hover_text("Metres per unit of the model");
        if response.changed() {
            model.scale = Some(scale).filter(|scale| has_unit || *scale != 1.0);
        }
    });
    typed.show_faults(ui, &["Model north", "scale"]);
}

/// The ground's height, as in the site file or as it was found, and a description.
fn ground(ui: &mut Ui, typed: &mut TypedText, level: &mut Option<f64>, found: &Ground, unit: Unit) {
    row(ui, "Ground", |ui, label| {
        let mut value = level.unwrap_or(found.level) / unit.metres;
        let range = -10_000.0 / unit.metres..=10_000.0 / unit.metres;
        let suffix = &format!(" {}", unit.name);
        let number = NumberField { speed: 0.1, range, unit: unit.name, suffix, decimals: 0..=3 };
        let response = typed.number(ui, ("Ground", label), &mut value, &number);
        if response.on_hover_text("How high the ground lies above the place's point").changed() {
            // rounded to the millimetre, since a typed foot is converted to metres
            *level = Some((value * unit.metres * 1000.0).round() / 1000.0);
        }
        if level.is_some() && ui.button("Find it").on_hover_text("As the models have it").clicked() {
            *level = None;
        }
    });
    typed.show_faults(ui, &["Ground"]);
    ui.weak(format!("Ground at {}", found.said()).replace('-', "−"));
}

fn shadows(app: &mut App, ui: &mut Ui) {
    let software = app.is_software();
    let stand = app.stand();
    let shown = &mut app.settings.shown;
    row(ui, "Technique", |ui, label| {
        let list = egui::ComboBox::from_id_salt("technique").selected_text(shown.method.word());
        let response = list.width(ui.available_width()).show_ui(ui, |ui| {
            for row in TABLE {
                let entry = ui.selectable_value(&mut shown.method, row.method, row.word);
                entry.on_hover_text(good_for(row.method));
            }
        });
        response.response.labelled_by(label);
    });
    ui.weak(good_for(shown.method));
    if !technique::draws(shown.method, stand) {
        ui.weak("It does not draw this view: auto does.");
    }
    if technique::of_disc(shown.method, software).is_some() {
        ui.checkbox(&mut shown.disc, "The sun as a disc: soft edges");
    }
    if technique::counts(shown.method) {
        let name = |diagram: Option<Diagram>| match diagram {
            None => "sun and shadow",
            Some(Diagram::Mask) => "who decides a cell",
            Some(Diagram::Overdraw) => "volumes counted",
        };
        row(ui, "Picture of", |ui, label| {
            let list = egui::ComboBox::from_id_salt("diagram").selected_text(name(shown.diagram));
            let response = list.width(ui.available_width()).show_ui(ui, |ui| {
                let mut choices = vec![None, Some(Diagram::Overdraw)];
                if shown.method.row().shows_mask {
                    choices.push(Some(Diagram::Mask));
                }
                for choice in choices {
                    ui.selectable_value(&mut shown.diagram, choice, name(choice));
                }
            });
            response.response.labelled_by(label);
        });
    }
    if stand == Stand::Perspective {
        ui.horizontal(|ui| {
            ui.checkbox(&mut shown.volumes, "Volumes");
            ui.checkbox(&mut shown.silhouette, "Silhouette");
        });
    }
    if let Some(colours) = app.legend() {
        ui.add_space(2.0);
        ui.label(&colours.legend_head);
        for (colour, what) in &colours.legend {
            cards::swatch(ui, *colour, what);
        }
    }
}

fn study(app: &mut App, ui: &mut Ui) {
    let shown_date = app.open.as_ref().map(|open| open.clock.date());
    let study = &mut app.settings.site.study;
    // the loader reports missing values; `from` may include the date
    let said = |slot: &Option<Text>| slot.as_ref().map_or(String::new(), |text| text.0.clone());
    let typed = &mut app.typed;
    row(ui, "Window", |ui, label| {
        ui.spacing_mut().item_spacing.x = 5.0;
        if let Some(from) = typed.text(ui, ("From", label), &said(&study.from), 70.0, empty_or(clock)) {
            study.from = from.map(Text);
        }
        let label = then(ui, "to");
        if let Some(to) = typed.text(ui, ("To", label), &said(&study.to), 70.0, empty_or(clock)) {
            study.to = to.map(Text);
        }
    });
    typed.show_faults(ui, &["From", "To"]);
    let day = |text: &str| date(text).map(|date| date.to_string());
    let step_said = study.step.clone().unwrap_or_default();
    if let Some([Text(first), Text(last)]) = &mut study.dates {
        row(ui, "Study days", |ui, label| {
            ui.spacing_mut().item_spacing.x = 5.0;
            if let Some(read) = typed.text(ui, ("First day", label), first, 82.0, day) {
                *first = read;
            }
            let label = then(ui, "to");
            if let Some(read) = typed.text(ui, ("Last day", label), last, 82.0, day) {
                *last = read;
            }
        });
        typed.show_faults(ui, &["First day", "Last day"]);
        row(ui, "Step", |ui, label| {
            if let Some(step) = typed.text(ui, ("Step", label), &step_said, 58.0, empty_or(step)) {
                study.step = step;
            }
        });
    } else {
        row(ui, "Study date", |ui, label| {
            ui.spacing_mut().item_spacing.x = 5.0;
            if let Some(date) = typed.text(ui, ("Study date", label), &said(&study.date), 94.0, empty_or(day)) {
                study.date = date.map(Text);
            }
            let label = then(ui, "step");
            if let Some(step) = typed.text(ui, ("Step", label), &step_said, 58.0, empty_or(step)) {
                study.step = step;
            }
        });
        typed.show_faults(ui, &["Study date"]);
    }
    typed.show_faults(ui, &["Step"]);
    let found = app.open.as_ref().map(|open| open.project.site.track.resolution_secs);
    times_of_change(ui, typed, &mut study.resolution, found);
    if let (Some(date), Some(Text(text))) = (shown_date, &mut study.date)
        && date.to_string() != *text
        && ui.button(format!("Take {date} from the clock")).clicked()
    {
        *text = date.to_string();
    }
    study::show(app, ui);
}

/// The precision of times of change: the site file's, otherwise the default.
fn times_of_change(ui: &mut Ui, typed: &mut TypedText, written: &mut Option<String>, found_secs: Option<u32>) {
    let said = written.clone().unwrap_or_default();
    row(ui, "Resolution", |ui, label| {
        if let Some(read) = typed.text(ui, ("Resolution", label), &said, 58.0, empty_or(resolution)) {
            *written = read;
        }
        match found_secs {
            Some(0) => drop(ui.weak("the instants alone")),
            Some(secs) => drop(ui.weak(format!("found to {}", figure::duration(secs)))),
            None => {}
        }
    });
    typed.show_faults(ui, &["Resolution"]);
}

/// An empty text removes the value.
fn empty_or<T>(read: impl FnOnce(&str) -> Result<T, TypedError>) -> impl FnOnce(&str) -> Result<Option<T>, TypedError> {
    move |text: &str| if text.trim().is_empty() { Ok(None) } else { read(text).map(Some) }
}
