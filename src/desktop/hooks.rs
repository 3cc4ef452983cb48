//! Hooks for tests, benches and tools, to read the window's state and to lose its devices.

use super::app::state::App;
use super::app::study;
use crate::formats::ModelReader;
use crate::profile::Provenance;
use crate::site::file::SiteFile;
use crate::view::View;
use eframe::egui;
use glam::DVec3;
use std::sync::Arc;

impl App {
    /// Whether no work is running: no site is loading, no picture being drawn, no hours being found.
    pub fn is_settled(&self) -> bool {
        let open = self.open.as_ref();
        self.loading.is_none()
            && self.writing.is_none()
            && !self.stage.is_busy()
            && open.is_none_or(|open| {
                open.adding.is_none() && open.probing.is_none() && open.viewer.is_settled() && open.judge.is_settled()
            })
    }

    /// The same window, with another reader of models.
    pub fn reading_by(mut self, reading: ModelReader) -> App {
        self.reading = reading;
        self
    }

    /// Whether a site is being loaded.
    pub fn is_loading(&self) -> bool {
        self.loading.is_some()
    }

    /// Whether hours are being added up.
    pub fn is_adding(&self) -> bool {
        self.open.as_ref().is_some_and(|open| open.adding.is_some())
    }

    /// The error message, and the notice.
    pub fn fault_and_notice(&self) -> [Option<&str>; 2] {
        let of_picture = self.open.as_ref().and_then(|open| open.viewer.fault.as_deref());
        [self.fault.as_deref().or(of_picture), self.notice.as_deref()]
    }

    /// What the picture shows: the view, and the unit vector to the sun.
    pub fn picture_view(&self) -> Option<(View, DVec3)> {
        let wish = &self.open.as_ref()?.viewer.shown()?.wish;
        Some((wish.view, wish.to_sun))
    }

    /// What the window requested at the last frame: the view at its full size, and the unit vector to the sun.
    pub fn wanted_view(&self) -> Option<(View, DVec3)> {
        let wish = self.open.as_ref()?.viewer.best()?;
        Some((wish.view, wish.to_sun))
    }

    /// What drew the picture.
    pub fn picture_provenance(&self) -> Option<&Provenance> {
        Some(&self.open.as_ref()?.viewer.shown()?.provenance)
    }

    /// The site file with the window's settings.
    pub fn site_file(&self) -> &SiteFile {
        &self.settings.site
    }

    /// Starts finding the hours of the open site, as the button does.
    pub fn find_hours(&mut self, context: &egui::Context) {
        if let Some(open) = &mut self.open {
            study::find(open, &self.settings, self.studies.clone(), context);
        }
    }

    /// Loses the window's device, as if the driver was reset.
    pub fn lose_window(&self) {
        self.gpu.device.destroy();
    }

    /// Loses it while this frame is painted.
    pub fn lose_window_in_painting(&self, context: &egui::Context) {
        let device = self.gpu.device.clone();
        context.on_end_pass("lose", Arc::new(move |_: &mut egui::Ui| device.destroy()));
    }

    /// Loses the device on which pictures are drawn, and that many further ones as soon as they are opened.
    pub fn lose_pictures(&self, further: u32) {
        self.stage.lose_devices(further);
    }
}
