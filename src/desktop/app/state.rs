//! The window's state: what is open, the settings, and the work in progress.

use crate::desktop::app::device::devices;
use crate::desktop::app::judge_desk::JudgeDesk;
use crate::desktop::parts::fields::TypedText;
use crate::desktop::parts::path_dialog::PathDialog;
use crate::desktop::parts::point_sky::PointSky;
use crate::desktop::parts::theme;
use crate::desktop::parts::view::Viewer;
use crate::desktop::results::StudyResult;
use crate::desktop::results::before::BeforeState;
use crate::desktop::stage::Stage;
use crate::desktop::state::bare_model::BareModel;
use crate::desktop::state::clock::Clock;
use crate::desktop::state::eye::Stand;
use crate::desktop::state::pick::PickedPoint;
use crate::desktop::state::project::Project;
use crate::desktop::state::saving::SaveState;
use crate::desktop::state::settings::{History, WindowSettings};
use crate::desktop::work::Work;
use crate::desktop::work::loading::{LoadJob, LoadRequest};
use crate::desktop::work::studies::ClickedSun;
use crate::export::figure::Colours;
use crate::formats::ModelReader;
use crate::gpu::{Gpu, readback};
use crate::message::Message;
use crate::sunlight::Sunlight;
use eframe::egui;
use eframe::egui_wgpu::RenderState;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What is stored from one start to the next.
#[derive(Default, Serialize, Deserialize)]
pub(in crate::desktop) struct PersistentState {
    pub(in crate::desktop) recent: Vec<PathBuf>,
    pub(in crate::desktop) feet: bool,
    pub(in crate::desktop) no_sun_path: bool,
}

/// An open site with its results.
pub(in crate::desktop) struct Open {
    /// The site.
    pub(in crate::desktop) project: Project,
    pub(in crate::desktop) number: u64,
    /// The instant that is shown.
    pub(in crate::desktop) clock: Clock,
    pub(in crate::desktop) viewer: Viewer,
    /// How many times hours were requested.
    pub(in crate::desktop) answers: u64,
    /// The hours that are being computed.
    pub(in crate::desktop) adding: Option<Work<StudyResult>>,
    /// The computed hours, or the change.
    pub(in crate::desktop) result: Option<Arc<StudyResult>>,
    /// Whether the result is shown on the model, instead of one instant. This belongs to the view, so undo does not
    /// change it.
    pub(in crate::desktop) shows_hours: bool,
    /// The state that was kept for comparison.
    pub(in crate::desktop) before: Option<BeforeState>,
    /// The point that is being searched.
    pub(in crate::desktop) probing: Option<Work<ClickedSun>>,
    /// The intervals in which a point lies in the sun.
    pub(in crate::desktop) sunlight: Option<Sunlight>,
    /// The picture of that point's sky.
    pub(in crate::desktop) sky: Option<PointSky>,
    /// What the last export noted, as long as the site is the one that was exported.
    pub(in crate::desktop) export_notes: Vec<Message>,
    /// The point that was clicked.
    pub(in crate::desktop) clicked: Option<PickedPoint>,
    /// What belongs to judging it by a rule.
    pub(in crate::desktop) judge: JudgeDesk,
}

/// The window.
pub struct App {
    /// The window's own device, which draws only the window's frames.
    pub(in crate::desktop) gpu: Gpu,
    pub(in crate::desktop) render: RenderState,
    pub(in crate::desktop) stage: Stage,
    pub(in crate::desktop) kept: PersistentState,
    /// The open site.
    pub(in crate::desktop) open: Option<Open>,
    /// The settings.
    pub(in crate::desktop) settings: WindowSettings,
    pub(in crate::desktop) history: History,
    pub(in crate::desktop) loading: Option<LoadJob>,
    pub(in crate::desktop) loaded: u64,
    /// Whether the site is being read again, because its settings have changed.
    pub(in crate::desktop) is_reading: bool,
    /// Settings that are known to be invalid.
    pub(in crate::desktop) refused: Option<WindowSettings>,
    pub(in crate::desktop) bare: Option<BareModel>,
    /// Models that were dropped on the open site, until the question about them is answered.
    pub(in crate::desktop) dropped: Vec<PathBuf>,
    /// How model files are read.
    pub(in crate::desktop) reading: ModelReader,
    pub(in crate::desktop) asking: Option<PathDialog>,
    pub(in crate::desktop) writing: Option<Work<PathBuf>>,
    /// The text that is being typed into the panel's fields.
    pub(in crate::desktop) typed: TypedText,
    /// What is saved, and the questions about unsaved settings.
    pub(in crate::desktop) saving: SaveState,
    /// The current error, in the command's words.
    pub(in crate::desktop) fault: Option<String>,
    /// The current notice.
    pub(in crate::desktop) notice: Option<String>,
    /// The folder in which stopped studies are kept, if any.
    pub(in crate::desktop) studies: Option<PathBuf>,
    /// A file of the open site that has changed since it was read.
    pub(in crate::desktop) changed: Option<String>,
    /// Whether the window had the focus at the last frame.
    pub(in crate::desktop) had_focus: bool,
}

impl App {
    /// A window on eframe's device, with a site or a model in it if one is named. Models are read in this process.
    ///
    /// # Errors
    /// If eframe has no device.
    pub fn new(
        cc: &eframe::CreationContext<'_>,
        path: Option<&Path>,
    ) -> Result<App, Box<dyn std::error::Error + Send + Sync>> {
        Self::with_reader(cc, path, ModelReader::default())
    }

    /// The same with a different reader of models.
    pub(in crate::desktop) fn with_reader(
        cc: &eframe::CreationContext<'_>,
        path: Option<&Path>,
        reading: ModelReader,
    ) -> Result<App, Box<dyn std::error::Error + Send + Sync>> {
        theme::set(&cc.egui_ctx);
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

    /// Whether pictures are drawn by a software adapter or by the processor.
    pub(in crate::desktop) fn is_software(&self) -> bool {
        self.stage.is_software()
    }

    /// The current stand: the perspective, the plan, or a side.
    pub(in crate::desktop) fn stand(&self) -> Stand {
        self.open.as_ref().map_or(Stand::Perspective, |open| open.viewer.eye.stand)
    }

    /// The meaning of the colours of the shown diagram.
    pub(in crate::desktop) fn legend(&self) -> Option<&Colours> {
        self.open.as_ref()?.viewer.shown()?.legend.as_ref()
    }

    /// Reads back the picture on the screen: columns, rows and pixels.
    ///
    /// # Errors
    /// If there is none, or if the adapter fails.
    pub fn picture(&self) -> anyhow::Result<(u32, u32, Vec<[u8; 4]>)> {
        let shown = self.open.as_ref().and_then(|open| open.viewer.shown());
        let Some(shown) = shown else { anyhow::bail!("there is no picture yet") };
        let pixels = readback::texels(&self.gpu, &shown.texture, wgpu::TextureAspect::All)?;
        Ok((shown.texture.width(), shown.texture.height(), pixels))
    }

    pub(in crate::desktop) fn load(&mut self, wanted: LoadRequest, context: &egui::Context) {
        if let Some(loading) = self.loading.take() {
            loading.cancel();
        }
        (self.fault, self.notice, self.bare) = (None, None, None);
        self.dropped.clear();
        self.saving.recovery.let_go();
        self.loading = Some(LoadJob::start(wanted, &self.reading, context.clone()));
    }

    pub(in crate::desktop) fn set(&mut self, settings: Option<WindowSettings>) {
        if let Some(settings) = settings {
            if let Some(open) = self.open.as_mut().filter(|_| settings.before != self.settings.before) {
                // its result would be undone
                open.adding = None;
            }
            self.settings = settings;
            (self.refused, self.fault) = (None, None);
        }
    }
}
