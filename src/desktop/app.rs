//! The window's state, and its frame: menus above, panel beside, time below, the picture in the middle.

use super::bare::BareModel;
use super::change::BeforeState;
use super::clock::Clock;
use super::eye::Stand;
use super::files::{self, DialogAnswer, PathDialog};
use super::hours::{self, StudyResult};
use super::loading::{LoadError, LoadJob, LoadRequest, Project};
use super::pick::PickedPoint;
use super::reopening::devices;
use super::saving::{PendingAction, SaveState};
use super::settings::{History, WindowSettings};
use super::stage::Stage;
use super::typed::TypedText;
use super::unit::Unit;
use super::view::{ViewRequest, Viewer};
use super::work::Work;
use super::{cards, look, panel, screen};
use crate::export::figure::Colours;
use crate::formats::ModelReader;
use crate::gpu::Gpu;
use crate::profile::probe::Sunlight;
use crate::view::Probe;
use eframe::egui::{self, Ui};
use eframe::egui_wgpu::RenderState;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What is kept from one start to the next.
#[derive(Default, Serialize, Deserialize)]
pub(super) struct PersistentState {
    pub(super) recent: Vec<PathBuf>,
    pub(super) feet: bool,
    pub(super) no_sun_path: bool,
}

/// An open site, and what is found of it.
pub(super) struct Open {
    /// The site.
    pub(super) project: Project,
    number: u64,
    /// The instant that is shown.
    pub(super) clock: Clock,
    pub(super) viewer: Viewer,
    /// How many times hours were asked for.
    pub(super) answers: u64,
    /// The hours that are being added up.
    pub(super) adding: Option<Work<StudyResult>>,
    /// The hours that were found, or the change.
    pub(super) laid: Option<Arc<StudyResult>>,
    /// Whether they lie over the model, instead of one instant: a matter of looking, which undo leaves alone.
    pub(super) shows_hours: bool,
    /// The state that was kept to be compared with.
    pub(super) known: Option<BeforeState>,
    /// The point that is being searched.
    pub(super) probing: Option<Work<Sunlight>>,
    /// When a point lies in the sun.
    pub(super) sunlight: Option<Sunlight>,
    /// What was clicked for it.
    pub(super) clicked: Option<PickedPoint>,
}

/// The window.
pub struct App {
    /// The window's own device, on which nothing but its frames is drawn.
    pub(super) gpu: Gpu,
    pub(super) render: RenderState,
    pub(super) stage: Stage,
    pub(super) kept: PersistentState,
    /// The open site.
    pub(super) open: Option<Open>,
    /// What a person sets.
    pub(super) settings: WindowSettings,
    pub(super) history: History,
    pub(super) loading: Option<LoadJob>,
    loaded: u64,
    /// The site is being read again, as its settings have changed.
    pub(super) is_reading: bool,
    /// Settings of which it is known that no site comes of them.
    pub(super) refused: Option<WindowSettings>,
    pub(super) bare: Option<BareModel>,
    /// Models that were dropped on the open site, until it is answered what becomes of them.
    pub(super) dropped: Vec<PathBuf>,
    /// How model files are read.
    pub(super) reading: ModelReader,
    pub(super) asking: Option<PathDialog>,
    pub(super) writing: Option<Work<PathBuf>>,
    /// What is typed into the panel's fields.
    pub(super) typed: TypedText,
    /// What is saved, and what is asked about what is not.
    pub(super) saving: SaveState,
    /// What went wrong, as the command would say it.
    pub(super) fault: Option<String>,
    /// What was done.
    pub(super) notice: Option<String>,
    /// Where studies are kept that are stopped; nowhere without one.
    pub(super) studies: Option<PathBuf>,
    /// A file of the open site that is no more what was read.
    pub(super) changed: Option<String>,
    /// Whether the window had the focus at the last frame.
    pub(super) had_focus: bool,
}

impl App {
    /// A window on eframe's device, with a site or a model in it where one is named. Models are read in this process.
    ///
    /// # Errors
    /// Where eframe has no device.
    pub fn new(
        cc: &eframe::CreationContext<'_>,
        path: Option<&Path>,
    ) -> Result<App, Box<dyn std::error::Error + Send + Sync>> {
        Self::reading(cc, path, ModelReader::default())
    }

    /// The same, with another way to read models.
    pub(super) fn reading(
        cc: &eframe::CreationContext<'_>,
        path: Option<&Path>,
        reading: ModelReader,
    ) -> Result<App, Box<dyn std::error::Error + Send + Sync>> {
        look::set(&cc.egui_ctx);
        let (gpu, render, stage) = devices(cc)?;
        let kept = cc.storage.and_then(|storage| eframe::get_value(storage, eframe::APP_KEY)).unwrap_or_default();
        let mut app = App {
            gpu,
            render,
            stage,
            kept,
            open: None,
            settings: WindowSettings::default(),
            history: History::default(),
            loading: None,
            loaded: 0,
            is_reading: false,
            refused: None,
            bare: None,
            dropped: Vec::new(),
            reading,
            asking: None,
            writing: None,
            typed: TypedText::default(),
            saving: SaveState::default(),
            fault: None,
            notice: None,
            studies: None,
            changed: None,
            had_focus: true,
        };
        if let Some(path) = path {
            app.load(LoadRequest::Files(vec![path.to_owned()]), &cc.egui_ctx);
        }
        Ok(app)
    }

    /// Whether pictures are drawn by a program on the processor.
    pub(super) fn is_software(&self) -> bool {
        self.stage.is_software()
    }

    /// From where one looks.
    pub(super) fn stand(&self) -> Stand {
        self.open.as_ref().map_or(Stand::Perspective, |open| open.viewer.eye.stand)
    }

    /// What the colours of the shown diagram mean.
    pub(super) fn legend(&self) -> Option<&Colours> {
        self.open.as_ref()?.viewer.shown()?.legend.as_ref()
    }

    /// Whether nothing is on its way: no site, no picture, no hours.
    pub fn is_settled(&self) -> bool {
        let open = self.open.as_ref();
        self.loading.is_none()
            && self.writing.is_none()
            && !self.stage.is_busy()
            && open.is_none_or(|open| open.adding.is_none() && open.probing.is_none() && open.viewer.is_settled())
    }

    /// Whether hours are being added up.
    pub fn is_adding(&self) -> bool {
        self.open.as_ref().is_some_and(|open| open.adding.is_some())
    }

    /// What went wrong, and what else is told.
    pub fn told(&self) -> [Option<&str>; 2] {
        let of_picture = self.open.as_ref().and_then(|open| open.viewer.fault.as_deref());
        [self.fault.as_deref().or(of_picture), self.notice.as_deref()]
    }

    /// Whether a picture is being drawn.
    pub fn is_drawing(&self) -> bool {
        self.stage.is_busy()
    }

    pub(super) fn load(&mut self, wanted: LoadRequest, context: &egui::Context) {
        if let Some(loading) = self.loading.take() {
            loading.cancel();
        }
        (self.fault, self.notice, self.bare) = (None, None, None);
        self.dropped.clear();
        self.saving.recovery.let_go();
        self.loading = Some(LoadJob::start(wanted, &self.reading, context.clone()));
    }

    pub(super) fn open_sample(&mut self, name: &str, context: &egui::Context) {
        match files::sample(name) {
            Ok(path) => self.load(LoadRequest::Files(vec![path]), context),
            Err(error) => self.fault = Some(error.to_string()),
        }
    }

    /// Takes what the work beside the window has come to.
    fn receive(&mut self, context: &egui::Context) {
        let open = self.open.as_ref();
        let notes = [
            self.stage.note(),
            self.writing.as_ref().and_then(Work::note),
            open.and_then(|open| open.adding.as_ref()).and_then(Work::note),
            open.and_then(|open| open.probing.as_ref()).and_then(Work::note),
        ];
        if let Some(note) = notes.into_iter().flatten().next() {
            self.notice = Some(note);
        }
        if let Some(result) = self.loading.as_ref().and_then(LoadJob::done) {
            let opens = self.loading.take().is_none_or(|loading| loading.opens);
            self.is_reading = false;
            match result {
                Ok(project) if opens => self.go_on_or_ask(PendingAction::Open(Box::new(project)), context),
                Ok(project) => self.take(project, false),
                Err(LoadError::Bare(paths)) => self.bare = Some(BareModel::new(paths)),
                Err(LoadError::Told(fault)) => {
                    self.fault = Some(fault);
                    if !opens {
                        self.refused = Some(self.settings.clone());
                    }
                }
            }
        }
        if let Some(result) = self.writing.as_ref().and_then(Work::done) {
            self.writing = None;
            match result {
                Ok(path) => self.notice = Some(format!("Written: {}", path.display())),
                Err(fault) => self.fault = Some(fault),
            }
        }
        let Some(open) = &mut self.open else { return };
        open.viewer.receive(&self.stage, &self.render);
        if let Some(result) = open.adding.as_ref().and_then(Work::done) {
            open.adding = None;
            match result {
                // colours of faces are those of the very model that they were found on
                Ok(laid) if !laid.lies_on(&open.project.site) => {
                    self.notice = Some("The model has changed since: find the hours anew".to_owned());
                }
                Ok(laid) => {
                    if let Some(change) = laid.change() {
                        let before = Arc::clone(&change.before);
                        if open.known.as_ref().is_none_or(|known| known.before != before || known.laid.is_none()) {
                            let models = change.models.clone();
                            open.known = Some(BeforeState { before: Arc::clone(&before), models, laid: None });
                        }
                        self.settings.before = Some(before);
                    }
                    open.laid = Some(Arc::new(laid));
                    open.shows_hours = true;
                }
                Err(fault) => self.fault = Some(fault),
            }
        }
        if let Some(result) = open.probing.as_ref().and_then(Work::done) {
            open.probing = None;
            match result {
                Ok(sunlight) => open.sunlight = Some(sunlight),
                Err(fault) => self.fault = Some(fault),
            }
        }
    }

    /// Shows a site that was loaded: another one, or the open one as it is written now.
    pub(super) fn take(&mut self, project: Project, opens: bool) {
        self.loaded += 1;
        self.refused = None;
        self.changed = self.changed.take().filter(|_| project.changed_file().is_some());
        let track = &project.site.track;
        let Some(middle) = track.instants.get(track.instants.len() / 2) else { return };
        match &mut self.open {
            Some(open) if !opens => {
                self.fault = None;
                if !open.clock.is_at(&project.site.place, track.refraction) {
                    let mut clock = Clock::new(&project.site.place, track.refraction, middle);
                    let local = open.clock.now.time.naive_local();
                    clock.set_date(local.date());
                    clock.set_secs(f64::from(chrono::Timelike::num_seconds_from_midnight(&local)));
                    open.clock = clock;
                }
                let length = |project: &Project| {
                    project.site.mesh.bounds_at_home().map_or(1.0, |(low, high)| (high - low).length().max(1e-6))
                };
                let grown = length(&project) / length(&open.project);
                let (then, now) = (&open.project.written.site, &project.written.site);
                let is_rebuilt = open.project.models.mark() != project.models.mark();
                if is_rebuilt || then.model != now.model || then.ground != now.ground || then.place != now.place {
                    // what was found of a point was found of another scene
                    (open.sunlight, open.probing, open.clicked) = (None, None, None);
                }
                (open.project, open.number) = (project, self.loaded);
                open.laid = open.laid.take().filter(|laid| laid.lies_on(&open.project.site));
                // another scale would leave the eye inside the model, or out of sight of it
                if !(0.5..=2.0).contains(&grown) {
                    open.viewer.fit_all(&open.project);
                }
            }
            _ => {
                if let Some(path) = &project.path {
                    self.kept.recent.retain(|recent| recent != path);
                    self.kept.recent.insert(0, path.clone());
                    self.kept.recent.truncate(8);
                }
                self.settings = project.settings(&self.settings);
                self.typed = TypedText::default();
                self.history.restart(&self.settings);
                let clock = Clock::new(&project.site.place, track.refraction, middle);
                self.open = Some(Open {
                    clock,
                    viewer: Viewer::new(&project),
                    number: self.loaded,
                    answers: 0,
                    adding: None,
                    laid: None,
                    shows_hours: false,
                    known: None,
                    probing: None,
                    sunlight: None,
                    clicked: None,
                    project,
                });
                self.note_saved();
                self.set_recovered();
            }
        }
    }

    /// Reads the site again where its settings have changed, once the hand rests.
    fn follow_settings(&mut self, context: &egui::Context) {
        let rests = !context.input(|input| input.pointer.any_down());
        if rests {
            self.history.note(&self.settings);
        }
        let Some(open) = &self.open else { return };
        let project = &open.project;
        let changed = project.written.site != self.settings.site || project.hidden != self.settings.hidden;
        let is_past = |refused: &WindowSettings| !changed && refused.site != self.settings.site;
        if self.refused.take_if(|refused| is_past(refused)).is_some() {
            // the open site is asked for again
            self.fault = None;
        }
        let is_refused = self.refused.as_ref().is_some_and(|refused| refused.site == self.settings.site);
        if changed && rests && !is_refused && self.loading.is_none() {
            let mut written = project.written.clone();
            written.site = self.settings.site.clone();
            let hidden = Arc::clone(&self.settings.hidden);
            let wanted = LoadRequest::Again(Box::new(written), hidden, Box::new(project.before(false)));
            self.loading = Some(LoadJob::start(wanted, &self.reading, context.clone()));
            self.is_reading = true;
        }
    }

    pub(super) fn set(&mut self, settings: Option<WindowSettings>) {
        if let Some(settings) = settings {
            if let Some(open) = self.open.as_mut().filter(|_| settings.before != self.settings.before) {
                // what it would bring is undone
                open.adding = None;
            }
            self.settings = settings;
            (self.refused, self.fault) = (None, None);
        }
    }
}

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
                // as wide as it was made by hand, whatever stands in it
                let rect = ui.available_rect_before_wrap();
                panel::show(self, &mut ui.new_child(egui::UiBuilder::new().max_rect(rect)));
                ui.advance_cursor_after_rect(rect);
            });
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
        let Open { project, number, clock, viewer, laid, shows_hours, .. } = open;
        let asked = ViewRequest {
            project,
            number: *number,
            choice: self.settings.shown,
            laid: laid.as_ref().filter(|_| *shows_hours),
            sun_path: !self.kept.no_sun_path,
            feet: self.kept.feet,
        };
        let rect = ui.available_rect_before_wrap();
        let clicked = viewer.show(ui, &self.stage, software, &asked, clock);
        if let Some(view) = viewer.shown().map(|shown| shown.wish.view) {
            cards::mark(ui, open, &view, rect);
        }
        cards::show(ui, open, &mut self.settings, rect, Unit::of(self.kept.feet));
        if let Some(under) = clicked {
            open.clicked = Some(under.clone());
            let name = if under.name.is_empty() { "the point".to_owned() } else { under.name };
            let normal = under.normal.try_normalize();
            let probe = Probe { name, point: under.point, normal };
            open.probing = Some(hours::probe(&open.project, probe, open.clock.date(), context));
        }
    }
}
