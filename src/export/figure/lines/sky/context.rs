//! The data from which a sheet of a point's sky is drawn.

use crate::export::figure::component_colours;
use crate::export::figure::scale::Rgb;
use crate::mesh::Mesh;
use crate::site::Ground;
use crate::sun::Place;
use crate::sunlight::{ProbeWay, SkyLines, Sunlight};
use crate::view::SkyPicture;
use std::f64::consts::PI;

/// The data of one point's sheet.
pub struct SkyContext<'a> {
    /// The place.
    pub place: &'a Place,
    /// The ground.
    pub ground: &'a Ground,
    /// The results of all points.
    pub sunlight: &'a Sunlight,
    /// The index of the point.
    pub probe: usize,
    /// The lines of the year.
    pub lines: &'a SkyLines,
    /// The sun's ways on the requested days.
    pub ways: &'a [ProbeWay],
    /// The colour of each of [`Sunlight::components`].
    pub colours: &'a [Rgb],
}

/// The diameter of the disc and the width of the strip, and the side of a cell of what stands in front of the point:
/// pixels of the page.
pub(super) const DISC: u32 = 1400;
pub(super) const STRIP: u32 = 2240;
pub(super) const CELL: f64 = 2.0;

/// The pictures for which a sheet needs rasters: the stereographic one, then the cylindrical one, with the sun's noon
/// in its middle.
pub fn sky_pictures(place: &Place) -> [SkyPicture; 2] {
    let middle_rad = if place.latitude_deg < 0.0 { 0.0 } else { PI };
    let cells = |pixels: u32| (f64::from(pixels) / CELL) as u32;
    [SkyPicture::stereographic(cells(DISC)), SkyPicture::cylindrical(cells(STRIP), middle_rad)]
}

/// The colours of the components that cast, in the order of [`Sunlight::components`].
pub fn sky_colours(mesh: &Mesh, casts: &[bool]) -> Vec<Rgb> {
    let all = component_colours(mesh, casts).into_iter().zip(casts);
    all.filter(|(_, casts)| **casts).map(|(colour, _)| colour).collect()
}
