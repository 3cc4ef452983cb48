//! Shows the window, and reopens it when its graphics device is lost (the driver was reset, or the adapter is gone): on
//! a new device, with everything that was open and all running work. If devices are lost repeatedly, it is opened on
//! the processor.
//!
//! eframe cannot change the device of a window. So the window is closed and another one opened, with the same [`App`]
//! and with egui's memory.

use crate::desktop::app::device::devices;
use crate::desktop::app::state::App;
use crate::desktop::event_loop::{self, Panic};
use crate::desktop::parts::theme;
use crate::formats::ModelReader;
use crate::gpu::{Gpu, GpuError};
use anyhow::anyhow;
use eframe::egui::layers::GraphicLayers;
use eframe::egui_wgpu::{SurfaceErrorAction, WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};
use eframe::{AppCreator, CreationContext, Frame, NativeOptions, Storage, egui};
use std::panic::resume_unwind;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};
use wgpu::{Adapter, CurrentSurfaceTexture, DeviceType, PollType};

/// If more devices than this are lost within [`MOMENT`], the window is opened on the processor; if as many are lost
/// there, the program gives up.
const MOST_LOSSES: usize = 3;
const MOMENT: Duration = Duration::from_secs(60);

/// Opens the window, with a site or a model in it if one is named, and returns when it is closed.
///
/// # Errors
/// No display, or no graphics adapter.
pub fn open(path: Option<&Path>) -> anyhow::Result<()> {
    open_reading(path, &ModelReader::of_this_program(), &|_| (), &mut |_, _| ())
}

/// The same with further options for eframe and a callback for each frame, for tests. Models are read in this process.
///
/// # Errors
/// As [`open`].
pub fn open_with(
    path: Option<&Path>,
    set: &dyn Fn(&mut NativeOptions),
    on_frame: &mut dyn FnMut(&mut App, &egui::Context),
) -> anyhow::Result<()> {
    open_reading(path, &ModelReader::default(), set, on_frame)
}

fn open_reading(
    path: Option<&Path>,
    reading: &ModelReader,
    set: &dyn Fn(&mut NativeOptions),
    on_frame: &mut dyn FnMut(&mut App, &egui::Context),
) -> anyhow::Result<()> {
    let options = |software| {
        let mut options = options(software);
        set(&mut options);
        options
    };
    let mut event_loop = event_loop::new(&mut options(false)).map_err(unopened)?;
    let (mut app, mut context) = (None, None);
    let mut ways = Reopening::default();
    loop {
        let mut is_open = false;
        let (is_there, slot, egui, on_frame) = (&mut is_open, &mut app, &mut context, &mut *on_frame);
        let note = ways.note.take();
        let create: AppCreator<'_> = Box::new(move |cc| {
            match slot {
                None => *slot = Some(App::with_reader(cc, path, reading.clone())?.recovering()),
                Some(app) => app.move_to(cc, egui.as_ref())?,
            }
            *egui = Some(cc.egui_ctx.clone());
            let app = slot.as_mut().ok_or(GpuError::NoAdapter)?;
            if note.is_some() {
                app.notice = note;
            }
            *is_there = true;
            Ok(Box::new(AppWindow { app, on_frame }))
        });
        let window = eframe::create_native("gnomon", options(ways.software), create, &event_loop);
        let panic = event_loop::show(&mut event_loop, window).map_err(unopened)?;
        match app.as_mut().filter(|_| is_open).and_then(|app| app.lost(panic.is_some())) {
            Some(why) => ways.note_loss(why)?,
            None if !is_open => ways.note_unopened(panic)?,
            None => return panic.map_or(Ok(()), |panic| resume_unwind(panic)),
        }
    }
}

/// The device on which the window is opened next.
#[derive(Default)]
struct Reopening {
    /// Whether it is opened on the processor.
    software: bool,
    /// The times at which devices were lost.
    losses: Vec<Instant>,
    /// Why it is on the processor, if devices were lost.
    lost: Option<String>,
    /// The note of the next window.
    note: Option<String>,
}

impl Reopening {
    /// Records that a device was lost.
    fn note_loss(&mut self, why: String) -> anyhow::Result<()> {
        self.losses.retain(|at| at.elapsed() < MOMENT);
        self.losses.push(Instant::now());
        if self.losses.len() <= MOST_LOSSES {
            return Ok(());
        }
        if self.software {
            return Err(given_up(&why));
        }
        self.note = Some(format!("{why} time and again; the window is drawn on the processor now"));
        (self.software, self.losses, self.lost) = (true, Vec::new(), Some(why));
        Ok(())
    }

    /// Records that no window could be opened.
    fn note_unopened(&mut self, panic: Option<Panic>) -> anyhow::Result<()> {
        if !self.software {
            self.note = Some("No graphics adapter opens: the window is drawn on the processor".to_owned());
            self.software = true;
            return Ok(());
        }
        match (panic, &self.lost) {
            (_, Some(why)) => Err(given_up(why)),
            (Some(panic), None) => resume_unwind(panic),
            (None, None) => Err(anyhow!("{}", GpuError::NoAdapter)),
        }
    }
}

fn given_up(why: &str) -> anyhow::Error {
    anyhow!("{why} time and again, and no window can be shown; check its driver")
}

fn unopened(error: impl std::fmt::Display) -> anyhow::Error {
    anyhow!("the window cannot be opened: {error}; without a display use the commands (gnomon help)")
}

/// The options with which the window is opened.
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
            // the smallest size at which everything is visible: that of a screen of 1280 × 720 at double scale
            .with_min_inner_size([640.0, 360.0]),
        // panels are flat and the picture has exact colours, so there is no banding to dither
        dithering: false,
        wgpu_options: WgpuConfiguration {
            wgpu_setup: WgpuSetup::CreateNew(setup),
            on_surface_status: Arc::new(|status| match status {
                // a surface that could not be configured is retried, since otherwise no more frames are shown
                CurrentSurfaceTexture::Outdated | CurrentSurfaceTexture::Validation => SurfaceErrorAction::Reconfigure,
                CurrentSurfaceTexture::Lost => SurfaceErrorAction::RecreateSurface,
                _ => SurfaceErrorAction::SkipFrame,
            }),
            ..WgpuConfiguration::default()
        },
        ..NativeOptions::default()
    }
}

/// How eframe requests the window's own device.
#[cfg(feature = "test-hooks")]
pub fn setup() -> WgpuSetup {
    WgpuSetup::CreateNew(create_new())
}

fn create_new() -> WgpuSetupCreateNew {
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    setup.instance_descriptor.backends &= Gpu::BACKENDS;
    setup.device_descriptor = Arc::new(Gpu::description);
    setup
}

/// The app in its current window.
struct AppWindow<'a> {
    app: &'a mut App,
    on_frame: &'a mut dyn FnMut(&mut App, &egui::Context),
}

impl eframe::App for AppWindow<'_> {
    fn logic(&mut self, context: &egui::Context, frame: &mut Frame) {
        // a window that will be reopened asks no questions when it closes
        if !self.app.leaves_device(context) {
            self.app.logic(context, frame);
        }
    }

    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut Frame) {
        if !self.app.leaves_device(ui.ctx()) {
            self.app.ui(ui, frame);
            (self.on_frame)(self.app, ui.ctx());
        }
        // egui's renderer panics on a lost device
        if self.app.leaves_device(ui.ctx()) {
            ui.ctx().graphics_mut(|layers| *layers = GraphicLayers::default());
        }
    }

    fn save(&mut self, storage: &mut dyn Storage) {
        self.app.save(storage);
    }
}

/// Moves egui's memory to another context. Work that still requests frames from the last context requests them from the
/// new one.
fn take_over(last: &egui::Context, new: &egui::Context) {
    let memory = last.memory(Clone::clone);
    new.memory_mut(|its| *its = memory);
    theme::set(new);
    let next = new.clone();
    last.set_repaint_observer(move |info| next.request_repaint_after(info.delay));
}

impl App {
    /// Continues in another window, on its device, with egui's memory of the last one.
    fn move_to(&mut self, cc: &CreationContext<'_>, last: Option<&egui::Context>) -> Result<(), GpuError> {
        if let Some(last) = last {
            take_over(last, &cc.egui_ctx);
        }
        (self.gpu, self.render, self.stage) = devices(cc)?;
        if let Some(open) = &mut self.open {
            open.viewer.forget_pictures();
            if let Some(sky) = &mut open.sky {
                sky.forget_texture();
            }
        }
        self.saving.forget_title();
        Ok(())
    }

    /// Whether the window's device is lost: then nothing can be shown, and the window closes. Other faults of the
    /// device are reported once.
    fn leaves_device(&mut self, context: &egui::Context) -> bool {
        // the poll reports what happened
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

    /// Why the window's device is lost, if it is; the next window reports it. After a panic, any fault of the device
    /// counts, since egui's renderer cannot handle faults.
    fn lost(&mut self, has_panicked: bool) -> Option<String> {
        let _ = self.gpu.device.poll(PollType::wait_indefinitely());
        let is_lost = self.gpu.is_lost() || has_panicked;
        let why = is_lost.then(|| self.gpu.heard())?.map(|error| error.why())?;
        self.notice = Some(format!("{why}; the window was opened again on a new device"));
        Some(why)
    }
}
