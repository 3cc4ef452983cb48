//! The hours of sun on the models' surfaces: façades, roofs and undersides, texel by texel.

use crate::choice::{Engine, Method, Subject};
use crate::deliver::Sink;
use crate::deliver::patches::{PatchesRequest, write_patches};
use crate::desktop::state::pick::PickedPoint;
use crate::desktop::state::settings::WindowSettings;
use crate::desktop::state::unit::Unit;
use crate::export::figure::scale::Rgb;
use crate::export::patches::Atlas;
use crate::picture::{PatchColours, Picture};
use crate::shadow::ShadowError;
use crate::site::Site;
use crate::study::{OnEvent, PatchOutcome, Stopwatch};

/// The hours of sun on patches.
pub(in crate::desktop) struct Facades {
    pub(in crate::desktop) outcome: PatchOutcome,
    pub(in crate::desktop) atlas: Atlas,
    /// The atlas in the drawing's colours.
    pub(in crate::desktop) pages: Vec<Vec<Rgb>>,
    /// The meaning of the colours.
    pub(in crate::desktop) legend: (String, Vec<(Rgb, String)>),
}

/// The technique that judges patches: the window's technique if it can, otherwise the fastest that can.
pub(in crate::desktop) fn method(settings: &WindowSettings) -> Method {
    let method = settings.shown.method;
    if method.row().draws(Engine::Auto, Subject::Patches) { method } else { Method::Auto }
}

impl Facades {
    /// Shows the hours on a picture of the site for which they were computed, or of its visible part.
    ///
    /// # Errors
    /// If the adapter cannot hold them.
    pub(in crate::desktop) fn lay(
        &self,
        picture: &mut Picture,
        site: &Site,
        visible: &Site,
    ) -> Result<(), ShadowError> {
        let components = site.mesh.components.iter().zip(site.receives.iter().zip(&visible.receives));
        let received = components.filter(|(_, (receives, _))| **receives);
        let faces = received.flat_map(|(component, (_, visible))| std::iter::repeat_n(*visible, component.faces.len()));
        let patch_of = self.atlas.patch_of.iter().zip(faces).filter(|(_, visible)| *visible).map(|(patch, _)| *patch);
        let patch_of: Vec<_> = patch_of.collect();
        picture.lay_patches(&PatchColours { patches: &self.outcome.patches, patch_of: &patch_of, pages: &self.pages })
    }

    /// The hours of sun at a point, and its position on its surface.
    pub(in crate::desktop) fn said(&self, under: &PickedPoint, unit: Unit) -> Option<String> {
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
    pub(in crate::desktop) fn all(&self) -> PatchesRequest {
        PatchesRequest::all(Stopwatch::after(self.outcome.timings.clone()))
    }

    /// Writes them.
    pub(in crate::desktop) fn write(
        &self,
        site: &Site,
        sink: Sink<'_>,
        on_event: &mut OnEvent<'_>,
    ) -> anyhow::Result<()> {
        write_patches(site, &self.outcome, &self.all(), sink, on_event)?;
        Ok(())
    }
}
