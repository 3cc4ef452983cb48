//! The card of a line of the table: its verdict, the strip of its day, and who takes the sun.

use crate::desktop::app::state::Open;
use crate::desktop::parts::day_strip;
use crate::desktop::parts::theme;
use crate::desktop::parts::verdict;
use crate::desktop::results::judged::{JudgedLine, JudgedResult, LineOf};
use crate::export::judgement::{BarKind, DayStrip, TakerRow, day_strips, receiver_row, taker_row};
use crate::judgement::ReceiverRuling;
use eframe::egui::{self, RichText, Ui};

/// The most members of a group that are listed.
const MOST_MEMBERS: usize = 100;

/// What was done on the card.
pub(in crate::desktop) enum CardAction {
    Close,
    /// Another line is chosen.
    Choose(LineOf),
}

/// The card of the chosen line, in which `scrolled` holds what may be long.
pub(in crate::desktop) fn show(ui: &mut Ui, open: &mut Open, below: f32) -> Option<CardAction> {
    let (judged, of) = open.judge.chosen().map(|(judged, of)| (judged.clone(), of))?;
    let line = judged.lines.iter().find(|line| line.of == of)?;
    let mut action = None;
    ui.label(RichText::new(&line.name).font(theme::bold(13.5)));
    let most = (ui.available_height() - below).max(24.0);
    let area = egui::ScrollArea::vertical().id_salt("verdict").max_height(most).min_scrolled_height(24.0);
    area.auto_shrink(true).show(ui, |ui| {
        ui.set_width(ui.available_width());
        said(ui, line);
        match of {
            LineOf::Receiver(at) => {
                if let Some(receiver) = judged.judgement().receivers.get(at) {
                    of_receiver(ui, &judged, receiver, &mut open.judge.table.day);
                }
            }
            LineOf::Group(_) => action = members(ui, &judged, of),
        }
    });
    if ui.button("Close the card").clicked() {
        action = Some(CardAction::Close);
    }
    action
}

/// The verdict with its numbers.
fn said(ui: &mut Ui, line: &JudgedLine) {
    ui.horizontal(|ui| {
        verdict::swatch(ui, line.verdict);
        ui.label(format!("It {}", verdict::word(line.verdict)));
    });
    if !line.value.is_empty() {
        let is_said = |text: &str| !text.is_empty() && text != "-";
        let limit = if is_said(&line.limit) { format!(", limit {}", line.limit) } else { String::new() };
        let margin = if is_said(&line.margin) { format!(", margin {}", line.margin) } else { String::new() };
        ui.label(format!("{}{limit}{margin}", line.value));
    }
}

fn of_receiver(ui: &mut Ui, judged: &JudgedResult, receiver: &ReceiverRuling, day: &mut usize) {
    let row = receiver_row(judged.judgement(), receiver);
    if row.before != "-" {
        ui.label(format!("before: {}", row.before));
    }
    if let Some(why) = row.excuse {
        ui.label(format!("accepted: {why}"));
    }
    let strips = day_strips(judged.judgement(), &judged.site, receiver);
    *day = (*day).min(strips.len().saturating_sub(1));
    if let Some(strip) = strips.get(*day) {
        days(ui, &strips, day);
        let where_of = if receiver.area.is_some() { "At the spot that decides" } else { "At the point that decides" };
        ui.weak(format!("{where_of}, {}", row.at).replace('-', "−"));
        day_strip::show(ui, strip);
        let lit = strip.bars.iter().filter(|bar| matches!(bar.kind, BarKind::Now | BarKind::Before));
        for bar in lit {
            ui.label(RichText::new(bar.kind.label()).strong());
            if bar.spells.is_empty() {
                ui.weak("none");
            }
            day_strip::spells(ui, bar);
        }
    }
    takers(ui, judged, receiver);
}

/// The day of the strip, and the others that are known.
fn days(ui: &mut Ui, strips: &[DayStrip], day: &mut usize) {
    let name = |at: usize| format!("{}{}", strips[at].date, if at == 0 { ", which decides" } else { "" });
    if strips.len() < 2 {
        ui.label(name(*day));
        return;
    }
    ui.horizontal(|ui| {
        let label = ui.weak("Day").id;
        let list = egui::ComboBox::from_id_salt("day of the strip").selected_text(name(*day));
        let response = list.show_ui(ui, |ui| {
            for at in 0..strips.len() {
                ui.selectable_value(day, at, name(at));
            }
        });
        response.response.labelled_by(label);
    });
}

/// Who takes the sun on the deciding day.
fn takers(ui: &mut Ui, judged: &JudgedResult, receiver: &ReceiverRuling) {
    if receiver.takers.is_empty() {
        return;
    }
    ui.label(RichText::new("Who takes the sun, alone and with others").strong());
    for taker in &receiver.takers {
        let TakerRow { name, alone, with_others } = taker_row(&judged.site, taker);
        ui.label(format!("{name}: {alone} (+ {with_others})"));
    }
}

/// The receivers of a group, as links.
fn members(ui: &mut Ui, judged: &JudgedResult, of: LineOf) -> Option<CardAction> {
    let (mut chosen, all) = (None, judged.receivers_of(of));
    for at in all.iter().copied().take(MOST_MEMBERS) {
        let Some(line) = judged.lines.iter().find(|line| line.of == LineOf::Receiver(at)) else { continue };
        ui.horizontal(|ui| {
            verdict::swatch(ui, line.verdict);
            if ui.link(format!("{}: {}", line.name, line.value)).clicked() {
                chosen = Some(CardAction::Choose(line.of));
            }
        });
    }
    if all.len() > MOST_MEMBERS {
        ui.weak(format!("and {} more, in the table", all.len() - MOST_MEMBERS));
    }
    chosen
}
