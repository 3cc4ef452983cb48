//! The work of counting shadow volumes, cell by cell.

/// What decided a cell's share, if a map decides some cells and volumes the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decider {
    /// The map, and the cell is in shadow.
    MapShadow,
    /// The map, and the cell sees the sun.
    MapLight,
    /// The volumes, and the cell is in shadow.
    VolumeShadow,
    /// The volumes, and the cell sees the sun.
    VolumeLight,
}

/// The work of counting shadow volumes at one instant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FragmentCounts {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// For each cell, the number of fragments of walls and caps that reach the count, row 0 first.
    pub reached: Vec<u32>,
    /// The number of fragments that would reach it in all cells without the mask.
    pub all: u64,
    /// What decided each cell, if a map decided some.
    pub decided: Option<Vec<Decider>>,
}
