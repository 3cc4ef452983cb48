//! How high may be built on a plot: the data from which all files of an envelope are made.

use crate::site::{Ground, GroundKind};
use crate::sun::Place;
use crate::view::Grid;
use glam::{DVec2, DVec3};

/// The heights on a plot, and the sun that they keep.
#[derive(Clone, Copy, Debug)]
pub struct EnvelopeMap<'a> {
    /// The place on Earth.
    pub place: &'a Place,
    /// The ground.
    pub ground: &'a Ground,
    /// The height from which heights are measured, metres above the place's point: the ground's plane, or the lowest point
    /// of the terrain on the plot.
    pub foot_m: f64,
    /// The cells of the raster.
    pub grid: &'a Grid,
    /// For each cell, the greatest height, metres above `foot_m`; NaN outside the plot. Row 0 is north.
    pub heights: &'a [f32],
    /// The height where no ray limits it, metres: higher buildings are not considered.
    pub cap_m: f32,
    /// The plot's border.
    pub border: &'a [DVec2],
    /// For each cell, whether a building stands there.
    pub buildings: &'a [bool],
    /// The points whose sun is kept.
    pub points: &'a [DVec3],
    /// One line that says what is kept: the rule, or the hours.
    pub kept: &'a str,
    /// One line that names the days whose sun is kept.
    pub days: &'a str,
    /// Whether directions include refraction.
    pub refraction: bool,
}

impl EnvelopeMap<'_> {
    /// The height of a cell; `None` outside the plot.
    pub fn height(&self, cell: usize) -> Option<f32> {
        self.heights.get(cell).copied().filter(|height| !height.is_nan())
    }

    /// From what heights are measured, as it is said behind "above".
    pub fn foot_said(&self) -> &'static str {
        match self.ground.kind {
            GroundKind::Plane => "the ground",
            GroundKind::Terrain => "the lowest terrain on the plot",
        }
    }

    /// The volume below the heights, cubic metres.
    pub fn volume_m3(&self) -> f64 {
        let heights = (0..self.heights.len()).filter_map(|cell| self.height(cell));
        heights.map(f64::from).sum::<f64>() * self.grid.cell * self.grid.cell
    }

    /// The least and the greatest height; `None` if the plot has no cell.
    pub fn range(&self) -> Option<[f32; 2]> {
        let heights = (0..self.heights.len()).filter_map(|cell| self.height(cell));
        heights.fold(None, |range, height| match range {
            None => Some([height; 2]),
            Some([low, high]) => Some([low.min(height), high.max(height)]),
        })
    }
}
