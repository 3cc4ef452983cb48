//! What the cells of a view see first.

use std::ops::Range;

/// What each cell of a view sees first, models before ground: of faces that are flush with the
/// ground, the first.
///
/// It is drawn once per study, since it does not depend on the sun. Drawings take roofs and outlines from it.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// For each cell, the face of the mesh that is seen, [`Surface::GROUND`] or [`Surface::SKY`].
    pub face: Vec<u32>,
    /// For each cell, the height of the seen point in the world frame, metres (NaN for the sky).
    pub height_m: Vec<f32>,
}

/// What the cells of a plan see, a few rows at a time, so that a drawing of many cells need not hold them all in
/// memory.
pub trait SurfaceRows: Sync {
    /// The number of cells.
    fn cells(&self) -> usize;

    /// What some rows see.
    fn rows(&self, rows: Range<usize>) -> Surface;
}

impl SurfaceRows for Surface {
    fn cells(&self) -> usize {
        self.face.len().min(self.height_m.len())
    }

    fn rows(&self, rows: Range<usize>) -> Surface {
        let width = self.width as usize;
        let cells = rows.start * width..rows.end * width;
        Surface {
            width: self.width,
            height: rows.len() as u32,
            face: self.face[cells.clone()].to_vec(),
            height_m: self.height_m[cells].to_vec(),
        }
    }
}

impl Surface {
    /// The cell sees the ground plane.
    pub const GROUND: u32 = u32::MAX - 1;
    /// The cell sees nothing.
    pub const SKY: u32 = u32::MAX;
}
