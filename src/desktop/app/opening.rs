//! Opens a site, and reads the open one again when its settings have changed.

use crate::desktop::app::judge_desk::JudgeDesk;
use crate::desktop::app::state::{App, Open};
use crate::desktop::parts::fields::TypedText;
use crate::desktop::parts::view::Viewer;
use crate::desktop::state::clock::Clock;
use crate::desktop::state::project::Project;
use crate::desktop::state::settings::WindowSettings;
use crate::desktop::work::loading::{LoadJob, LoadRequest};
use crate::desktop::work::samples;
use crate::site::file::{PlaceTable, SiteFile};
use crate::sun::{Instant, SunTrack};
use eframe::egui;
use std::sync::Arc;

impl App {
    pub(in crate::desktop) fn open_sample(&mut self, name: &str, context: &egui::Context) {
        match samples::sample(name) {
            Ok(path) => self.load(LoadRequest::Files(vec![path]), context),
            Err(error) => self.fault = Some(error.to_string()),
        }
    }

    /// Shows a loaded site: a new one, or the open one with changed settings.
    pub(in crate::desktop) fn take(&mut self, project: Project, opens: bool) {
        self.loaded += 1;
        self.refused = None;
        self.changed = self.changed.take().filter(|_| project.changed_file().is_some());
        let Some(middle) = middle_of(&project.site.track) else { return };
        match &mut self.open {
            Some(open) if !opens => {
                self.fault = None;
                let place = project.written.site.place.clone();
                open.change_to(project, &middle, self.loaded);
                self.set_proposed_place(place.as_ref());
            }
            _ => self.open_project(project, &middle),
        }
    }

    /// Lets a model's file propose the place of a site file that was read again, as when it is opened. The proposed
    /// place becomes part of the settings, counts as saved, and stays after undo.
    fn set_proposed_place(&mut self, place: Option<&PlaceTable>) {
        let propose = |site: &mut SiteFile| {
            place.iter().for_each(|place| site.place.get_or_insert_default().complete_with(place));
        };
        propose(&mut self.settings.site);
        self.history.change_all(propose);
        if let Some((site, _)) = &mut self.saving.saved {
            propose(site);
        }
    }

    fn open_project(&mut self, mut project: Project, middle: &Instant) {
        let beside = std::mem::take(&mut project.beside);
        if let Some(path) = &project.path {
            self.kept.recent.retain(|recent| recent != path);
            self.kept.recent.insert(0, path.clone());
            self.kept.recent.truncate(8);
        }
        self.settings = project.settings(&self.settings);
        self.typed = TypedText::default();
        self.history.restart(&self.settings);
        self.open = Some(Open {
            clock: Clock::new(&project.site.place, project.site.track.refraction, middle),
            viewer: Viewer::new(&project),
            number: self.loaded,
            answers: 0,
            adding: None,
            result: None,
            shows_hours: false,
            before: None,
            probing: None,
            sunlight: None,
            sky: None,
            export_notes: Vec::new(),
            clicked: None,
            judge: JudgeDesk::default(),
            project,
        });
        self.note_saved();
        self.set_recovered();
        // what is added is not saved, and can be undone
        self.add_models(&beside);
    }

    /// Reads the site again if its settings have changed, once the mouse button is released.
    pub(in crate::desktop) fn follow_settings(&mut self, context: &egui::Context) {
        let rests = !context.input(|input| input.pointer.any_down());
        if rests {
            self.history.note(&self.settings);
        }
        let Some(open) = &self.open else { return };
        let project = &open.project;
        let changed = project.written.site != self.settings.site || project.hidden != self.settings.hidden;
        let is_past = |refused: &WindowSettings| !changed && refused.site != self.settings.site;
        if self.refused.take_if(|refused| is_past(refused)).is_some() {
            // requesting the open site again clears the error
            self.fault = None;
        }
        let is_refused = self.refused.as_ref().is_some_and(|refused| refused.site == self.settings.site);
        if changed && rests && !is_refused && self.loading.is_none() {
            let mut written = project.written.clone();
            written.site = self.settings.site.clone();
            let hidden = Arc::clone(&self.settings.hidden);
            let wanted = LoadRequest::Again(Box::new(written), hidden, Box::new(project.loaded(false)));
            self.loading = Some(LoadJob::start(wanted, &self.reading, context.clone()));
            self.is_reading = true;
        }
    }
}

/// The instant at which the clock starts.
fn middle_of(track: &SunTrack) -> Option<Instant> {
    track.instants.get(track.instants.len() / 2).cloned()
}

impl Open {
    /// Replaces the open site by the one with changed settings.
    fn change_to(&mut self, project: Project, middle: &Instant, number: u64) {
        let refraction = project.site.track.refraction;
        if !self.clock.is_at(&project.site.place, refraction) {
            let mut clock = Clock::new(&project.site.place, refraction, middle);
            let local = self.clock.now.time.naive_local();
            clock.set_date(local.date());
            clock.set_secs(f64::from(chrono::Timelike::num_seconds_from_midnight(&local)));
            self.clock = clock;
        }
        let grown = length(&project) / length(&self.project);
        let (then, now) = (&self.project.written.site, &project.written.site);
        let is_rebuilt = self.project.models.mark() != project.models.mark();
        if is_rebuilt || then.model != now.model || then.ground != now.ground || then.place != now.place {
            // results for a point belong to the old scene
            (self.sunlight, self.sky, self.probing, self.clicked) = (None, None, None, None);
        }
        (self.project, self.number) = (project, number);
        self.export_notes.clear();
        self.result = self.result.take().filter(|result| result.lies_on(&self.project.site));
        self.judge.judged = self.judge.judged.take().filter(|judged| judged.lies_on(&self.project.site));
        // after a change of scale the eye could be inside the model, or far away
        if !(0.5..=2.0).contains(&grown) {
            self.viewer.fit_all(&self.project);
        }
    }
}

/// The length of the models' diagonal, metres.
fn length(project: &Project) -> f64 {
    project.site.mesh.bounds_at_home().map_or(1.0, |(low, high)| (high - low).length().max(1e-6))
}
