//! What is laid over a camera's picture: volumes and silhouette.

/// What a drawing lays over a camera's picture at one instant, in cells finer than the picture's.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Overlay {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Per cell how many walls and caps of the shadow volumes lie before what is seen, at most 255; where wanted.
    pub layers: Option<Vec<u8>>,
    /// Per cell how much of it the silhouette's lines cover, in 1/255; where wanted.
    pub silhouette: Option<Vec<u8>>,
}

impl Overlay {
    /// Nothing is to be seen of it.
    pub fn is_empty(&self) -> bool {
        [&self.layers, &self.silhouette].into_iter().flatten().flatten().all(|cell| *cell == 0)
    }
}
