//! Starts judging, and receives its results.

use crate::desktop::app::state::App;
use crate::desktop::parts::path_dialog::Purpose;
use crate::desktop::work::Work;
use crate::desktop::work::judging;
use eframe::egui;

impl App {
    /// Judges the open site by the chosen rule. If something has to be chosen first, the panel shows what.
    pub(in crate::desktop) fn judge(&mut self, context: &egui::Context) {
        let is_reading = self.is_reading;
        let Some(open) = &mut self.open else { return };
        let desk = &mut open.judge;
        if desk.judging.is_some() || is_reading {
            return;
        }
        if let Some(fault) = desk.unready() {
            desk.opens = true;
            self.fault = Some(fault);
            return;
        }
        (self.fault, self.notice) = (None, None);
        desk.answers += 1;
        desk.judging = Some(judging::judge(&open.project, desk.choice.clone(), desk.answers, context.clone()));
    }

    /// Lists the rules for the open site, again if its folder is another one.
    pub(in crate::desktop) fn list_rules(&mut self, is_again: bool, context: &egui::Context) {
        let Some(open) = &mut self.open else { return };
        let folder = &open.project.written.folder;
        let desk = &mut open.judge;
        if desk.listing.is_none() && (is_again || desk.listed.as_ref() != Some(folder)) {
            desk.listed = Some(folder.clone());
            desk.listing = Some(judging::rules(folder.clone(), context.clone()));
        }
    }

    /// Finds what is judged, as long as it is being edited.
    pub(in crate::desktop) fn sketch(&mut self, context: &egui::Context) {
        let is_reading = self.is_reading;
        let Some(open) = &mut self.open else { return };
        let (desk, site) = (&mut open.judge, &open.project.written.site);
        let is_found = desk.sketch.of.as_ref().is_some_and(|(number, of)| *number == open.number && of == site);
        if desk.tool.is_some() && !is_found && !is_reading && desk.sketch.work.is_none() {
            desk.sketch.of = Some((open.number, site.clone()));
            desk.sketch.work = Some(judging::sketch(&open.project, context.clone()));
        }
    }

    /// Receives lists of rules, sketches and verdicts.
    pub(in crate::desktop) fn receive_judged(&mut self) {
        let Some(open) = &mut self.open else { return };
        let desk = &mut open.judge;
        if let Some(result) = desk.listing.as_ref().and_then(Work::done) {
            desk.listing = None;
            match result {
                Ok(known) => desk.known = known,
                Err(fault) => self.fault = Some(fault),
            }
        }
        if let Some(result) = desk.sketch.work.as_ref().and_then(Work::done) {
            desk.sketch.work = None;
            desk.sketch.number += 1;
            (desk.sketch.shapes, desk.sketch.fault) = match result {
                Ok(shapes) => (shapes, None),
                Err(fault) => (Default::default(), Some(fault)),
            };
        }
        let Some(result) = desk.judging.as_ref().and_then(Work::done) else { return };
        desk.judging = None;
        match result {
            Ok(result) if result.lies_on(&open.project.site) => {
                desk.lay(result);
                (open.sunlight, open.sky) = (None, None);
            }
            Ok(_) => self.notice = Some("The model has changed since: judge it again".to_owned()),
            Err(fault) => self.fault = Some(fault),
        }
    }

    /// Asks for the folder of the verdicts' files.
    pub(in crate::desktop) fn export_verdicts(&mut self, context: &egui::Context) {
        if self.open.as_ref().is_some_and(|open| open.judge.judged.is_some()) {
            self.ask(Purpose::Verdicts, context);
        }
    }
}
