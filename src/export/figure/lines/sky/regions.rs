//! What stands in front of a point, as areas of the chart: each component in its colour, and what the point's plane
//! hides.

use super::chart::SkyChart;
use super::tones::tone;
use crate::contour::{ScalarField, contours};
use crate::export::figure::lines::line;
use crate::export::figure::scale::{Rgb, mix};
use crate::export::figure::svg::{Block, hex};
use crate::look::LOOK;
use crate::sunlight::SkyCell;
use std::collections::BTreeMap;

/// The area of one component.
pub(super) struct SkyRegion {
    /// The area as the data of a path on the field.
    data: String,
    colour: Rgb,
}

impl SkyRegion {
    pub(super) fn draw(&self, block: &mut Block) {
        /// The share of the line's colour in an outline.
        const OUTLINE: f64 = 0.4;
        let outline = mix(self.colour, LOOK.line, OUTLINE);
        // an outline in the fill's own colour would leave a seam between neighbours
        block.push(format_args!(
            "<path d=\"{}\" fill=\"{}\" fill-rule=\"evenodd\" stroke=\"{}\" stroke-width=\"1.2\" stroke-linejoin=\"round\"/>",
            self.data,
            hex(self.colour),
            hex(outline),
        ));
    }
}

/// The west, north, east and south bounds of the cells of one kind; the last two are exclusive.
type CellBox = [usize; 4];

/// The areas of a chart, what is behind the point's plane first.
pub(super) fn regions(chart: &SkyChart, colours: &[Rgb]) -> Vec<SkyRegion> {
    let (width, height) = (chart.raster.picture.width as usize, chart.raster.picture.height as usize);
    let mut boxes: BTreeMap<SkyCell, CellBox> = BTreeMap::new();
    for (index, cell) in chart.raster.cells.iter().enumerate().filter(|(_, cell)| **cell != SkyCell::Free) {
        let (column, row) = (index % width, index / width);
        let around = boxes.entry(*cell).or_insert([column, row, column, row]);
        *around = [around[0].min(column), around[1].min(row), around[2].max(column), around[3].max(row)];
    }
    let of_cell = |(cell, [west, north, east, south]): (&SkyCell, &CellBox)| {
        // one cell more on each side, so that the border of the box is not drawn as a border in the chart
        let [west, north] = [west.saturating_sub(1), north.saturating_sub(1)];
        let (columns, rows) = ((east + 2).min(width) - west, (south + 2).min(height) - north);
        let value = |at: usize| {
            let at = (north + at / columns) * width + west + at % columns;
            u64::from(chart.raster.cells[at] == *cell)
        };
        let field = ScalarField { width: columns as u32, height: rows as u32, value: &value, open: &|_, _| true };
        let mut data = String::new();
        for contour in contours(&field, 0) {
            let moved = |[column, row]: &[f64; 2]| chart.on_field([west as f64 + column, north as f64 + row]);
            line(&mut data, contour.points.iter().map(moved));
            data.push('Z');
        }
        Some(SkyRegion { data, colour: tone(*cell, colours)? })
    };
    boxes.iter().filter_map(of_cell).collect()
}
