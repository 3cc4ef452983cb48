//! Splits a plan into tiles if it has more cells than the adapter can draw at once, or than fit in memory.

use super::gaps::Gaps;
use super::machine::Machine;
use super::{Budget, StudyError, Wants, subject_of};
use crate::choice::Subject;
use crate::profile::accumulate::MOST_SECS;
use crate::site::Site;
use crate::view::{Grid, Tile, View};

/// The rows of the smallest tile: each tile costs a projection of the models.
const LEAST_ROWS: u32 = 16;
/// A tile's columns are a multiple of this, so that no tile begins within a byte of bits.
const ALIGNED: u32 = 64;

/// The memory for one instant's plan, bytes: 8192 × 8192 cells on an adapter are still one tile.
const INSTANT_BYTES: u64 = 4 << 30;

/// The tiles of a site's plan, row by row; a single one if the plan fits.
pub(super) fn of(site: &Site, machine: &Machine, wants: &Wants, day_secs: u32) -> Result<Vec<Tile>, StudyError> {
    let grid = site.grid;
    // sums of more days need additional larger words
    let long = if day_secs > MOST_SECS { 24 } else { 0 };
    let subject = subject_of(site, &View::Plan(grid));
    let searches = Gaps::new(site, machine.drawn_over(site, subject).resolution_secs).any();
    let cell_bytes = machine.cell_bytes(subject, wants, searches) + long;
    let (most, columns) = columns(grid, machine);
    let row_bytes = u64::from(columns) * cell_bytes;
    let tile_bytes = u64::from(columns) * machine.column_bytes(subject, searches);
    let rows = match wants.budget {
        None => most,
        Some(Budget { bytes, drawing }) => {
            let least = drawing.max(row_bytes * u64::from(LEAST_ROWS.min(grid.height)) + tile_bytes);
            if bytes < least {
                return Err(StudyError::LittleMemory { asked: bytes, least, width: grid.width });
            }
            u32::try_from((bytes - tile_bytes) / row_bytes).unwrap_or(u32::MAX).min(most)
        }
    };
    Ok(split(grid, columns, rows))
}

/// The tiles of one instant's plan, which needs little memory besides its mask.
pub(super) fn of_instant(grid: Grid, subject: Subject, machine: &Machine) -> Vec<Tile> {
    let (most, columns) = columns(grid, machine);
    let row_bytes = u64::from(columns) * machine.cell_bytes(subject, &Wants::default(), false);
    let rows = u32::try_from(INSTANT_BYTES / row_bytes).unwrap_or(u32::MAX).clamp(1, most);
    split(grid, columns, rows)
}

/// Refuses one instant's plan if it cannot be drawn at once.
pub(super) fn at_once(grid: Grid, subject: Subject, machine: &Machine) -> Result<(), StudyError> {
    match of_instant(grid, subject, machine).len() {
        1 => Ok(()),
        _ => Err(StudyError::TooManyCells { width: grid.width, height: grid.height }),
    }
}

/// The greatest number of columns and rows that a machine draws at once, and the number of columns for the tiles.
fn columns(grid: Grid, machine: &Machine) -> (u32, u32) {
    let most = machine.most_cells().unwrap_or(u32::MAX);
    let columns = match grid.width.div_ceil(most) {
        1 => grid.width,
        parts => grid.width.div_ceil(parts).next_multiple_of(ALIGNED).min(most / ALIGNED * ALIGNED),
    };
    (most, columns)
}

/// Tiles with this many columns and about this many rows.
fn split(grid: Grid, columns: u32, rows: u32) -> Vec<Tile> {
    // all of about the same height
    let rows = grid.height.div_ceil(grid.height.div_ceil(rows));
    let begins = |end: u32, step: u32| (0..end).step_by(step as usize);
    let tile = |row: u32, column: u32| Tile {
        plan: grid,
        first: [column, row],
        size: [columns.min(grid.width - column), rows.min(grid.height - row)],
    };
    begins(grid.height, rows).flat_map(|row| begins(grid.width, columns).map(move |at| tile(row, at))).collect()
}
