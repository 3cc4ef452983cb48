//! What is laid over a camera's picture: volumes and silhouette.

/// What a drawing lays over a camera's picture at one instant, in cells finer than the picture's.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Overlay {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// For each cell, the number of walls and caps of the shadow volumes in front of what is seen, at most 255; if
    /// requested.
    pub layers: Option<Vec<u8>>,
    /// For each cell, the coverage by the silhouette's lines, in 1/255; if requested.
    pub silhouette: Option<Vec<u8>>,
}

impl Overlay {
    /// Whether nothing in it is visible.
    pub fn is_empty(&self) -> bool {
        [&self.layers, &self.silhouette].into_iter().flatten().flatten().all(|cell| *cell == 0)
    }
}
