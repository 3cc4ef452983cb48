//! The terrain as an ASCII grid in EPSG:25833.

use super::{EASTING, NORTHING, height};
use std::fmt::Write as _;

/// Metres of a cell's side, and cells to a side.
const CELL: f64 = 4.0;
const CELLS: i32 = 131;

pub(super) fn ascii_grid() -> String {
    let half = CELL * f64::from(CELLS) / 2.0;
    let (west, south) = ((EASTING - half).floor(), (NORTHING - half).floor());
    let mut text = format!(
        "ncols {CELLS}\nnrows {CELLS}\nxllcorner {west:.0}\nyllcorner {south:.0}\ncellsize {CELL:.0}\nNODATA_value -9999\n"
    );
    for row in 0..CELLS {
        let north = south + CELL * (f64::from(CELLS - 1 - row) + 0.5) - NORTHING;
        for column in 0..CELLS {
            let east = west + CELL * (f64::from(column) + 0.5) - EASTING;
            let gap = if column == 0 { "" } else { " " };
            // heights to the centimetre, as surveyors give them
            let _ = write!(text, "{gap}{:.2}", height(east, north));
        }
        text.push('\n');
    }
    text
}
