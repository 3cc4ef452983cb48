//! A site is loaded beside the window, which shows how far it is and can give it up.

use super::bare::BareModel;
use super::settings::{Hidden, WindowSettings};
use super::words::{FileWords, PanelWords};
use crate::export::figure::component_colours;
use crate::fault;
use crate::formats::ModelReader;
use crate::mesh::Mesh;
use crate::message::Words;
use crate::shadow::ray_cast::RayCaster;
use crate::site::file::{PlaceTable, SiteFile, Text};
use crate::site::{Models, Overrides, Site, SiteError, WrittenSite};
use eframe::egui;
use std::cell::Cell;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, mpsc};

/// An open site.
pub(super) struct Project {
    /// Where its site file lies; none yet for a bare model.
    pub(super) path: Option<PathBuf>,
    /// As it is written.
    pub(super) written: WrittenSite,
    /// As it is meant.
    pub(super) site: Arc<Site>,
    /// What the picture leaves out.
    pub(super) hidden: Hidden,
    /// The site as the picture has it: what is hidden is looked through, as what does not receive is everywhere.
    pub(super) visible: Arc<Site>,
    /// Its models where they stand, whatever is asked of them.
    pub(super) models: Models,
    /// How its models are read.
    pub(super) reading: ModelReader,
    /// The colour of each component.
    pub(super) colours: Vec<[u8; 3]>,
    /// What is visible, to be asked what lies under the pointer; and whose faces those are.
    pub(super) seen: Arc<(Mesh, RayCaster)>,
}

/// What an open site is made of.
pub(super) struct LoadedSite {
    path: Option<PathBuf>,
    /// None where they are to be read anew.
    models: Option<Models>,
    visible: Arc<Site>,
    seen: Arc<(Mesh, RayCaster)>,
}

/// Why there is no project.
pub(super) enum LoadError {
    /// It is a bare model, or several.
    Bare(Vec<PathBuf>),
    /// What the command would say.
    Told(String),
}

/// What is to be loaded.
pub(super) enum LoadRequest {
    /// What somebody opens: a site, or one or more models.
    Files(Vec<PathBuf>),
    /// A bare model, where it stands.
    Placed(BareModel),
    /// What a window that has ended had open: its site file, and what was read of it.
    Left(Option<PathBuf>, Box<WrittenSite>),
    /// The open site, as it is written now, what of it is hidden, and what may still do.
    Again(Box<WrittenSite>, Hidden, Box<LoadedSite>),
}

/// Work that goes on beside the window.
pub(super) struct LoadJob {
    /// What is loaded, in a word.
    pub(super) name: String,
    /// Whether the site is opened, and not the open one read again.
    pub(super) opens: bool,
    /// Whether it takes so long that it is shown: all but the open site's settings.
    pub(super) reads: bool,
    stage: Arc<Mutex<(f32, String)>>,
    cancelled: Arc<AtomicBool>,
    result: mpsc::Receiver<Result<Project, LoadError>>,
}

impl LoadJob {
    /// Begins.
    pub(super) fn start(wanted: LoadRequest, reading: &ModelReader, context: egui::Context) -> LoadJob {
        let path = match &wanted {
            LoadRequest::Files(paths) => paths.first().cloned().unwrap_or_default(),
            LoadRequest::Placed(bare) => bare.path.clone(),
            LoadRequest::Left(_, written) | LoadRequest::Again(written, ..) => PathBuf::from(&written.file),
        };
        let (tell, result) = mpsc::channel();
        let stage = Arc::new(Mutex::new((0.0, "Reading".to_owned())));
        let cancelled = Arc::new(AtomicBool::new(false));
        let opens = !matches!(wanted, LoadRequest::Again(..));
        let reads = !matches!(&wanted, LoadRequest::Again(_, _, before) if before.models.is_some());
        let (stage_told, reading) = (Arc::clone(&stage), reading.until(&cancelled));
        let progress = LoadProgress { stage: stage_told, reading, cancelled: Arc::clone(&cancelled), context };
        std::thread::spawn(move || {
            let project = project(wanted, &progress);
            // who gave the loading up listens no more
            let _ = tell.send(project);
            progress.context.request_repaint();
        });
        LoadJob { name: name_of(&path), opens, reads, stage, cancelled, result }
    }

    /// How far it is, 0 to 1, and what is being done.
    pub(super) fn stage(&self) -> (f32, String) {
        self.stage.lock().map(|stage| stage.clone()).unwrap_or_default()
    }

    /// What came of it, once it is done.
    pub(super) fn done(&self) -> Option<Result<Project, LoadError>> {
        match self.result.try_recv() {
            Ok(result) => Some(result),
            Err(mpsc::TryRecvError::Empty) => None,
            Err(mpsc::TryRecvError::Disconnected) => {
                Some(Err(LoadError::Told(format!("{} could not be loaded: the work ended early", self.name))))
            }
        }
    }

    /// Gives it up.
    pub(super) fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }
}

struct LoadProgress {
    stage: Arc<Mutex<(f32, String)>>,
    /// Until it is cancelled.
    reading: ModelReader,
    cancelled: Arc<AtomicBool>,
    context: egui::Context,
}

impl LoadProgress {
    fn tell(&self, share: f32, what: impl Into<String>) {
        if let Ok(mut stage) = self.stage.lock() {
            *stage = (share, what.into());
        }
        self.context.request_repaint();
    }
}

/// What people call a file.
pub(super) fn name_of(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    let folder = path.parent().and_then(Path::file_name).map(|name| name.to_string_lossy().into_owned());
    match folder {
        Some(folder) if name == "site.toml" => folder,
        _ => name,
    }
}

fn project(wanted: LoadRequest, progress: &LoadProgress) -> Result<Project, LoadError> {
    let (path, written) = match wanted {
        LoadRequest::Files(paths) => {
            let path = paths.first().cloned().unwrap_or_default();
            let beside = paths.get(1..).unwrap_or_default().to_vec();
            match WrittenSite::read(&path, &Overrides { beside, ..Overrides::default() }) {
                Ok(written) if written.is_bare_model() => (None, written),
                Ok(written) => {
                    let path = if path.is_dir() { path.join("site.toml") } else { path };
                    (Some(path), written)
                }
                Err(error) => return Err(told(&error, &FileWords)),
            }
        }
        LoadRequest::Placed(bare) => {
            let (place, beside) = (Some(bare.place.clone()), bare.beside.clone());
            let asked = Overrides { place, beside, ..Overrides::default() };
            let mut written = WrittenSite::read(&bare.path, &asked).map_err(|error| told(&error, &FileWords))?;
            let north = bare.north().map_err(|error| told(&error, &FileWords))?;
            for table in &mut written.site.model {
                table.north = Some(north).filter(|north| *north != 0.0);
            }
            (None, written)
        }
        LoadRequest::Left(path, written) => (path, *written),
        // what is left out of the open site by hand is told, and not filled in
        LoadRequest::Again(written, hidden, before) => {
            return read(before.path.clone(), *written, hidden, Some(&before), progress);
        }
    };
    let mut written = written;
    complete(&mut written.site);
    read(path, written, Hidden::default(), None, progress)
}

/// The site as it is written, with what the window needs of it. What an open site has, and still does, is not made again.
fn read(
    path: Option<PathBuf>,
    mut written: WrittenSite,
    hidden: Hidden,
    before: Option<&LoadedSite>,
    progress: &LoadProgress,
) -> Result<Project, LoadError> {
    let known = before.and_then(|before| before.models.as_ref()).filter(|models| models.are_those_of(&written));
    // what is set in the panel has its labels, and what a file says its keys
    let words: &dyn Words = if before.is_some() { &PanelWords } else { &FileWords };
    let mut models = None;
    let site = Site::with_models(&written, &Overrides::default(), || {
        let read = known.map_or_else(|| read_models(&written, progress), |models| Ok(models.clone()))?;
        Ok(models.insert(read).clone())
    })
    .map_err(|error| match error {
        // a model that cannot be read is told before its place is asked
        SiteError::NoPlaceForModel { .. } => LoadError::Bare(written.model_paths()),
        error => told(&error, words),
    })?;
    if progress.cancelled.load(Ordering::Relaxed) {
        return Err(LoadError::Told("given up".to_owned()));
    }
    let site = Arc::new(site);
    let visible = visible(&site, &hidden);
    let seen = match before.filter(|_| known.is_some()) {
        Some(before) if before.visible.receives == visible.receives => Arc::clone(&before.seen),
        _ => {
            progress.tell(0.85, "Sorting what is seen");
            let seen = visible.mesh.of_components(&visible.receives);
            let reach = seen.bounds().map_or(1.0, |(low, high)| (high - low).length()) * crate::study::live::FARTHEST;
            let rays = RayCaster::new(&seen, reach);
            Arc::new((seen, rays))
        }
    };
    progress.tell(1.0, "Drawing");
    let Some(models) = models else { return Err(LoadError::Told("the models were not read".to_owned())) };
    // what a file proposes is in the panel, and is saved
    written.site.place = written.site.place.or_else(|| models.proposed_place().cloned());
    Ok(Project {
        path,
        written,
        models,
        // what is read of it later is nobody's to cancel here
        reading: progress.reading.until(&Arc::default()),
        colours: component_colours(&site.mesh, &site.casts),
        seen,
        site,
        hidden,
        visible,
    })
}

/// The site without what is hidden.
fn visible(site: &Arc<Site>, hidden: &Hidden) -> Arc<Site> {
    if hidden.is_empty() {
        return Arc::clone(site);
    }
    let components = site.mesh.components.iter().zip(&site.receives);
    let receives = components.map(|(component, receives)| *receives && !hidden.contains(&component.name)).collect();
    Arc::new(Site { receives, ..Site::clone(site) })
}

fn read_models(written: &WrittenSite, progress: &LoadProgress) -> Result<Models, SiteError> {
    progress.tell(0.15, "Reading the models");
    let count = written.site.model.len().max(1) as f32;
    let done = Cell::new(0.0);
    Models::read(written, |path, options| {
        let read = progress.reading.read(path, options)?;
        done.set(done.get() + 1.0);
        let share = done.get() / count;
        progress.tell(0.15 + 0.35 * share, if share < 1.0 { "Reading the models" } else { "Joining triangles" });
        Ok(read)
    })
}

/// What a study must say and somebody left out: the March day of most rules, nine to five. A study of several days may
/// leave its hours out.
fn complete(site: &mut SiteFile) {
    let study = &mut site.study;
    study.step.get_or_insert_with(|| "30min".to_owned());
    if study.dates.is_some() {
        return;
    }
    let from = study.from.get_or_insert_with(|| Text("9:00".to_owned()));
    let dated = from.0.contains('T') || from.0.matches('-').count() >= 2;
    if !dated {
        study.date.get_or_insert_with(|| Text("2026-03-21".to_owned()));
    }
    study.to.get_or_insert_with(|| Text("17:00".to_owned()));
}

fn told(error: &(dyn std::error::Error + 'static), words: &dyn Words) -> LoadError {
    LoadError::Told(fault::line(error, words))
}

impl Project {
    /// What of it may do for the site as it is written now; `anew` its models may not.
    pub(super) fn before(&self, anew: bool) -> LoadedSite {
        LoadedSite {
            path: self.path.clone(),
            models: (!anew).then(|| self.models.clone()),
            visible: Arc::clone(&self.visible),
            seen: Arc::clone(&self.seen),
        }
    }

    /// Its models, for a site as it is written, where they are those of that.
    pub(super) fn models_of(&self, written: &WrittenSite) -> Option<Models> {
        self.models.are_those_of(written).then(|| self.models.clone())
    }

    /// The files that it is read from, and those of the state that it is compared with.
    pub(super) fn inputs(&self, before: Option<&WrittenSite>) -> Vec<PathBuf> {
        let of_before = before.map(|before| [vec![PathBuf::from(&before.file)], before.model_files()].concat());
        let files = self.path.iter().cloned().chain(self.written.model_files());
        files.chain(of_before.unwrap_or_default()).collect()
    }

    /// Which of its files is no more what was read.
    pub(super) fn changed_file(&self) -> Option<&Path> {
        let site_file = self.path.as_deref().filter(|path| self.written.has_changed_at(path));
        self.models.changed_file().or(site_file)
    }

    /// As it is written on the disk now; the settings are those of the window where nobody has changed it there.
    ///
    /// # Errors
    /// What is wrong with its file.
    pub(super) fn on_disk(&self, now: &SiteFile) -> Result<WrittenSite, SiteError> {
        let of_window = || WrittenSite { site: now.clone(), ..self.written.clone() };
        let Some(path) = &self.path else { return Ok(of_window()) };
        let mut read = WrittenSite::read(path, &Overrides::default())?;
        if read.text == self.written.text {
            return Ok(of_window());
        }
        complete(&mut read.site);
        Ok(read)
    }

    /// The settings that it comes with.
    pub(super) fn settings(&self, before: &WindowSettings) -> WindowSettings {
        let mut shown = before.shown;
        shown.method = self.site.method;
        WindowSettings { site: self.written.site.clone(), shown, hidden: Arc::clone(&self.hidden), before: None }
    }

    /// What the site is called: its place, else its file.
    pub(super) fn name(&self) -> String {
        let named = self.written.site.place.as_ref().and_then(|place: &PlaceTable| place.name.clone());
        named.filter(|name| !name.trim().is_empty()).unwrap_or_else(|| name_of(Path::new(&self.written.file)))
    }
}
