//! The plan's grid: as requested, or around the models and their shadows.

use super::error::{FieldLocation, SiteError};
use super::overrides::{Overrides, refuse};
use super::written::WrittenSite;
use crate::message::{Field, Message, message};
use crate::view::Grid;
use glam::DVec2;

/// The least side of a cell, metres: receivers are judged a millimetre above themselves, and models are no finer.
const LEAST_CELL_M: f64 = 0.001;

/// The default number of cells along the longer side; fewer if cells would be too small.
const DEFAULT_SIZE: u32 = 2048;
/// As floats, this many cells take 8 GiB.
const MOST_CELLS: f64 = 2_147_483_648.0;
/// The margin around the contents, as a share of the region's longer side.
const MARGIN: f64 = 0.02;

/// The grid of the requested region, or of the one around `models_and_shadows` (south-west and north-east corner).
pub(super) fn grid(
    written: &WrittenSite,
    asked: &Overrides,
    models_and_shadows: impl FnOnce() -> [DVec2; 2],
) -> Result<Grid, SiteError> {
    let [west, south, east, north] = region(written, asked, models_and_shadows)?;
    let sides = [east - west, north - south];
    let (cell, at) = cell(written, asked, sides[0].max(sides[1]))?;
    check_cell(cell, sides).map_err(|message| refuse(at, message))?;
    let [width, height] = counts(cell, sides);
    Ok(Grid {
        // turns −0 into 0
        west: west + 0.0,
        north: north + 0.0,
        cell,
        // cannot overflow: checked to be at most 2³¹
        width: width as u32,
        height: height as u32,
    })
}

/// The side of a cell as requested, directly or as a number of cells along the longer side; and where it was given.
fn cell(written: &WrittenSite, asked: &Overrides, longer: f64) -> Result<(f64, FieldLocation), SiteError> {
    Ok(match (asked.cell, asked.size, written.site.plan.cell) {
        (Some(_), Some(_), _) => {
            return Err(refuse(
                FieldLocation::Field(Field::Size),
                message!["sets the cells' size again beside ", Field::Cell; "leave one of the two out"],
            ));
        }
        (Some(cell), None, _) => (cell, FieldLocation::Field(Field::Cell)),
        (None, Some(0), _) => {
            return Err(refuse(
                FieldLocation::Field(Field::Size),
                message![
                    "it is 0";
                    "write how many lie along the longer side, for example ", (Field::Size, "2048")
                ],
            ));
        }
        (None, Some(size), _) => (longer / f64::from(size), FieldLocation::Field(Field::Size)),
        (None, None, Some(cell)) => (cell, written.key("plan", "cell")),
        (None, None, None) => ((longer / f64::from(DEFAULT_SIZE)).max(LEAST_CELL_M), written.key("plan", "region")),
    })
}

/// The number of cells along the sides of a region, metres.
fn counts(cell: f64, sides: [f64; 2]) -> [f64; 2] {
    sides.map(|side: f64| (side / cell).round().max(1.0))
}

/// Refuses cells without a size, too many for the region, or too small.
fn check_cell(cell: f64, sides: [f64; 2]) -> Result<(), Message> {
    // true for NaN
    if !(cell.is_finite() && cell > 0.0) {
        return Err(message![format!("{cell} is not the side of a cell"); "write metres above 0, for example 0.5"]);
    }
    let [width, height] = counts(cell, sides);
    if width * height > MOST_CELLS {
        let least = (sides[0] * sides[1] / MOST_CELLS).sqrt().max(sides[0].max(sides[1]) / MOST_CELLS);
        // rounded up, so that the advice works
        let least = (least * 1000.0).ceil() / 1000.0;
        return Err(message![
            format!("{width} × {height} cells are more than 2³¹");
            format!("take cells of at least {least} m, or a smaller region")
        ]);
    }
    if cell < LEAST_CELL_M {
        return Err(message![
            format!("{cell} m is too small a cell");
            format!("take at least {LEAST_CELL_M} m, or a larger region")
        ]);
    }
    Ok(())
}

/// Refuses a grid that cannot be a plan.
pub(super) fn check(grid: &Grid) -> Result<(), SiteError> {
    let Grid { west, north, cell, width, height } = *grid;
    let cells = f64::from(width) * f64::from(height);
    if !(1.0..=MOST_CELLS).contains(&cells) {
        let what = format!("{width} × {height} cells cannot be a plan");
        return Err(refuse(
            FieldLocation::Field(Field::Size),
            message![what; "take at least one cell, and at most 2³¹"],
        ));
    }
    // true for NaN
    if !(cell.is_finite() && cell >= LEAST_CELL_M) {
        let hint = format!("take metres, at least {LEAST_CELL_M}");
        return Err(refuse(
            FieldLocation::Field(Field::Cell),
            message![format!("{cell} is not the side of a cell"); hint],
        ));
    }
    if !(west.is_finite() && north.is_finite()) {
        let what = format!("({west}, {north}) is not a north-west corner");
        return Err(refuse(FieldLocation::Field(Field::Region), message![what; "give metres from the place"]));
    }
    Ok(())
}

fn region(
    written: &WrittenSite,
    asked: &Overrides,
    models_and_shadows: impl FnOnce() -> [DVec2; 2],
) -> Result<[f64; 4], SiteError> {
    const EXAMPLE: &str = "-300,-300,300,300";
    let (region, at) = match (asked.region, written.site.plan.region) {
        (Some(region), _) => (region, FieldLocation::Field(Field::Region)),
        (None, Some(region)) => (region, written.key("plan", "region")),
        (None, None) => return Ok(around(models_and_shadows())),
    };
    let [west, south, east, north] = region;
    let fault = |what: String| {
        let hint = format!("write west, south, east, north in metres, for example {EXAMPLE}");
        Err(refuse(at, message![what; hint]))
    };
    if !region.iter().all(|side| side.is_finite() && side.abs() <= 1e9) {
        return fault("a side is not a number of metres on earth".to_owned());
    }
    if west >= east {
        return fault(format!("west {west} is not less than east {east}"));
    }
    if south >= north {
        return fault(format!("south {south} is not less than north {north}"));
    }
    Ok(region)
}

/// A rectangle with a margin, and never without area.
fn around([low, high]: [DVec2; 2]) -> [f64; 4] {
    let margin = ((high - low).max_element() * MARGIN).max(0.5);
    [low.x - margin, low.y - margin, high.x + margin, high.y + margin]
}
