//! How two masks differ, in the terms of the design: at shadow edges, and elsewhere.

use gnomon::view::Mask;
use std::fmt;

/// Counts of cells. An edge cell is one whose 3 × 3 neighbourhood in the truth is not uniform.
#[derive(Clone, Debug, Default)]
pub(crate) struct Difference {
    pub(crate) edge_cells: u64,
    pub(crate) edge_differ: u64,
    pub(crate) other_cells: u64,
    pub(crate) other_differ: u64,
    /// Columns and rows of the other cells that differ.
    pub(crate) other_at: Vec<(u32, u32)>,
}

impl Difference {
    pub(crate) fn add(&mut self, other: Difference) {
        self.edge_cells += other.edge_cells;
        self.edge_differ += other.edge_differ;
        self.other_cells += other.other_cells;
        self.other_differ += other.other_differ;
        self.other_at.extend(other.other_at);
    }

    /// At most this share of edge cells differ, and at most one in 100,000 of the others (one cell may always).
    pub(crate) fn holds(&self, edge_share: f64) -> bool {
        let most_edge = (self.edge_cells as f64 * edge_share).max(1.0);
        let most_other = (self.other_cells as f64 / 1e5).max(1.0);
        self.edge_differ as f64 <= most_edge && self.other_differ as f64 <= most_other
    }
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let share = 100.0 * self.edge_differ as f64 / self.edge_cells.max(1) as f64;
        write!(
            f,
            "{} of {} edge cells differ ({share:.3}%), {} of {} others",
            self.edge_differ, self.edge_cells, self.other_differ, self.other_cells
        )
    }
}

/// Counts where `drawn` differs from `truth`.
pub(crate) fn compare(drawn: &Mask, truth: &Mask) -> Difference {
    assert_eq!((drawn.width, drawn.height), (truth.width, truth.height));
    let (width, height) = (truth.width as usize, truth.height as usize);
    let mut difference = Difference::default();
    for row in 0..height {
        for column in 0..width {
            let share = truth.share[row * width + column];
            let edge = (row.saturating_sub(1)..(row + 2).min(height)).any(|row| {
                let cells = &truth.share[row * width..][column.saturating_sub(1)..(column + 2).min(width)];
                cells.iter().any(|&other| other != share)
            });
            let differs = u64::from(drawn.share[row * width + column] != share);
            if edge {
                difference.edge_cells += 1;
                difference.edge_differ += differs;
            } else {
                difference.other_cells += 1;
                difference.other_differ += differs;
                if differs > 0 {
                    difference.other_at.push((column as u32, row as u32));
                }
            }
        }
    }
    difference
}

#[test]
fn one_wrong_cell_is_seen() {
    let truth = Mask { width: 40, height: 30, share: (0..1200).map(|at| if at % 40 < 20 { 0 } else { 255 }).collect() };
    let same = compare(&truth, &truth);
    assert_eq!((same.edge_differ, same.other_differ, same.edge_cells), (0, 0, 60));
    for (at, edge) in [(10 * 40 + 19, 1), (10 * 40 + 5, 0)] {
        let mut wrong = truth.clone();
        wrong.share[at] = 255;
        let difference = compare(&wrong, &truth);
        assert_eq!((difference.edge_differ, difference.other_differ), (edge, 1 - edge));
    }
    let mut two_wrong = truth.clone();
    two_wrong.share[5] = 255;
    two_wrong.share[7] = 255;
    assert!(!compare(&two_wrong, &truth).holds(0.01));
}
