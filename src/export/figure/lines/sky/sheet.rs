//! The sheet: both charts, and the panel beside them.

use super::chart::SkyChart;
use super::context::{CELL, DISC, STRIP, SkyContext};
use super::panel;
use crate::export::ExportError;
use crate::export::figure::lines::labels::Labels;
use crate::export::figure::lines::{LineDrawing, group};
use crate::export::figure::svg::{Block, INK, LetterStyle, TextAnchor};
use crate::export::figure::text::FontWeight;
use crate::export::figure::{Screen, page};
use crate::sunlight::SkyRaster;
use crate::view::{SkyPicture, SkyProjection};

/// The style of all labels within a chart.
const LABEL: LetterStyle = LetterStyle { size: 27.0, weight: FontWeight::Bold, colour: INK };
/// The least distance between equal labels: an hour has one at either end of its line.
const APART: f64 = 90.0;

/// The sheet of a point.
pub fn sky_sheet(shown: &SkyContext, rasters: &[SkyRaster; 2]) -> LineDrawing {
    let panel = panel::panel(shown, &rasters[1]);
    LineDrawing(page::whole_chart(&panel, |field| sheet(shown, rasters, field)))
}

/// Both charts in a field of this many pixels.
fn sheet(shown: &SkyContext, [disc, strip]: &[SkyRaster; 2], field: (u32, u32)) -> Block {
    /// The room around a chart for the labels at its rim.
    const RIM: f64 = 96.0;
    let (width, height) = (f64::from(field.0), f64::from(field.1));
    let charts = [
        SkyChart::at([(width - f64::from(DISC)) / 2.0, RIM - 20.0], disc, CELL),
        SkyChart::at([(width - f64::from(STRIP)) / 2.0, height - f64::from(STRIP / 4) - RIM], strip, CELL),
    ];
    let mut block = Block::default();
    for chart in &charts {
        head(&mut block, chart);
        group(&mut block, chart.name(), |block| {
            chart.ground(block, shown.colours);
            chart.ways(block, shown);
            chart.rim(block);
        });
    }
    let mut labels = Labels::new(field, LABEL, APART);
    charts.iter().for_each(|chart| chart.avoid(&mut labels, shown));
    charts.iter().for_each(|chart| chart.mark(&mut labels, shown));
    labels.draw(&mut block);
    block
}

/// The title above a chart.
fn head(block: &mut Block, chart: &SkyChart) {
    let (name, what) = match chart.raster.picture.projection {
        SkyProjection::Stereographic => ("Stereographic", "zenith in the middle, north up, as in a plan"),
        SkyProjection::Cylindrical { .. } => ("Cylindrical", "azimuth across, altitude up, degrees of one length"),
    };
    let (x, y) = match chart.raster.picture.projection {
        SkyProjection::Stereographic => (0.0, 34.0),
        SkyProjection::Cylindrical { .. } => (chart.corner[0], chart.corner[1] - 62.0),
    };
    block.text(x, y, TextAnchor::Start, LetterStyle::HEAD, name);
    block.text(x, y + LetterStyle::FINE.leading(), TextAnchor::Start, LetterStyle::FINE, what);
}

/// The width and the height of a card's picture, and the margin around its disc: pixels.
const CARD: u32 = 580;
const CARD_MARGIN: u32 = 50;

/// The picture for which a card needs a raster.
pub fn card_picture() -> SkyPicture {
    SkyPicture::stereographic(CARD - 2 * CARD_MARGIN)
}

/// The stereographic chart alone, for a card on a screen: without months, sundial and times.
///
/// # Errors
/// [`ExportError::Encode`] if it cannot be drawn.
pub fn sky_card(shown: &SkyContext, raster: &SkyRaster) -> Result<Screen, ExportError> {
    const SMALL: LetterStyle = LetterStyle { size: 21.0, ..LABEL };
    let chart = SkyChart::small([f64::from(CARD_MARGIN); 2], raster);
    let mut block = Block::default();
    chart.ground(&mut block, shown.colours);
    chart.ways(&mut block, shown);
    chart.rim(&mut block);
    let mut labels = Labels::new((CARD, CARD), SMALL, 0.0);
    chart.avoid(&mut labels, shown);
    chart.mark(&mut labels, shown);
    labels.draw(&mut block);
    Ok(Screen { width: CARD, height: CARD, pixels: page::part(&block, (CARD, CARD))? })
}
