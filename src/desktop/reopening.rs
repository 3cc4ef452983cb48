//! The window on the screen, and what becomes of it where its graphics device is lost (the driver was reset, the adapter is
//! gone): it is opened again on a new one, with all that was open and all that was under way.
//!
//! eframe cannot change the device of a window; so the window is closed and another one opened, with the same [`App`] and the
//! same context of egui, which work that goes on beside the window wakes.

use super::app::App;
use super::screen;
use super::stage::Stage;
use crate::gpu::{Gpu, GpuError};
use anyhow::anyhow;
use eframe::egui::layers::GraphicLayers;
use eframe::egui_wgpu::{RenderState, SurfaceErrorAction, WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};
use eframe::{AppCreator, CreationContext, Frame, NativeOptions, Storage, egui};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};
use wgpu::{Adapter, CurrentSurfaceTexture, DeviceType, PollType};

/// A window whose device is lost more often within [`MOMENT`] is given up.
const MOST_LOSSES: usize = 3;
const MOMENT: Duration = Duration::from_secs(60);

/// Opens the window, with a site or a model in it where one is named; comes back when it is closed.
///
/// # Errors
/// No display, or no graphics adapter.
pub fn open(path: Option<&Path>) -> anyhow::Result<()> {
    open_with(path, &|_| (), &mut |_, _| ())
}

/// The same with further options for eframe, and an eye on each frame: for tests.
///
/// # Errors
/// As [`open`].
pub fn open_with(
    path: Option<&Path>,
    set: &dyn Fn(&mut NativeOptions),
    on_frame: &mut dyn FnMut(&mut App, &egui::Context),
) -> anyhow::Result<()> {
    let (mut app, mut context) = (None, None);
    let (mut losses, mut software) = (Vec::new(), false);
    loop {
        let mut options = options(software);
        set(&mut options);
        let at_hand = context.clone();
        let (slot, egui, on_frame) = (&mut app, &mut context, &mut *on_frame);
        let create: AppCreator<'_> = Box::new(move |cc| {
            *egui = Some(cc.egui_ctx.clone());
            match slot {
                None => *slot = Some(App::new(cc, path)?.recovering()),
                Some(app) => app.move_to(cc)?,
            }
            let app = slot.as_mut().ok_or(GpuError::NoAdapter)?;
            if software {
                app.notice = Some("No graphics adapter opens: the window is drawn on the processor".to_owned());
            }
            Ok(Box::new(Held { app, on_frame }))
        });
        let run = || eframe::run_native_ext("gnomon", options, at_hand, create);
        let ended = catch_unwind(AssertUnwindSafe(run));
        match (ended, app.as_mut().and_then(App::lost)) {
            // it was lost in the midst of egui's frame, and winit's loop is one that a panic leaves for good
            (Err(_), Some(why)) => return Err(anyhow!("{why}, and the window with it; start gnomon again")),
            (_, Some(why)) => {
                losses.retain(|at: &Instant| at.elapsed() < MOMENT);
                losses.push(Instant::now());
                if losses.len() > MOST_LOSSES {
                    return Err(anyhow!("{why} time and again, and no window can be shown; look after its driver"));
                }
            }
            (Err(panic), None) => resume_unwind(panic),
            (Ok(Ok(())), None) => return Ok(()),
            (Ok(Err(eframe::Error::Wgpu(_))), None) if !software => software = true,
            (Ok(Err(eframe::Error::Wgpu(_))), None) => return Err(anyhow!("{}", GpuError::NoAdapter)),
            (Ok(Err(error)), None) => {
                return Err(anyhow!(
                    "the window cannot be opened: {error}; without a display use the commands (gnomon help)"
                ));
            }
        }
    }
}

/// How the window is to be opened.
fn options(software: bool) -> NativeOptions {
    let mut setup = create_new();
    if software {
        setup.native_adapter_selector = Some(Arc::new(|adapters, surface| {
            let is_fit = |adapter: &&Adapter| {
                adapter.get_info().device_type == DeviceType::Cpu
                    && surface.is_none_or(|surface| adapter.is_surface_supported(surface))
            };
            adapters.iter().find(is_fit).cloned().ok_or_else(|| "no adapter is a program on the processor".to_owned())
        }));
    }
    NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("Gnomon")
            .with_app_id("gnomon")
            .with_inner_size([1280.0, 760.0])
            // all is seen down to here: twice as large on a screen of 1280 × 720
            .with_min_inner_size([640.0, 360.0]),
        // panels are flat and the picture has its colours: there is nothing between two of them that a dither could hide
        dithering: false,
        wgpu_options: WgpuConfiguration {
            wgpu_setup: WgpuSetup::CreateNew(setup),
            on_surface_status: Arc::new(|status| match status {
                // what could not be configured is tried again, or no frame is shown any more
                CurrentSurfaceTexture::Outdated | CurrentSurfaceTexture::Validation => SurfaceErrorAction::Reconfigure,
                CurrentSurfaceTexture::Lost => SurfaceErrorAction::RecreateSurface,
                _ => SurfaceErrorAction::SkipFrame,
            }),
            ..WgpuConfiguration::default()
        },
        ..NativeOptions::default()
    }
}

/// How the window's own device is to be asked for.
pub fn setup() -> WgpuSetup {
    WgpuSetup::CreateNew(create_new())
}

fn create_new() -> WgpuSetupCreateNew {
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    setup.instance_descriptor.backends &= Gpu::BACKENDS;
    setup.device_descriptor = Arc::new(Gpu::description);
    setup
}

/// An app in the window of this time.
struct Held<'a> {
    app: &'a mut App,
    on_frame: &'a mut dyn FnMut(&mut App, &egui::Context),
}

impl eframe::App for Held<'_> {
    fn logic(&mut self, context: &egui::Context, frame: &mut Frame) {
        // a window that is opened again asks nothing when it closes
        if !self.app.leaves_device(context) {
            self.app.logic(context, frame);
        }
    }

    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut Frame) {
        if !self.app.leaves_device(ui.ctx()) {
            self.app.ui(ui, frame);
            (self.on_frame)(self.app, ui.ctx());
        }
        // egui's renderer panics where it is to draw on a device that is lost
        if self.app.leaves_device(ui.ctx()) {
            ui.ctx().graphics_mut(|drawn| *drawn = GraphicLayers::default());
        }
    }

    fn save(&mut self, storage: &mut dyn Storage) {
        self.app.save(storage);
    }
}

/// The window's device, and the stage beside it.
pub(super) fn devices(cc: &CreationContext<'_>) -> Result<(Gpu, RenderState, Stage), GpuError> {
    let render = cc.wgpu_render_state.clone().ok_or(GpuError::NoAdapter)?;
    screen::set_up(&render);
    let gpu = Gpu::opened(&render.adapter, render.device.clone(), render.queue.clone());
    let stage = Stage::new(render.clone(), cc.egui_ctx.clone());
    Ok((gpu, render, stage))
}

impl App {
    /// Goes on in another window, on its device.
    fn move_to(&mut self, cc: &CreationContext<'_>) -> Result<(), GpuError> {
        (self.gpu, self.render, self.stage) = devices(cc)?;
        // the letters lie on the device that was lost
        cc.egui_ctx.set_glyph_rasterizers(Vec::new());
        if let Some(open) = &mut self.open {
            open.viewer.forget_pictures();
        }
        self.saving.forget_title();
        Ok(())
    }

    /// Whether the window's device is lost: then nothing can be shown, and the window closes. What else the device says is
    /// told, once.
    fn leaves_device(&mut self, context: &egui::Context) -> bool {
        // what became of it is told when it is asked
        let _ = self.gpu.device.poll(PollType::Poll);
        let Err(error) = self.gpu.check() else { return false };
        let is_lost = self.gpu.is_lost();
        if is_lost {
            context.send_viewport_cmd(egui::ViewportCommand::Close);
        } else {
            self.fault = self.gpu.heard().or(Some(error)).map(|error| error.why());
        }
        is_lost
    }

    /// Why the window's device is lost, where it is; what the next window says of it.
    fn lost(&mut self) -> Option<String> {
        let _ = self.gpu.device.poll(PollType::wait_indefinitely());
        let why = self.gpu.is_lost().then(|| self.gpu.heard())?.map(|error| error.why())?;
        self.notice = Some(format!("{why}; the window was opened again on a new device"));
        Some(why)
    }

    /// For tests: takes the window's device away, as a driver that is reset would.
    pub fn lose_window(&self) {
        self.gpu.device.destroy();
    }

    /// For tests: takes the device away that pictures are drawn on, and further ones as soon as they are opened.
    pub fn lose_pictures(&self, further: u32) {
        self.stage.lose_devices(further);
    }
}
