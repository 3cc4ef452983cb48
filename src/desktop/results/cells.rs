//! The colours of a plan's cells on the scene, and the cell below a point.

use crate::export::figure::scale::Rgb;
use crate::picture::HoursRaster;
use crate::view::{Grid, Surface};
use glam::DVec3;

/// The colours of a plan's cells, in the form that the picture uses.
pub(in crate::desktop) fn raster<'a>(grid: &Grid, colours: &'a [Rgb], height_m: &'a [f32]) -> HoursRaster<'a> {
    let size = (grid.width, grid.height);
    HoursRaster { corner: [grid.west, grid.north], cell: grid.cell, size, colours, height_m }
}

/// The cell of a point, if the point lies on the surface that the cell sees.
pub(in crate::desktop) fn cell_at(grid: &Grid, surface: &Surface, point: DVec3) -> Option<usize> {
    let column = ((point.x - grid.west) / grid.cell).floor();
    let row = ((grid.north - point.y) / grid.cell).floor();
    let inside = column >= 0.0 && row >= 0.0 && column < f64::from(grid.width) && row < f64::from(grid.height);
    let cell = inside.then(|| row as usize * grid.width as usize + column as usize)?;
    let height = f64::from(*surface.height_m.get(cell)?);
    ((height - point.z).abs() < grid.cell.max(0.05)).then_some(cell)
}
