//! Hours of sun on the model itself: façades, roofs and undersides, texel by texel.

use super::hours::{Findings, StudyResult};
use super::loading::Project;
use super::pick::PickedPoint;
use super::settings::WindowSettings;
use super::unit::Unit;
use super::work::Work;
use crate::choice::{Engine, Method, Receivers, Subject};
use crate::deliver::Sink;
use crate::deliver::patches::{PatchesRequest, answer, write_patches};
use crate::export::figure::{self, scale::Rgb};
use crate::export::patches::Atlas;
use crate::picture::{PatchColours, Picture};
use crate::shadow::ShadowError;
use crate::site::Site;
use crate::study::{self, OnEvent, PatchOutcome, Stopwatch};
use eframe::egui;
use std::sync::Arc;

/// The hours of sun on patches.
pub(super) struct Facades {
    outcome: PatchOutcome,
    atlas: Atlas,
    /// The atlas in the drawing's colours.
    pages: Vec<Vec<Rgb>>,
    /// What the colours mean.
    pub(super) legend: (String, Vec<(Rgb, String)>),
}

/// By what patches are judged, where the window draws by some technique: by that, or by the faster of the two that can.
pub(super) fn method(settings: &WindowSettings) -> Method {
    let method = settings.shown.method;
    if method.row().draws(Engine::Auto, Subject::Patches) { method } else { Method::Auto }
}

/// Finds the hours of sun on the patches of a site.
pub(super) fn find(project: &Project, method: Method, number: u64, context: egui::Context) -> Work<StudyResult> {
    let (site, written) = (Arc::clone(&project.site), project.written.site.clone());
    let mark = project.models.mark();
    Work::start(context, move |on_event| {
        let asked = Site { receivers: Receivers::Patches, method, ..Site::clone(&site) };
        let outcome = study::patches(&asked, asked.patch_cell, on_event)?;
        let answer = answer(&site, &outcome);
        let atlas = Atlas::of(&answer);
        let pages = atlas.colours(&answer.bands(), outcome.hours.samples);
        let legend = figure::patches_legend(&answer);
        let found = Findings::Facades(Box::new(Facades { outcome, atlas, pages, legend }));
        Ok(StudyResult { number, site, method, written, mark, found })
    })
}

impl Facades {
    /// Lays them over a picture of the site that they were found on, or of what of it is visible.
    ///
    /// # Errors
    /// Where the adapter cannot hold them.
    pub(super) fn lay(&self, picture: &mut Picture, site: &Site, visible: &Site) -> Result<(), ShadowError> {
        let components = site.mesh.components.iter().zip(site.receives.iter().zip(&visible.receives));
        let received = components.filter(|(_, (receives, _))| **receives);
        let faces = received.flat_map(|(component, (_, visible))| std::iter::repeat_n(*visible, component.faces.len()));
        let patch_of = self.atlas.patch_of.iter().zip(faces).filter(|(_, visible)| *visible).map(|(patch, _)| *patch);
        let patch_of: Vec<_> = patch_of.collect();
        picture.lay_patches(&PatchColours { patches: &self.outcome.patches, patch_of: &patch_of, pages: &self.pages })
    }

    /// The hours of sun at a point, and where it lies on its face.
    pub(super) fn said(&self, under: &PickedPoint, unit: Unit) -> Option<String> {
        let patches = &self.outcome.patches;
        let patch = self.atlas.patch(patches, under.face?, under.normal)?;
        let point = under.point - patches.origin;
        let lit = self.atlas.lit(patches, patch, point);
        let hours = f64::from(lit) / (f64::from(self.outcome.hours.samples) * 3600.0);
        let from_corner = point - patch.corner;
        let [right, down] = [patch.right, patch.down].map(|along| from_corner.dot(along).max(0.0) / unit.metres);
        let name = unit.name;
        Some(format!("{hours:.2} h of sun, {right:.2} {name} right and {down:.2} {name} down on its face"))
    }

    /// The drawing, the model, the table and the report.
    pub(super) fn all(&self) -> PatchesRequest {
        PatchesRequest::all(Stopwatch::after(self.outcome.timings.clone()))
    }

    /// Writes them.
    pub(super) fn write(&self, site: &Site, sink: Sink<'_>, on_event: &mut OnEvent<'_>) -> anyhow::Result<()> {
        write_patches(site, &self.outcome, &self.all(), sink, on_event)?;
        Ok(())
    }
}
