//! One chart: its position on the sheet, and the positions of directions in it.

use crate::export::figure::lines::{SvgNumber, line};
use crate::export::figure::scale::Rgb;
use crate::export::figure::svg::{Block, hex};
use crate::sunlight::SkyRaster;
use crate::view::SkyProjection;
use glam::DVec3;

/// A chart, which is a raster of the sky on the sheet.
pub(super) struct SkyChart<'a> {
    /// Its top left corner on the field, pixels.
    pub(super) corner: [f64; 2],
    pub(super) raster: &'a SkyRaster,
    /// The side of a cell, pixels.
    cell: f64,
    /// The scale of lines and of the labels' distances from them: 1 on a sheet.
    pub(super) pen: f64,
}

impl<'a> SkyChart<'a> {
    /// A chart on a sheet.
    pub(super) fn at(corner: [f64; 2], raster: &'a SkyRaster, cell: f64) -> SkyChart<'a> {
        SkyChart { corner, raster, cell, pen: 1.0 }
    }

    /// A chart on a card, one pixel per cell: with thin lines, and without what would be too small to read.
    pub(super) fn small(corner: [f64; 2], raster: &'a SkyRaster) -> SkyChart<'a> {
        SkyChart { corner, raster, cell: 1.0, pen: 0.55 }
    }

    pub(super) fn is_small(&self) -> bool {
        self.pen < 1.0
    }

    pub(super) fn name(&self) -> &'static str {
        match self.raster.picture.projection {
            SkyProjection::Stereographic => "stereographic",
            SkyProjection::Cylindrical { .. } => "cylindrical",
        }
    }

    /// Width and height, pixels.
    pub(super) fn size(&self) -> [f64; 2] {
        [self.raster.picture.width, self.raster.picture.height].map(|cells| f64::from(cells) * self.cell)
    }

    /// The position of a point of the raster on the field.
    pub(super) fn on_field(&self, [column, row]: [f64; 2]) -> [f64; 2] {
        [self.corner[0] + column * self.cell, self.corner[1] + row * self.cell]
    }

    /// The position of a direction on the field.
    pub(super) fn place(&self, to: DVec3) -> [f64; 2] {
        self.on_field(self.raster.picture.place(to).to_array())
    }

    /// A line on the field, in several parts if it leaves the strip on one side and comes in on the other.
    pub(super) fn parts(&self, run: &[DVec3]) -> Vec<Vec<[f64; 2]>> {
        let half = self.size()[0] / 2.0;
        let mut parts: Vec<Vec<[f64; 2]>> = vec![Vec::new()];
        for at in run.iter().map(|to| self.place(*to)) {
            let before = parts.last().and_then(|part| part.last());
            let is_far = before.is_some_and(|before| (at[0] - before[0]).abs() > half);
            if is_far && matches!(self.raster.picture.projection, SkyProjection::Cylindrical { .. }) {
                parts.push(Vec::new());
            }
            if let Some(part) = parts.last_mut() {
                part.push(at);
            }
        }
        parts.retain(|part| part.len() > 1);
        parts
    }

    /// The chart's outline as an element that is left open.
    pub(super) fn shape(&self) -> String {
        let ([x, y], [width, height]) = (self.corner, self.size());
        match self.raster.picture.projection {
            SkyProjection::Stereographic => {
                let radius = width / 2.0;
                format!("<circle cx=\"{}\" cy=\"{}\" r=\"{radius}\"", x + radius, y + radius)
            }
            SkyProjection::Cylindrical { .. } => {
                format!("<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\"")
            }
        }
    }

    /// Lines of one kind, dashed if the kind is.
    pub(super) fn stroke(
        &self,
        block: &mut Block,
        parts: &[Vec<[f64; 2]>],
        width: f64,
        colour: Rgb,
        dashes: Option<&str>,
    ) {
        let mut data = String::new();
        parts.iter().for_each(|part| line(&mut data, part.iter().copied()));
        if data.is_empty() {
            return;
        }
        let dashes = dashes.map_or_else(String::new, |dashes| format!(" stroke-dasharray=\"{dashes}\""));
        block.push(format_args!(
            "<path d=\"{data}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\"{dashes}/>",
            hex(colour),
            SvgNumber(width * self.pen),
        ));
    }
}

/// A direction by azimuth and altitude, degrees.
pub(super) fn direction(azimuth_deg: f64, altitude_deg: f64) -> DVec3 {
    let ([sin_azimuth, cos_azimuth], [sin_altitude, cos_altitude]) =
        (azimuth_deg.to_radians().sin_cos().into(), altitude_deg.to_radians().sin_cos().into());
    DVec3::new(sin_azimuth * cos_altitude, cos_azimuth * cos_altitude, sin_altitude)
}
