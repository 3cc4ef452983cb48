//! The techniques. Each draws one mask for one direction of the sun, and all masks are of the same kind.
//!
//! Accumulation, drawings and tests do not depend on what drew a mask. A technique is one file, with a shader of the
//! same name if it draws on the GPU.

mod batch;
pub(crate) mod bindings;
mod changes;
mod counting;
mod flat;
mod flush;
mod flush_layer;
mod frame;
pub mod hybrid;
mod light_view;
mod map;
#[doc(hidden)]
pub mod near_clip;
mod plan_surface;
pub mod projected;
mod raised;
pub mod ray_cast;
#[doc(hidden)]
pub mod rays;
#[doc(hidden)]
pub mod registered;
pub mod shadow_map;
pub mod smoothie;
#[doc(hidden)]
pub mod soft_picture;
#[doc(hidden)]
pub mod soft_texture;
pub mod stencil;
mod surface;
mod view_rays;
#[doc(hidden)]
pub mod walls;

use crate::gpu::{Gpu, GpuError, readback};
use crate::mesh::Mesh;
use crate::message::{Field, Message, MessagePart, Worded, aside, message, pieces, plain_display};
use crate::view::{Bits, FragmentCounts, Mask, Surface, Tile, View};
use glam::{DVec3, DVec4};
use std::ops::Range;
use std::sync::Arc;

#[doc(hidden)]
pub use changes::{DifferingCells, LightChange};
#[doc(hidden)]
pub use flush::FlushFaces;
#[doc(hidden)]
pub use plan_surface::{PlanSurface, plan_surface};
#[doc(hidden)]
pub use surface::GpuSurface;
pub use walls::Silhouettes;

/// The height above itself at which a receiver is judged, along the normal of its visible side, metres. What lies
/// within it does not shade the receiver, so that a slab in the ground plane leaves the ground lit.
pub const JUDGED_ABOVE_M: f64 = 0.001;

/// The casters and receivers, relative to one origin.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The faces that cast.
    pub casters: Mesh,
    /// The faces that are judged, besides the ground. What is in neither mesh is looked through.
    pub receivers: Mesh,
    /// The height of the ground plane in the world frame, metres. The plane reaches to the horizon.
    pub ground: f64,
}

/// The last mask of a technique, in the memory where it was drawn.
pub enum DrawnMask<'a> {
    /// A mask in the processor's memory.
    Memory(&'a Mask),
    /// The same as one bit per cell, for the sun as a point.
    Bits(&'a Bits),
    /// An R8Unorm texture: the share of the sun that is seen.
    Texture(&'a Gpu, &'a wgpu::Texture),
}

impl DrawnMask<'_> {
    /// Reads the mask's pixels.
    pub fn read(&self) -> Result<Mask, ShadowError> {
        match self {
            DrawnMask::Memory(mask) => Ok((*mask).clone()),
            DrawnMask::Bits(bits) => Ok(bits.mask()),
            DrawnMask::Texture(gpu, texture) => Ok(Mask {
                width: texture.width(),
                height: texture.height(),
                share: readback::texels(gpu, texture, wgpu::TextureAspect::All)?,
            }),
        }
    }

    /// The cells that are in shadow: those that see at most half of the sun.
    pub fn bits(&self) -> Result<Bits, ShadowError> {
        match self {
            DrawnMask::Bits(bits) => Ok((*bits).clone()),
            DrawnMask::Memory(mask) => Ok(Bits::of(mask)),
            texture => Ok(Bits::of(&texture.read()?)),
        }
    }
}

/// Cells that a technique searches singly between two instants.
#[doc(hidden)]
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SingleCells {
    /// All of them.
    All,
    /// The cells whose bits are set.
    Some(Arc<Bits>),
}

impl SingleCells {
    /// These cells' bits of a shadow.
    pub(crate) fn of(&self, shadow: &Bits) -> Bits {
        match self {
            SingleCells::All => shadow.clone(),
            SingleCells::Some(cells) => shadow.with(cells, |shadow, cells| shadow & cells),
        }
    }
}

/// A way to find shadows, made for one scene and one view at a time.
pub trait Technique {
    /// Draws the mask for a unit vector to the sun, which is above the horizon.
    fn draw(&mut self, to_sun: DVec3) -> Result<DrawnMask<'_>, ShadowError>;

    /// The cells that are searched singly between two instants, since drawing them whole costs more; none where all are
    /// drawn.
    fn single_cells(&self) -> Option<SingleCells> {
        None
    }

    /// As [`Technique::draw`], without those cells that are searched singly: they are not in shadow.
    ///
    /// # Errors
    /// As [`Technique::draw`].
    fn draw_whole(&mut self, to_sun: DVec3) -> Result<DrawnMask<'_>, ShadowError> {
        self.draw(to_sun)
    }

    /// When the cells of some rows change that differ between two instants, of those that are searched singly.
    ///
    /// # Errors
    /// As [`Technique::draw`].
    fn changes(&mut self, _cells: &DifferingCells<'_>, _rows: Range<usize>) -> Result<Vec<LightChange>, ShadowError> {
        Ok(Vec::new())
    }

    /// Turns to another view of the same scene, and keeps what does not depend on the view. Returns `false` if the
    /// technique has to be rebuilt instead.
    ///
    /// # Errors
    /// [`ShadowError`] if the view does not fit on the adapter.
    fn turn_to(&mut self, _view: View) -> Result<bool, ShadowError> {
        Ok(false)
    }

    /// Turns to a tile of the plan that it was made for. Each cell keeps its place on the whole plan. Returns `false`
    /// if the technique has to be rebuilt instead.
    ///
    /// On the processor a tile's cells are those of the whole plan to the bit. A graphics adapter rounds corners to 1/256 of
    /// a cell for each tile separately, and draws maps for what the tile sees.
    ///
    /// # Errors
    /// As [`Technique::turn_to`].
    fn turn_to_tile(&mut self, tile: Tile) -> Result<bool, ShadowError> {
        self.turn_to(View::Plan(tile.grid()))
    }

    /// What the cells see of the receivers.
    fn surface(&self) -> Result<Surface, ShadowError>;

    /// A note if the technique did not apply to parts of the last mask, and what was done there; otherwise `None`.
    fn note(&self) -> Option<String> {
        None
    }

    /// Measures the cost of counting for a sun; `None` for a technique that does not count. Slow, as the result is read
    /// back.
    fn counted(&mut self, _to_sun: DVec3) -> Result<Option<FragmentCounts>, ShadowError> {
        Ok(None)
    }
}

/// Why a mask could not be drawn.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ShadowError {
    /// The raster is too large for the adapter.
    TooLarge {
        /// Columns of the raster.
        width: u32,
        /// Rows of the raster.
        height: u32,
        /// The adapter's limit.
        largest: u32,
        /// The adapter's name.
        adapter: String,
    },
    /// The map is too large for the adapter.
    MapTooLarge {
        /// Texels along the map's side.
        size: u32,
        /// The adapter's limit.
        largest: u32,
        /// The adapter's name.
        adapter: String,
    },
    /// The machine failed.
    Gpu(#[from] GpuError),
}

plain_display!(ShadowError);

impl Worded for ShadowError {
    fn message(&self) -> Message {
        match self {
            ShadowError::TooLarge { width, height, largest, adapter } => message![
                format!("a raster of {width} × {height} cells is larger than the {largest} that '{adapter}' draws");
                "choose larger cells",
                aside(Field::Cell),
                MessagePart::Where(Field::Size, pieces![" or fewer", aside(Field::Size)])
            ],
            ShadowError::MapTooLarge { size, largest, adapter } => message![
                format!("a shadow map of {size} texels per side is larger than the {largest} that '{adapter}' draws");
                "choose a smaller ", Field::MapSize
            ],
            ShadowError::Gpu(error) => error.message(),
        }
    }
}

/// Returns the unit normal of the visible side; zero if a face has no area. `plane` and `viewer` are relative to one
/// origin.
///
/// A surface whose visible side faces away from the sun, or is edge-on to it, is in shadow, whatever its winding.
#[doc(hidden)]
pub fn seen_normal(plane: DVec4, viewer: DVec4) -> DVec3 {
    if plane.dot(viewer) < 0.0 { -plane.truncate() } else { plane.truncate() }
}
