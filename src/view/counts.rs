//! How much work counting shadow volumes takes, cell by cell.

/// What decided a cell's share, where the map decides some cells and the volumes the others.
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

/// How much work counting shadow volumes takes at one instant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FragmentCounts {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// For each cell, how many fragments of walls and caps reach the count, row 0 first.
    pub reached: Vec<u32>,
    /// How many fragments would reach it in all cells together without the mask.
    pub all: u64,
    /// What decided each cell, if the map decided some.
    pub decided: Option<Vec<Decider>>,
}
