//! The window: a site, its sun and its shadows at the speed of the hand. Everything that it finds, the library finds.
//!
//! One thread draws the window and never waits. A second one (`stage`) draws the picture and takes the newest wish; others
//! load sites and add up hours.

mod acts;
mod app;
mod bare;
mod cards;
mod change;
mod clock;
mod components;
mod eye;
mod facades;
mod files;
mod found;
mod frame;
mod handing;
mod hours;
mod loading;
mod look;
mod panel;
mod pick;
mod screen;
mod settings;
mod sky;
mod stage;
mod time;
mod typed;
mod unit;
mod view;
mod work;

pub use app::App;

use crate::gpu::{Gpu, GpuError};
use anyhow::anyhow;
use eframe::egui_wgpu::{WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};
use eframe::{NativeOptions, egui};
use std::path::Path;
use std::sync::Arc;

/// Opens the window, with a site or a model in it where one is named; comes back when it is closed.
///
/// # Errors
/// No display, or no graphics adapter.
pub fn open(path: Option<&Path>) -> anyhow::Result<()> {
    let options = NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("Gnomon")
            .with_app_id("gnomon")
            .with_inner_size([1280.0, 760.0])
            // all is seen down to here: twice as large on a screen of 1280 × 720
            .with_min_inner_size([640.0, 360.0]),
        // panels are flat and the picture has its colours: there is nothing between two of them that a dither could hide
        dithering: false,
        wgpu_options: WgpuConfiguration { wgpu_setup: setup(), ..WgpuConfiguration::default() },
        ..NativeOptions::default()
    };
    let path = path.map(Path::to_owned);
    eframe::run_native("gnomon", options, Box::new(move |cc| Ok(Box::new(App::new(cc, path.as_deref())?)))).map_err(
        |error| match error {
            eframe::Error::Wgpu(_) => anyhow!("{}", GpuError::NoAdapter),
            error => {
                anyhow!("the window cannot be opened: {error}; without a display use the commands (gnomon --help)")
            }
        },
    )
}

/// How the window's own device is to be asked for, so that the engine draws on it.
pub fn setup() -> WgpuSetup {
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    setup.instance_descriptor.backends &= Gpu::BACKENDS;
    setup.device_descriptor = Arc::new(Gpu::description);
    WgpuSetup::CreateNew(setup)
}
