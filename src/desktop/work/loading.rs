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

/// Why a site could not be loaded.
pub(in crate::desktop) enum LoadError {
    /// The files are one or more models without a place.
    Bare(Vec<PathBuf>),
    /// A message, as the command would print it.
    Message(String),
}

/// What to load.
pub(in crate::desktop) enum LoadRequest {
    /// Files: a site, or one or more models.
    Files(Vec<PathBuf>),
    /// Bare models with a place.
    Placed(BareModel),
    /// The site file of a window that has ended, and its contents.
    Left(Option<PathBuf>, Box<WrittenSite>),
    /// The open site with changed settings, its hidden components, and what can be reused.
    Again(Box<WrittenSite>, Hidden, Box<LoadedSite>),
}

/// A load in progress.
pub(in crate::desktop) struct LoadJob {
    /// The name of what is loaded.
    pub(in crate::desktop) name: String,
    /// Whether it opens a site; otherwise, the open one is read again.
    pub(in crate::desktop) opens: bool,
    /// Whether its progress is shown: always, except for changed settings of the open site.
    pub(in crate::desktop) reads: bool,
    begun: Instant,
    stage: Arc<Mutex<LoadStage>>,
    cancelled: Arc<AtomicBool>,
    result: mpsc::Receiver<Result<Project, LoadError>>,
}

impl LoadJob {
    /// Starts loading.
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
            // after a cancellation nobody receives this
            let _ = tell.send(project);
            progress.context.request_repaint();
        });
        LoadJob { name: name_of(&path), opens, reads, begun: Instant::now(), stage, cancelled, result }
    }

    /// Whether it is shown: at once where it takes long, and settings once they do, as with a model that was added.
    pub(in crate::desktop) fn is_shown(&self) -> bool {
        self.reads || self.begun.elapsed() > SHOWN_AFTER
    }

    /// The progress, 0 to 1, and the current stage; for long stages with the elapsed time.
    pub(in crate::desktop) fn stage(&self) -> (f32, String) {
        self.stage.lock().map(|stage| stage.shown(stage.since.elapsed())).unwrap_or_default()
    }

    /// The result, once it is done.
    pub(in crate::desktop) fn done(&self) -> Option<Result<Project, LoadError>> {
        match self.result.try_recv() {
            Ok(result) => Some(result),
            Err(mpsc::TryRecvError::Empty) => None,
            Err(mpsc::TryRecvError::Disconnected) => {
                Some(Err(LoadError::Message(format!("{} could not be loaded: the work ended early", self.name))))
            }
        }
    }

    /// Cancels it.
    pub(in crate::desktop) fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }
}

/// The current stage.
struct LoadStage {
    share: f32,
    what: String,
    since: Instant,
}

/// Settings that are read within that time are not shown.
const SHOWN_AFTER: Duration = Duration::from_secs(1);
/// Shorter stages do not show the elapsed time.
const SOON: Duration = Duration::from_secs(2);

impl LoadStage {
    fn new(share: f32, what: String) -> LoadStage {
        LoadStage { share, what, since: Instant::now() }
    }

    /// Readers of other libraries do not report progress, so only the elapsed time can be shown.
    fn shown(&self, gone: Duration) -> (f32, String) {
        match gone < SOON {
            true => (self.share, self.what.clone()),
            false => (self.share, format!("{}, {} s", self.what, gone.as_secs())),
        }
    }
}

struct LoadProgress {
    stage: Arc<Mutex<LoadStage>>,
    /// With a flag for cancelling.
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
        // keys that the user removed from the open site are reported, not filled in
        LoadRequest::Again(written, hidden, before) => {
            return read(before.path.clone(), *written, hidden, Some(&before), progress);
        }
    };
    complete(&mut written.site);
    let project = read(path, written, Hidden::default(), None, progress)?;
    Ok(Project { beside, ..project })
}

/// The request for the given files, and the path of its site file, if there is one. Models that are opened with a site
/// file are returned in `beside`.
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

/// The request for bare models with a place.
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

/// Reads and checks a request, with everything that the window needs. Valid parts of the open site are reused.
fn read(
    path: Option<PathBuf>,
    mut written: WrittenSite,
    hidden: Hidden,
    before: Option<&LoadedSite>,
    progress: &LoadProgress,
) -> Result<Project, LoadError> {
    let at_hand = before.and_then(|before| before.models.as_ref()).filter(|models| models.are_those_of(&written));
    // settings in the panel are worded as labels, the contents of files as keys
    let words: &dyn Words = if before.is_some() { words::of_panel(written.site.model.len()) } else { &FileWords };
    let mut models = None;
    let site = Site::with_models(&written, &Overrides::default(), || {
        let read = at_hand.map_or_else(|| read_models(&written, progress), |models| Ok(models.clone()))?;
        Ok(models.insert(read).clone())
    })
    .map_err(|error| match error {
        // an unreadable model is reported before its place is asked for
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
    // a file's proposed place is shown in the panel, and saved
    models.proposed_place().iter().for_each(|place| written.site.place.get_or_insert_default().complete_with(place));
    Ok(Project {
        path,
        written,
        models,
        // later reads must not be cancelled by this flag
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
