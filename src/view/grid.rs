//! The plan's raster, and rectangles of it.
//!
//! Rasters are north up: row 0 is north, column 0 is west, and a cell is judged at its centre.

use glam::DVec2;

/// The plan's raster: square cells from the north-west corner, in metres of the world frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// West edge, metres.
    pub west: f64,
    /// North edge, metres.
    pub north: f64,
    /// Side of a cell, metres.
    pub cell: f64,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Grid {
    /// East edge, metres: a whole number of cells from the west.
    pub fn east(&self) -> f64 {
        self.west + f64::from(self.width) * self.cell
    }

    /// South edge, metres: a whole number of cells from the north.
    pub fn south(&self) -> f64 {
        self.north - f64::from(self.height) * self.cell
    }

    /// West, south, east, north in metres, as the site file writes a region.
    pub fn region(&self) -> [f64; 4] {
        [self.west, self.south(), self.east(), self.north]
    }

    /// The transform from columns and rows to metres, in GDAL's order: x = t₀ + column · t₁ + row · t₂, y = t₃ + column
    /// · t₄ + row · t₅. Columns count from the west edge, rows from the north edge.
    pub fn transform(&self) -> [f64; 6] {
        [self.west, self.cell, 0.0, self.north, 0.0, -self.cell]
    }

    /// The centre of a cell, metres east and north.
    pub fn centre(&self, column: u32, row: u32) -> DVec2 {
        DVec2::new(self.west + (f64::from(column) + 0.5) * self.cell, self.north - (f64::from(row) + 0.5) * self.cell)
    }

    /// The number of cells.
    pub fn cells(&self) -> usize {
        self.width as usize * self.height as usize
    }
}

/// A rectangle of a plan's cells, which is computed on its own if the plan is too large to be computed at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tile {
    /// The whole plan.
    pub plan: Grid,
    /// The north-west cell: column and row on the plan.
    pub first: [u32; 2],
    /// Columns and rows.
    pub size: [u32; 2],
}

impl From<Grid> for Tile {
    fn from(plan: Grid) -> Tile {
        Tile { plan, first: [0, 0], size: [plan.width, plan.height] }
    }
}

impl Tile {
    /// Whether it is the whole plan.
    pub fn is_whole(&self) -> bool {
        *self == self.plan.into()
    }

    /// Its cells as a plan of their own. Their positions are the same, except for the rounding of the tile's corner.
    pub fn grid(&self) -> Grid {
        let Tile { plan, first: [column, row], size: [width, height] } = *self;
        let west = plan.west + f64::from(column) * plan.cell;
        let north = plan.north - f64::from(row) * plan.cell;
        Grid { west, north, cell: plan.cell, width, height }
    }

    /// The number of cells.
    pub fn cells(&self) -> usize {
        self.size[0] as usize * self.size[1] as usize
    }
}
