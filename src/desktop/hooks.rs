//! What tests, benches and tools read from the window, and what they do to its devices.

use super::app::state::App;
use super::app::study;
use crate::profile::Provenance;
use crate::site::file::SiteFile;
use crate::view::View;
use eframe::egui;
use glam::DVec3;
use std::sync::Arc;

impl App {
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

    /// What the picture shows: the view, and the unit vector to the sun.
    pub fn shown(&self) -> Option<(View, DVec3)> {
        let wish = &self.open.as_ref()?.viewer.shown()?.wish;
        Some((wish.view, wish.to_sun))
    }

    /// What was asked for at the last frame: the view at its full size, and the unit vector to the sun.
    pub fn asked(&self) -> Option<(View, DVec3)> {
        let wish = self.open.as_ref()?.viewer.best()?;
        Some((wish.view, wish.to_sun))
    }

    /// What drew the picture.
    pub fn drawn(&self) -> Option<&Provenance> {
        Some(&self.open.as_ref()?.viewer.shown()?.provenance)
    }

    /// The site as it is set, as a site file would say it.
    pub fn site_file(&self) -> &SiteFile {
        &self.settings.site
    }

    /// Begins to find the hours of the open site, as its button does.
    pub fn find_hours(&mut self, context: &egui::Context) {
        if let Some(open) = &mut self.open {
            study::find(open, &self.settings, self.studies.clone(), context);
        }
    }

    /// Takes the window's device away, as a driver that is reset would.
    pub fn lose_window(&self) {
        self.gpu.device.destroy();
    }

    /// Takes it away while this frame is painted.
    pub fn lose_window_in_painting(&self, context: &egui::Context) {
        let device = self.gpu.device.clone();
        context.on_end_pass("lose", Arc::new(move |_: &mut egui::Ui| device.destroy()));
    }

    /// Takes the device away that pictures are drawn on, and further ones as soon as they are opened.
    pub fn lose_pictures(&self, further: u32) {
        self.stage.lose_devices(further);
    }
}
