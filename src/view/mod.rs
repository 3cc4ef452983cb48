//! Views (a plan, a camera, a side, probes), and what is found in them (surfaces and masks).
//!
//! A [`View`] is the plan's [`Grid`] of cells, a [`Camera`] or an [`Elevation`]; a [`Probe`] is a single point. Each
//! cell of a view sees a [`Surface`], and for one sun there is a [`Mask`].

mod camera;
mod counts;
mod elevation;
mod grid;
mod mask;
mod overlay;
mod probe;
mod sky;
mod surface;

pub use camera::Camera;
#[doc(hidden)]
pub use camera::Lens;
pub use counts::{Decider, FragmentCounts};
pub use elevation::{Elevation, Side};
pub use grid::{Grid, Tile};
pub use mask::{Bits, Mask};
#[doc(hidden)]
pub use overlay::Overlay;
#[doc(hidden)]
pub use probe::Probe;
#[doc(hidden)]
pub use sky::{SkyPicture, SkyProjection};
pub use surface::Surface;
#[doc(hidden)]
pub use surface::SurfaceRows;

use glam::DVec4;

/// What a mask is drawn for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum View {
    /// The plan: straight down on the grid's cells.
    Plan(Grid),
    /// A perspective picture.
    Camera(Camera),
    /// A side, or what the sun sees, along parallel rays.
    Elevation(Elevation),
}

impl View {
    /// Columns and rows of the raster.
    pub fn size(&self) -> (u32, u32) {
        match self {
            View::Plan(grid) => (grid.width, grid.height),
            View::Camera(camera) => (camera.width, camera.height),
            View::Elevation(side) => (side.width, side.height),
        }
    }

    /// The viewer as a homogeneous point: the eye, the direction straight up, or the direction towards the viewer
    /// of parallel rays.
    pub fn viewer(&self) -> DVec4 {
        match self {
            View::Plan(_) => DVec4::Z,
            View::Camera(camera) => camera.eye.extend(1.0),
            View::Elevation(side) => side.to_viewer.extend(0.0),
        }
    }
}
