//! The model coloured by hours of sun, as the camera sees it or from a side.

use super::panel::{Panel, thousands};
use super::perspective::{PixelRays, facing};
use super::scale::{NO_SUN, Rgb};
use super::{FigureContext, check_surface, lens, page, panel, perspective, words};
use crate::export::ExportError;
use crate::export::patches::{Atlas, PatchContext};
use crate::look::LOOK;
use crate::view::{Surface, View};
use glam::Vec4Swizzles as _;
use rayon::prelude::*;

/// `surfaces.png`: the hours of sun on the patches that a camera or a side sees. The mesh of `scene` contains only
/// receivers.
///
/// [`ExportError::Size`] if the surface does not fill the view; [`ExportError::Encode`] from the encoder, and for a
/// plan.
pub fn patches(scene: &FigureContext, view: &View, found: &PatchContext) -> Result<Vec<u8>, ExportError> {
    let size = view.size();
    check_surface(scene.surface, size)?;
    let mut panel = labelled(scene, found);
    let (lens, cell) = lens(view, &mut panel)?;
    let of_cells = painted(scene, &lens, found);
    let draw = |fit| perspective::painted(scene, &lens, &of_cells, true, fit);
    page::page(&panel, size, cell, draw, page::png)
}

fn labelled(scene: &FigureContext, found: &PatchContext) -> Panel {
    let (hours, patches) = (found.hours, found.patches);
    let mut panel = panel(scene, "Sun on surfaces");
    panel
        .facts
        .push(("Texels", format!("{} of {}", thousands(patches.texels.len() as f64), words::metres(patches.cell))));
    if hours.night_secs > 0 {
        let night = words::duration(hours.night_secs);
        panel.facts.push(("Night", format!("{night} of the window, not counted")));
    }
    (panel.legend_head, panel.legend) = legend(found);
    panel
}

/// The meaning of the colours: a heading, and each colour with its label, the most sun first.
pub fn legend(found: &PatchContext) -> (String, Vec<(Rgb, String)>) {
    let bands = found.bands();
    let head = match found.hours.day_secs {
        0 => "No sun in this window".to_owned(),
        day => format!("Hours of sun out of {}", words::duration(day)),
    };
    let with_secs = !bands.band_secs.is_multiple_of(60);
    let entry = |band: usize| {
        let (from, to) = bands.bounds(band);
        let [from, to] = [from, to].map(|secs| words::hours(secs, with_secs));
        (bands.colours[bands.colours.len() - 1 - band], format!("{from} – {to}"))
    };
    let bands = (0..bands.colours.len()).rev().map(entry);
    let rest = [(NO_SUN, "none".to_owned()), (LOOK.not_judged, super::UNJUDGED.to_owned())];
    (head, bands.chain(rest).collect())
}

/// The colour of each pixel. The colours of sky pixels are not used.
pub(super) fn painted(scene: &FigureContext, lens: &PixelRays, found: &PatchContext) -> Vec<Rgb> {
    let (patches, bands, samples) = (found.patches, found.bands(), found.hours.samples);
    // the scene has only the faces of components that receive
    let atlas = Atlas::of(found);
    let width = scene.surface.width as usize;
    let colour = |pixel: usize| {
        let face = scene.surface.face[pixel];
        if face >= Surface::GROUND {
            return LOOK.hours_ground;
        }
        let plane = facing(scene, face, lens.viewer);
        let Some(patch) = atlas.patch(patches, face, plane.xyz()) else { return LOOK.not_judged };
        let (column, row) = (pixel % width, pixel / width);
        let (start, ray) = (lens.start(column, row), lens.ray(column, row));
        let depth = -plane.dot(start.extend(1.0)) / plane.xyz().dot(ray);
        bands.of_sun(atlas.lit(patches, patch, start + ray * depth - patches.origin), samples)
    };
    (0..scene.surface.face.len()).into_par_iter().map(colour).collect()
}
