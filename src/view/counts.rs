//! How much work counting shadow volumes takes, cell by cell.

/// What decided a cell's share, where a map decides some and volumes the others.
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

/// What counting shadow volumes takes at one instant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FragmentCounts {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Per cell how many fragments of walls and caps reach the count, row 0 first.
    pub reached: Vec<u32>,
    /// How many would in all cells together, if no mask kept any away.
    pub all: u64,
    /// Per cell what decided it, where a map did too.
    pub decided: Option<Vec<Decider>>,
}
