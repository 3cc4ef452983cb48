//! Cells of a raster, as a bit each: of which rays are asked, and which of these are blocked.

use std::ops::Range;

/// The side of the squares of cells whose rays are tested together. They begin at whole bytes.
pub(super) const SQUARE_SIDE: u32 = 8;

/// A bit for each cell of a raster; eight columns are a byte, the first the lowest bit.
#[derive(Clone, Debug, Default)]
pub struct CellSet {
    bytes: Vec<u8>,
    in_row: usize,
}

/// Some columns and rows of a raster. Columns begin at a whole byte, and end at one or at the raster's border.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CellRectangle {
    pub(super) columns: Range<u32>,
    pub(super) rows: Range<u32>,
}

impl CellSet {
    /// Makes it a set of no cells of a raster, and keeps its memory.
    pub fn reset(&mut self, width: u32, height: u32) {
        self.in_row = width.div_ceil(8) as usize;
        self.bytes.clear();
        self.bytes.resize(self.in_row * height as usize, 0);
    }

    /// Adds a cell.
    pub fn add(&mut self, column: u32, row: u32) {
        self.bytes[row as usize * self.in_row + column as usize / 8] |= 1 << (column % 8);
    }

    /// Whether a cell is in it.
    #[inline]
    pub fn has(&self, column: u32, row: u32) -> bool {
        self.bytes[row as usize * self.in_row + column as usize / 8] >> (column % 8) & 1 == 1
    }

    /// The cells of a row, eight a byte. Bits beyond the raster's width mean nothing.
    pub fn row(&self, row: u32) -> &[u8] {
        &self.bytes[row as usize * self.in_row..][..self.in_row]
    }

    /// The bytes of a rectangle, row by row.
    fn bytes_of(&self, cells: &CellRectangle) -> impl Iterator<Item = &[u8]> {
        let bytes = cells.columns.start as usize / 8..cells.columns.end.div_ceil(8) as usize;
        cells.rows.clone().map(move |row| &self.row(row)[bytes.clone()])
    }

    /// Whether any cell of a rectangle is in it.
    pub(super) fn has_any(&self, cells: &CellRectangle) -> bool {
        self.bytes_of(cells).any(|bytes| bytes.iter().any(|byte| *byte != 0))
    }

    /// Adds all cells of a rectangle.
    pub(super) fn add_all(&mut self, cells: &CellRectangle) {
        let bytes = cells.columns.start as usize / 8..cells.columns.end.div_ceil(8) as usize;
        for row in cells.rows.clone() {
            self.bytes[row as usize * self.in_row..][bytes.clone()].fill(u8::MAX);
        }
    }
}

impl CellRectangle {
    pub(super) fn is_square(&self) -> bool {
        self.columns.len() <= SQUARE_SIDE as usize && self.rows.len() <= SQUARE_SIDE as usize
    }

    /// Its two halves across its longer side, in whole squares; the later one first.
    pub(super) fn halves(&self) -> [CellRectangle; 2] {
        let CellRectangle { columns, rows } = self;
        let middle = |of: &Range<u32>| of.start + (of.len() as u32).div_ceil(2).next_multiple_of(SQUARE_SIDE);
        if columns.len() > rows.len() {
            let middle = middle(columns);
            let part = |columns: Range<u32>| CellRectangle { columns, rows: rows.clone() };
            [part(middle..columns.end), part(columns.start..middle)]
        } else {
            let middle = middle(rows);
            let part = |rows: Range<u32>| CellRectangle { columns: columns.clone(), rows };
            [part(middle..rows.end), part(rows.start..middle)]
        }
    }
}
