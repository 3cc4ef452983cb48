//! Loads a site in a thread of its own; the window shows the progress and can cancel it.

use crate::desktop::state::bare_model::BareModel;
use crate::desktop::state::project::{LoadedSite, Project, complete, name_of};
use crate::desktop::state::settings::Hidden;
use crate::desktop::state::words::{self, FileWords};
use crate::export::bytes;
use crate::export::figure::component_colours;
use crate::fault;
use crate::formats::{ModelReader, is_model};
use crate::message::Words;
use crate::shadow::FlushFaces;
use crate::shadow::ray_cast::RayCaster;
use crate::site::{Models, Overrides, Site, SiteError, WrittenSite};
use eframe::egui;
use std::cell::Cell;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, mpsc};
use std::time::{Duration, Instant};

/// Why there is no project.
pub(in crate::desktop) enum LoadError {
    /// The files are a bare model, or several.
    Bare(Vec<PathBuf>),
    /// A message, as the command would print it.
    Message(String),
}

/// What is to be loaded.
pub(in crate::desktop) enum LoadRequest {
    /// What somebody opens: a site, or one or more models.
    Files(Vec<PathBuf>),
    /// A bare model, where it stands.
    Placed(BareModel),
    /// The site file of a window that has ended, and what was read of it.
    Left(Option<PathBuf>, Box<WrittenSite>),
    /// The open site as it is written now, what of it is hidden, and what can be used again.
    Again(Box<WrittenSite>, Hidden, Box<LoadedSite>),
}

/// Work that goes on beside the window.
pub(in crate::desktop) struct LoadJob {
    /// What is loaded, in a word.
    pub(in crate::desktop) name: String,
    /// Whether the site is opened, and not the open one read again.
    pub(in crate::desktop) opens: bool,
    /// Whether it is known to take long: all but the open site's settings.
    pub(in crate::desktop) reads: bool,
    begun: Instant,
    stage: Arc<Mutex<LoadStage>>,
    cancelled: Arc<AtomicBool>,
    result: mpsc::Receiver<Result<Project, LoadError>>,
}

impl LoadJob {
    /// Begins.
    pub(in crate::desktop) fn start(wanted: LoadRequest, reading: &ModelReader, context: egui::Context) -> LoadJob {
        let path = match &wanted {
            LoadRequest::Files(paths) => paths.first().cloned().unwrap_or_default(),
            LoadRequest::Placed(bare) => bare.path.clone(),
            LoadRequest::Left(_, written) | LoadRequest::Again(written, ..) => PathBuf::from(&written.file),
        };
        let (tell, result) = mpsc::channel();
        let stage = Arc::new(Mutex::new(LoadStage::new(0.0, "Reading".to_owned())));
        let cancelled = Arc::new(AtomicBool::new(false));
        let opens = !matches!(wanted, LoadRequest::Again(..));
        let reads = !matches!(&wanted, LoadRequest::Again(_, _, before) if before.models.is_some());
        let (shown, reading) = (Arc::clone(&stage), reading.until(&cancelled));
        let progress = LoadProgress { stage: shown, reading, cancelled: Arc::clone(&cancelled), context };
        std::thread::spawn(move || {
            let project = project(wanted, &progress);
            // who gave the loading up listens no more
            let _ = tell.send(project);
            progress.context.request_repaint();
        });
        LoadJob { name: name_of(&path), opens, reads, begun: Instant::now(), stage, cancelled, result }
    }

    /// Whether it is shown: at once where it takes long, and settings once they do, as with a model that was added.
    pub(in crate::desktop) fn is_shown(&self) -> bool {
        self.reads || self.begun.elapsed() > SHOWN_AFTER
    }

    /// How far it is, 0 to 1, and what is being done; of what takes long, for how long.
    pub(in crate::desktop) fn stage(&self) -> (f32, String) {
        self.stage.lock().map(|stage| stage.shown(stage.since.elapsed())).unwrap_or_default()
    }

    /// What came of it, once it is done.
    pub(in crate::desktop) fn done(&self) -> Option<Result<Project, LoadError>> {
        match self.result.try_recv() {
            Ok(result) => Some(result),
            Err(mpsc::TryRecvError::Empty) => None,
            Err(mpsc::TryRecvError::Disconnected) => {
                Some(Err(LoadError::Message(format!("{} could not be loaded: the work ended early", self.name))))
            }
        }
    }

    /// Gives it up.
    pub(in crate::desktop) fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }
}

/// What is being done.
struct LoadStage {
    share: f32,
    what: String,
    since: Instant,
}

/// Settings that are read within that time are not shown.
const SHOWN_AFTER: Duration = Duration::from_secs(1);
/// What takes no longer does not say how long it takes.
const SOON: Duration = Duration::from_secs(2);

impl LoadStage {
    fn new(share: f32, what: String) -> LoadStage {
        LoadStage { share, what, since: Instant::now() }
    }

    /// Readers of others do not say how far they are: that time goes by is all that can be shown.
    fn shown(&self, gone: Duration) -> (f32, String) {
        match gone < SOON {
            true => (self.share, self.what.clone()),
            false => (self.share, format!("{}, {} s", self.what, gone.as_secs())),
        }
    }
}

struct LoadProgress {
    stage: Arc<Mutex<LoadStage>>,
    /// Until it is cancelled.
    reading: ModelReader,
    cancelled: Arc<AtomicBool>,
    context: egui::Context,
}

impl LoadProgress {
    fn tell(&self, share: f32, what: impl Into<String>) {
        if let Ok(mut stage) = self.stage.lock() {
            *stage = LoadStage::new(share, what.into());
        }
        self.context.request_repaint();
    }
}

fn project(wanted: LoadRequest, progress: &LoadProgress) -> Result<Project, LoadError> {
    let mut beside = Vec::new();
    let (path, mut written) = match wanted {
        LoadRequest::Files(paths) => from_files(paths, &mut beside)?,
        LoadRequest::Placed(bare) => (None, placed(bare)?),
        LoadRequest::Left(path, written) => (path, *written),
        // a key that is left out of the open site by hand is reported, and not filled in
        LoadRequest::Again(written, hidden, before) => {
            return read(before.path.clone(), *written, hidden, Some(&before), progress);
        }
    };
    complete(&mut written.site);
    let project = read(path, written, Hidden::default(), None, progress)?;
    Ok(Project { beside, ..project })
}

/// What somebody opens as it is written, and where its site file lies; models have none. Models that come with a site file
/// are not of it yet.
fn from_files(paths: Vec<PathBuf>, beside: &mut Vec<PathBuf>) -> Result<(Option<PathBuf>, WrittenSite), LoadError> {
    let mut paths = paths.into_iter();
    let path = paths.next().unwrap_or_default();
    let mut overrides = Overrides { beside: paths.collect(), ..Overrides::default() };
    if path.is_dir() || !is_model(&path) {
        *beside = std::mem::take(&mut overrides.beside);
    }
    let written = WrittenSite::read(&path, &overrides).map_err(|error| failure(&error, &FileWords))?;
    if written.is_bare_model() {
        return Ok((None, written));
    }
    let path = if path.is_dir() { path.join("site.toml") } else { path };
    Ok((Some(path), written))
}

/// Bare models, where they stand.
fn placed(bare: BareModel) -> Result<WrittenSite, LoadError> {
    let north = bare.north().map_err(|error| failure(&error, &FileWords))?;
    let place = bare.place().map_err(|error| failure(&error, &FileWords))?;
    let BareModel { path, beside, .. } = bare;
    let overrides = Overrides { place: Some(place), beside, ..Overrides::default() };
    let mut written = WrittenSite::read(&path, &overrides).map_err(|error| failure(&error, &FileWords))?;
    for table in &mut written.site.model {
        table.north = Some(north).filter(|north| *north != 0.0);
    }
    Ok(written)
}

/// The site as it is written, with what the window needs of it. What an open site has, and still does, is not made again.
fn read(
    path: Option<PathBuf>,
    mut written: WrittenSite,
    hidden: Hidden,
    before: Option<&LoadedSite>,
    progress: &LoadProgress,
) -> Result<Project, LoadError> {
    let at_hand = before.and_then(|before| before.models.as_ref()).filter(|models| models.are_those_of(&written));
    // what is set in the panel has its labels, and what a file says its keys
    let words: &dyn Words = if before.is_some() { words::of_panel(written.site.model.len()) } else { &FileWords };
    let mut models = None;
    let site = Site::with_models(&written, &Overrides::default(), || {
        let read = at_hand.map_or_else(|| read_models(&written, progress), |models| Ok(models.clone()))?;
        Ok(models.insert(read).clone())
    })
    .map_err(|error| match error {
        // a model that cannot be read is reported before its place is asked for
        SiteError::NoPlaceForModel { .. } => LoadError::Bare(written.model_paths()),
        error => failure(&error, words),
    })?;
    if progress.cancelled.load(Ordering::Relaxed) {
        return Err(LoadError::Message("given up".to_owned()));
    }
    let site = Arc::new(site);
    let visible = visible(&site, &hidden);
    let seen = match before.filter(|_| at_hand.is_some()) {
        Some(before) if before.visible.receives == visible.receives => Arc::clone(&before.seen),
        _ => {
            progress.tell(0.85, "Sorting what is seen");
            let seen = visible.mesh.of_components(&visible.receives);
            let reach = seen.bounds().map_or(1.0, |(low, high)| (high - low).length()) * crate::study::live::FARTHEST;
            let rays = RayCaster::new(&seen, reach);
            Arc::new((seen, rays))
        }
    };
    let flush = match before.filter(|before| Arc::ptr_eq(&before.seen, &seen)) {
        Some(before) if before.visible.ground.level == site.ground.level => before.flush.clone(),
        _ => FlushFaces::new(&seen.0, site.ground.level).map(Arc::new),
    };
    progress.tell(1.0, "Drawing");
    let Some(models) = models else { return Err(LoadError::Message("the models were not read".to_owned())) };
    // what a file proposes is in the panel, and is saved
    models.proposed_place().iter().for_each(|place| written.site.place.get_or_insert_default().complete_with(place));
    Ok(Project {
        path,
        written,
        models,
        // what is read of it later is nobody's to cancel here
        reading: progress.reading.until(&Arc::default()),
        colours: component_colours(&site.mesh, &site.casts),
        seen,
        flush,
        site,
        hidden,
        visible,
        beside: Vec::new(),
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
    let count = written.site.model.len().max(1);
    let done = Cell::new(0);
    Models::read(written, |path, options| {
        let share = |done: usize| 0.15 + 0.35 * done as f32 / count as f32;
        let size = std::fs::metadata(path).map_or_else(|_| String::new(), |found| format!(", {}", bytes(found.len())));
        progress.tell(share(done.get()), format!("Reading model {} of {count}{size}", done.get() + 1));
        let read = progress.reading.read(path, options)?;
        done.set(done.get() + 1);
        progress.tell(share(done.get()), "Joining triangles");
        Ok(read)
    })
}

fn failure(error: &(dyn std::error::Error + 'static), words: &dyn Words) -> LoadError {
    LoadError::Message(fault::line(error, words))
}
