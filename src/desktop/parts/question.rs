//! Asks before something would be lost.

use crate::desktop::parts::theme;
use eframe::egui::{self, RichText};

/// A question and its answers. The last answer, also given by Escape, changes nothing.
pub(in crate::desktop) struct Question<'a, const N: usize> {
    /// What it is about.
    pub(in crate::desktop) heading: &'a str,
    /// What would happen.
    pub(in crate::desktop) text: &'a str,
    /// The full path that it is about, if that helps.
    pub(in crate::desktop) path: &'a str,
    /// The possible answers.
    pub(in crate::desktop) answers: [&'a str; N],
    /// The index of the answer that Enter gives.
    pub(in crate::desktop) first: usize,
}

impl<const N: usize> Question<'_, N> {
    /// Shows the question. Returns the answer that was given.
    pub(in crate::desktop) fn show(&self, context: &egui::Context) -> Option<usize> {
        let mut given = None;
        let modal = theme::modal(context, self.heading).show(context, |ui| {
            ui.set_width(440.0);
            ui.heading(self.heading);
            ui.add_space(4.0);
            ui.add(egui::Label::new(self.text).wrap());
            if !self.path.is_empty() {
                ui.add(egui::Label::new(RichText::new(self.path).weak()).wrap());
            }
            ui.add_space(8.0);
            ui.horizontal(|ui| {
                let is_fresh = ui.memory(|memory| memory.focused().is_none());
                for (index, answer) in self.answers.into_iter().enumerate() {
                    let response = ui.button(answer);
                    if is_fresh && index == self.first {
                        response.request_focus();
                    }
                    if response.clicked() {
                        given = Some(index);
                    }
                }
            });
        });
        given.or(modal.should_close().then_some(N - 1))
    }
}
