//! A plan in tiles, where it has more cells than the adapter draws at once, or than the memory holds.

use super::gaps::Gaps;
use super::machine::Machine;
use super::{Budget, StudyError, Wants, subject_of};
use crate::choice::Subject;
use crate::profile::accumulate::MOST_SECS;
use crate::site::Site;
use crate::view::{Grid, Tile, View};

/// Rows of the smallest tile: the models are projected once for each tile.
const LEAST_ROWS: u32 = 16;
/// Columns of a tile are a multiple of this, so that none begins within a byte of bits.
const ALIGNED: u32 = 64;

/// What one instant's plan takes at once, bytes: on an adapter 8192 × 8192 cells are still one tile.
const INSTANT_BYTES: u64 = 4 << 30;

/// The tiles of a site's plan, row after row; one where all of it can be done at once.
pub(super) fn of(site: &Site, machine: &Machine, wants: &Wants, day_secs: u32) -> Result<Vec<Tile>, StudyError> {
    let grid = site.grid;
    // sums of more days run in larger words beside
    let long = if day_secs > MOST_SECS { 24 } else { 0 };
    let subject = subject_of(site, &View::Plan(grid));
    let searches = Gaps::new(site, machine.drawn_over(site, subject).resolution_secs).any();
    let cell_bytes = machine.cell_bytes(subject, wants, searches) + long;
    let (most, columns) = columns(grid, machine);
    let row_bytes = u64::from(columns) * cell_bytes;
    let rows = match wants.budget {
        None => most,
        Some(Budget { bytes, drawing }) => {
            let least = drawing.max(row_bytes * u64::from(LEAST_ROWS.min(grid.height)));
            if bytes < least {
                return Err(StudyError::LittleMemory { asked: bytes, least, width: grid.width });
            }
            u32::try_from(bytes / row_bytes).unwrap_or(u32::MAX).min(most)
        }
    };
    Ok(split(grid, columns, rows))
}

/// The same of one instant's plan: however many cells it has, little is taken beside its mask.
pub(super) fn of_instant(grid: Grid, subject: Subject, machine: &Machine) -> Vec<Tile> {
    let (most, columns) = columns(grid, machine);
    let row_bytes = u64::from(columns) * machine.cell_bytes(subject, &Wants::default(), false);
    let rows = u32::try_from(INSTANT_BYTES / row_bytes).unwrap_or(u32::MAX).clamp(1, most);
    split(grid, columns, rows)
}

/// Returns an error if one instant's plan is more than can be drawn at once.
pub(super) fn at_once(grid: Grid, subject: Subject, machine: &Machine) -> Result<(), StudyError> {
    match of_instant(grid, subject, machine).len() {
        1 => Ok(()),
        _ => Err(StudyError::TooManyCells { width: grid.width, height: grid.height }),
    }
}

/// The most columns and rows that a machine draws at once, and how many columns tiles are to have.
fn columns(grid: Grid, machine: &Machine) -> (u32, u32) {
    let most = machine.most_cells().unwrap_or(u32::MAX);
    let columns = match grid.width.div_ceil(most) {
        1 => grid.width,
        parts => grid.width.div_ceil(parts).next_multiple_of(ALIGNED).min(most / ALIGNED * ALIGNED),
    };
    (most, columns)
}

/// Tiles of so many columns and about so many rows.
fn split(grid: Grid, columns: u32, rows: u32) -> Vec<Tile> {
    // of about the same height
    let rows = grid.height.div_ceil(grid.height.div_ceil(rows));
    let begins = |end: u32, step: u32| (0..end).step_by(step as usize);
    let tile = |row: u32, column: u32| Tile {
        plan: grid,
        first: [column, row],
        size: [columns.min(grid.width - column), rows.min(grid.height - row)],
    };
    begins(grid.height, rows).flat_map(|row| begins(grid.width, columns).map(move |at| tile(row, at))).collect()
}
