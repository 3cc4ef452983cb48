//! How two masks differ, at shadow edges and elsewhere.
//!
//! An *edge cell* is one whose 3 × 3 neighbourhood in the truth is not uniform. There a rasteriser may differ slightly,
//! since it rounds corners to 1/256 of a cell. Elsewhere it may not, except next to things thinner than a cell.

use super::is_edge_cell;
use crate::shadow::ray_cast::RayCast;
use crate::shadow::{ShadowError, Technique};
use crate::view::{Camera, Elevation, Grid, Mask, View};
use glam::{DVec3, dvec2};
use std::fmt;

/// Counts of cells, of one pair of masks or of several.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Difference {
    /// The number of edge cells of the truth.
    pub edge_cells: u64,
    /// The number of edge cells that differ.
    pub edge_differ: u64,
    /// The number of all other cells.
    pub other_cells: u64,
    /// The number of other cells that differ.
    pub other_differ: u64,
    /// Columns and rows of the edge cells that differ.
    pub edge_at: Vec<(u32, u32)>,
    /// Columns and rows of the other cells that differ.
    pub other_at: Vec<(u32, u32)>,
}

impl Difference {
    /// Counts the cells in which `drawn` differs from `truth`, a mask of the same size.
    #[cfg(feature = "test-hooks")]
    pub fn between(drawn: &Mask, truth: &Mask) -> Difference {
        Difference::in_all(drawn, truth, |share, truth| share != truth)
    }

    /// The same for soft shadows: a cell differs if its share is off by more than half the sun.
    pub fn by_half(drawn: &Mask, truth: &Mask) -> Difference {
        Difference::in_all(drawn, truth, off_by_half)
    }

    fn in_all(drawn: &Mask, truth: &Mask, differs: fn(u8, u8) -> bool) -> Difference {
        assert_eq!((drawn.width, drawn.height), (truth.width, truth.height));
        let mut difference = Difference::default();
        for row in 0..truth.height {
            for column in 0..truth.width {
                let cell = (row * truth.width + column) as usize;
                let differs = differs(drawn.share[cell], truth.share[cell]);
                difference.count(is_edge_cell(truth, column, row), differs.then_some((column, row)));
            }
        }
        difference
    }

    /// Counts the cells (column and row) of a mask that are off by more than half the sun; `truth` has their shares.
    pub fn at(cells: &[(u32, u32)], mask: &Mask, truth: &[u8]) -> Difference {
        assert_eq!(cells.len(), truth.len());
        let mut difference = Difference::default();
        for (&(column, row), &truth) in cells.iter().zip(truth) {
            let differs = off_by_half(mask.share[(row * mask.width + column) as usize], truth);
            difference.count(is_edge_cell(mask, column, row), differs.then_some((column, row)));
        }
        difference
    }

    fn count(&mut self, edge: bool, differs_at: Option<(u32, u32)>) {
        let (cells, differ, at) = match edge {
            true => (&mut self.edge_cells, &mut self.edge_differ, &mut self.edge_at),
            false => (&mut self.other_cells, &mut self.other_differ, &mut self.other_at),
        };
        *cells += 1;
        *differ += u64::from(differs_at.is_some());
        at.extend(differs_at);
    }

    /// Removes other cells that contain a shadow or a sunlit spot thinner than a cell: when the truth is cast again in
    /// finer cells, their neighbourhood is not uniform. Afterwards `truth` is turned back to `view`.
    ///
    /// # Errors
    /// As [`Technique::draw`].
    pub fn except_thin(&mut self, truth: &mut RayCast, view: View, to_sun: DVec3) -> Result<(), ShadowError> {
        if self.other_at.is_empty() {
            return Ok(());
        }
        let mut thick = Vec::new();
        match view {
            View::Plan(grid) => {
                for &(column, row) in &self.other_at {
                    let corner = grid.centre(column, row) + dvec2(-1.5, 1.5) * grid.cell;
                    let fine = Grid { west: corner.x, north: corner.y, cell: grid.cell / 8.0, width: 24, height: 24 };
                    truth.look_at(View::Plan(fine));
                    let fine = truth.draw(to_sun)?.read()?;
                    if fine.share.iter().all(|&share| share == fine.share[0]) {
                        thick.push((column, row));
                    }
                }
            }
            View::Camera(_) | View::Elevation(_) => {
                let (width, height) = view.size();
                let (width, height) = (width * 5, height * 5);
                truth.look_at(match view {
                    View::Camera(camera) => View::Camera(Camera { width, height, ..camera }),
                    View::Elevation(side) => {
                        View::Elevation(Elevation { width, height, cell: side.cell / 5.0, ..side })
                    }
                    View::Plan(_) => view,
                });
                let fine = truth.draw(to_sun)?.read()?;
                let uniform = |&(column, row): &(u32, u32)| {
                    let rows = (row.max(1) - 1) * 5..((row + 2) * 5).min(height);
                    let columns = (column.max(1) - 1) * 5..((column + 2) * 5).min(width);
                    let share = |column, row| fine.share[(row * width + column) as usize];
                    let first = share(columns.start, rows.start);
                    rows.into_iter().all(|row| columns.clone().all(|column| share(column, row) == first))
                };
                thick.extend(self.other_at.iter().copied().filter(uniform));
            }
        }
        truth.look_at(view);
        self.other_differ = thick.len() as u64;
        self.other_at = thick;
        Ok(())
    }

    /// Adds the counts of another pair of masks.
    pub fn add(&mut self, other: Difference) {
        self.edge_cells += other.edge_cells;
        self.edge_differ += other.edge_differ;
        self.other_cells += other.other_cells;
        self.other_differ += other.other_differ;
        self.edge_at.extend(other.edge_at);
        self.other_at.extend(other.other_at);
    }

    /// The number of cells that were counted.
    pub fn cells(&self) -> u64 {
        self.edge_cells + self.other_cells
    }

    /// The number of cells that differ.
    pub fn differ(&self) -> u64 {
        self.edge_differ + self.other_differ
    }

    /// The share of the edge cells that differs.
    pub fn edge_share(&self) -> f64 {
        self.edge_differ as f64 / self.edge_cells.max(1) as f64
    }

    /// Whether at most this share of the edge cells differs, and at most one in 100,000 of the others (one cell is
    /// always allowed).
    pub fn holds(&self, edge_share: f64) -> bool {
        let most_edge = (self.edge_cells as f64 * edge_share).max(1.0);
        let most_other = (self.other_cells as f64 / 1e5).max(1.0);
        self.edge_differ as f64 <= most_edge && self.other_differ as f64 <= most_other
    }
}

fn off_by_half(share: u8, truth: u8) -> bool {
    share.abs_diff(truth) > 127
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} of {} edge cells differ ({:.3}%), {} of {} others",
            self.edge_differ,
            self.edge_cells,
            100.0 * self.edge_share(),
            self.other_differ,
            self.other_cells
        )
    }
}
