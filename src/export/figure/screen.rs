//! A drawing for a screen: the sheet as on paper, but with fewer pixels.

use super::components::Components;
use super::page::Sheet;
use super::paper::{HEIGHT, WIDTH};
use super::perspective::{self, OwnColours, PixelRays};
use super::picture::{Fit, Pixels};
use super::scale::Rgb;
use super::{FigureContext, PictureExtras, instant_as, plan};
use crate::export::{ExportError, raster};
use crate::view::{Mask, View};
use glam::DVec3;
use image::imageops::{self, FilterType};
use image::{ImageBuffer, RgbImage};

/// The pixels of a drawing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Screen {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Row 0 first.
    pub pixels: Vec<Rgb>,
}

impl Screen {
    /// The drawing as a PNG, compressed fast.
    ///
    /// # Errors
    /// [`ExportError::Encode`] from the encoder.
    pub fn png(&self) -> Result<Vec<u8>, ExportError> {
        let kind = (png::ColorType::Rgb, png::BitDepth::Eight);
        raster::png_bytes((self.width, self.height), kind, None, bytemuck::cast_slice(&self.pixels))
            .map_err(|error| ExportError::encode("drawing", error))
    }
}

/// As [`super::instant`], but `width` pixels wide (1 to [`WIDTH`]) and as high as a sheet of that width: each pixel is
/// the mean of the sheet's pixels under it.
///
/// # Errors
/// As [`super::instant`].
pub fn instant_on_screen(
    scene: &FigureContext,
    view: &View,
    mask: &Mask,
    shown: &PictureExtras,
    width: u32,
) -> Result<Screen, ExportError> {
    instant_as(scene, view, mask, shown, |sheet| on_screen(sheet, width))
}

fn on_screen(sheet: &Sheet, width: u32) -> Result<Screen, ExportError> {
    let pixels = sheet.pixels();
    if width == WIDTH {
        return Ok(Screen { width, height: HEIGHT, pixels });
    }
    let height = (u64::from(width) * u64::from(HEIGHT)).div_ceil(u64::from(WIDTH)) as u32;
    let sheet: RgbImage = ImageBuffer::from_raw(WIDTH, HEIGHT, bytemuck::cast_vec(pixels))
        .ok_or_else(|| ExportError::encode("drawing", "its pixels do not fill the sheet"))?;
    let small = imageops::resize(&sheet, width, height, FilterType::Triangle);
    let pixels = small.pixels().map(|pixel| pixel.0).collect();
    Ok(Screen { width, height, pixels })
}

/// Sun and shadow of a view without a sheet around them: one pixel per cell, row 0 first. Of `shown`, only the
/// components' colours apply, and only in a camera's picture.
pub fn bare(scene: &FigureContext, view: &View, mask: &Mask, to_sun: DVec3, shown: &PictureExtras) -> Vec<Rgb> {
    let fit = cell_by_cell(view);
    let lens = match view {
        View::Plan(grid) => return all(&plan::instant(scene, grid.cell, mask, fit)),
        View::Camera(camera) => PixelRays::new(camera),
        View::Elevation(side) => PixelRays::of_side(side),
    };
    let components = shown.casts.map(|casts| Components::new(scene.mesh, scene.surface, casts));
    let painted = OwnColours { components: components.as_ref(), of_cells: None };
    perspective::instant(scene, &lens, mask, to_sun, painted, fit).pixels
}

/// As [`bare`], but the hours of a plan.
#[cfg(feature = "test-hooks")]
pub fn bare_hours(scene: &FigureContext, profile: &crate::profile::Profile) -> Vec<Rgb> {
    let bands = super::scale::Bands::new(scene.track.step_secs, profile.day_secs);
    all(&plan::profile(scene, profile, &bands, cell_by_cell(&View::Plan(profile.grid))))
}

/// As [`bare`], but the hours on the patches that a camera or a side sees. Nothing for a plan, which has no such
/// drawing.
#[cfg(feature = "test-hooks")]
pub fn bare_patches(
    scene: &FigureContext,
    view: &View,
    found: &crate::export::patches::PatchContext,
) -> Option<Vec<Rgb>> {
    let lens = match view {
        View::Plan(_) => return None,
        View::Camera(camera) => PixelRays::new(camera),
        View::Elevation(side) => PixelRays::of_side(side),
    };
    let of_cells = super::patches::painted(scene, &lens, found);
    Some(perspective::painted(scene, &lens, &of_cells, true, cell_by_cell(view)).pixels)
}

fn cell_by_cell(view: &View) -> Fit {
    Fit { cells: view.size(), pixels: view.size() }
}

fn all(picture: &impl Pixels) -> Vec<Rgb> {
    let (width, height) = picture.size();
    let mut pixels = vec![Rgb::default(); width as usize * height as usize];
    picture.draw(0, &mut pixels);
    pixels
}
