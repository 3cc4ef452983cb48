//! The shadow edges of a mask.

use crate::view::Mask;

/// The distances of a mask's cells from its shadow edge: from the nearest cell on the other side of half the sun.
///
/// The first half of Meijster, Roerdink and Hesselink, *A general algorithm for computing distance transforms in linear
/// time* (2000): distances along the columns. The second, along the rows, is only computed for requested cells.
pub struct Edges<'a> {
    mask: &'a Mask,
    /// For each cell, the distance to the nearest cell of its column on the other side; `u32::MAX` if there is none.
    along_column: Vec<u32>,
}

impl Edges<'_> {
    /// Computes the distances along all columns, down and up.
    pub fn of(mask: &Mask) -> Edges<'_> {
        let width = mask.width as usize;
        let mut along_column = vec![u32::MAX; mask.share.len()];
        let mut step = |cell: usize, from: usize| {
            let steps = if lit(mask, cell) == lit(mask, from) { along_column[from].saturating_add(1) } else { 1 };
            along_column[cell] = along_column[cell].min(steps);
        };
        (width..mask.share.len()).for_each(|cell| step(cell, cell - width));
        (0..mask.share.len().saturating_sub(width)).rev().for_each(|cell| step(cell, cell + width));
        Edges { mask, along_column }
    }

    /// The distance between the centres, in cells: 1 right at the edge; `None` if the mask has no edge.
    pub fn distance(&self, column: u32, row: u32) -> Option<f64> {
        let Mask { width, .. } = *self.mask;
        let first = row as usize * width as usize;
        let side = lit(self.mask, first + column as usize);
        let mut least = u64::MAX;
        for aside in 0..width {
            let aside_squared = u64::from(aside).pow(2);
            if aside_squared >= least {
                break;
            }
            let beside = [column.checked_sub(aside), column.checked_add(aside).filter(|&column| column < width)];
            for column in beside.into_iter().flatten() {
                let cell = first + column as usize;
                match (lit(self.mask, cell) != side, self.along_column[cell]) {
                    (true, _) => least = least.min(aside_squared),
                    (false, u32::MAX) => (),
                    (false, along) => least = least.min(aside_squared + u64::from(along).pow(2)),
                }
            }
        }
        (least < u64::MAX).then(|| (least as f64).sqrt())
    }
}

fn lit(mask: &Mask, cell: usize) -> bool {
    mask.share[cell] > 127
}

/// Whether the 3 × 3 neighbourhood of a cell is not uniform.
pub fn is_edge_cell(truth: &Mask, column: u32, row: u32) -> bool {
    let [width, height, column, row] = [truth.width, truth.height, column, row].map(|number| number as usize);
    let share = truth.share[row * width + column];
    (row.saturating_sub(1)..(row + 2).min(height)).any(|row| {
        let cells = &truth.share[row * width..][column.saturating_sub(1)..(column + 2).min(width)];
        cells.iter().any(|&other| other != share)
    })
}
