//! Patches, and the atlas with the patches of a mesh.

use glam::{DVec3, DVec4};
use std::ops::Range;

/// The greatest angle between the faces of a patch, degrees.
pub const FLAT_ANGLE_DEG: f64 = 1.0;

/// The greatest distance of a patch's corners from its plane, metres: half of the millimetre above itself at which a
/// receiver is judged, so that no patch shades itself. Two steps of `f32` if those are larger around the mesh's origin.
pub const FLAT_M: f64 = 0.0005;

/// The default side of a texel, metres.
pub const DEFAULT_CELL_M: f64 = 0.25;

/// The default for the greatest number of texels in the atlas. With the adapter's data for each, and a mesh of some
/// hundred thousand triangles, that takes far less than 1 GiB.
pub const MOST_TEXELS: usize = 1 << 25;

/// The greatest side of a page, texels, which every adapter and viewer supports.
pub const MOST_PAGE: u32 = 4096;

/// Empty texels around each patch in its page, so that textures can be filtered.
pub const GUTTER: u32 = 1;

/// The patches of a mesh, and their positions in the atlas.
#[derive(Clone, Debug)]
pub struct Patches {
    /// The world position that planes and frames are relative to, metres: the mesh's origin.
    pub origin: DVec3,
    /// A texel's side, metres.
    pub cell: f64,
    /// The requested side, metres; less than `cell` if the atlas would have become too large.
    pub asked_cell: f64,
    /// The patches. Those of one component are consecutive, the larger ones first.
    pub list: Vec<Patch>,
    /// Faces of the mesh, patch by patch.
    pub faces: Vec<u32>,
    /// Judged texels, patch by patch, each row by row.
    pub texels: Vec<Texel>,
    /// A page's side, texels.
    pub page_size: u32,
    /// The number of pages of the atlas.
    pub pages: u32,
    /// The area that counts in no sum, set by [`Patches::leave_out_shared`].
    pub left_out: UncountedArea,
}

/// A flat patch. Positions are relative to [`Patches::origin`].
#[derive(Clone, Debug)]
pub struct Patch {
    /// The index of its component in the mesh.
    pub component: u32,
    /// Its run of [`Patches::faces`].
    pub faces: Range<u32>,
    /// Its unit plane (n, −n·p); n points to the side that is judged.
    pub plane: DVec4,
    /// Whether its outer side is unknown, so that it is judged on the side that faces the sun.
    pub two_sided: bool,
    /// The area of its faces, square metres, without what counts in no sum.
    pub area_m2: f64,
    /// The indices of its texels that count in no sum, in order.
    pub uncounted: Vec<u32>,
    /// The corner where the first texel begins, in the patch's plane.
    pub corner: DVec3,
    /// A unit vector along its rows, horizontal unless the patch is level.
    pub right: DVec3,
    /// A unit vector down its columns.
    pub down: DVec3,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The index of its page.
    pub page: u32,
    /// The column in the page of its first texel.
    pub x: u32,
    /// The row in the page of its first texel.
    pub y: u32,
    /// Its run of [`Patches::texels`], never empty.
    pub texels: Range<u32>,
    /// The point at which the patch is judged if no texel's centre lies in it. Its only texel is the one that contains
    /// this point.
    pub alone: Option<DVec3>,
}

/// A texel that is judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Texel {
    /// The column, from the patch's left.
    pub column: u16,
    /// The row, from the patch's top.
    pub row: u16,
}

/// The area of patches that counts in no sum.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct UncountedArea {
    /// Surfaces that exist twice, square metres.
    pub doubled_m2: f64,
    /// Surfaces between parts that touch, on both sides, square metres.
    pub touching_m2: f64,
}

impl Patch {
    /// The unit normal of the judged side; of a two-sided patch, that of its winding.
    pub fn normal(&self) -> DVec3 {
        self.plane.truncate()
    }

    /// The direction that it faces, clockwise from north, degrees from 0 to 360; `None` if it is level.
    pub fn azimuth_deg(&self) -> Option<f64> {
        let normal = self.normal();
        let level = normal.truncate().length() < LEVEL;
        (!level).then(|| normal.x.atan2(normal.y).to_degrees().rem_euclid(360.0))
    }

    /// Its tilt, degrees: 0 faces straight up, 90 is a wall, 180 faces straight down.
    pub fn tilt_deg(&self) -> f64 {
        self.normal().z.clamp(-1.0, 1.0).acos().to_degrees()
    }

    /// The centre of a texel, in the patch's plane.
    pub fn centre(&self, texel: Texel, cell: f64) -> DVec3 {
        self.corner
            + self.right * ((f64::from(texel.column) + 0.5) * cell)
            + self.down * ((f64::from(texel.row) + 0.5) * cell)
    }
}

/// The sine of the angle below which a patch is level: a tenth of a degree.
pub(super) const LEVEL: f64 = 0.001745;

impl Patches {
    /// The point at which a texel is judged, in the patch's plane, relative to [`Patches::origin`].
    pub fn point(&self, patch: &Patch, texel: Texel) -> DVec3 {
        patch.alone.unwrap_or_else(|| patch.centre(texel, self.cell))
    }

    /// Converts a point relative to [`Patches::origin`] to texels of the patch's page, for texture coordinates. Texel
    /// (0, 0) extends from 0 to 1.
    pub fn in_page(&self, patch: &Patch, point: DVec3) -> [f64; 2] {
        let from_corner = (point - patch.corner) / self.cell;
        [f64::from(patch.x) + from_corner.dot(patch.right), f64::from(patch.y) + from_corner.dot(patch.down)]
    }

    /// The patches of a component, as a range of the list.
    pub fn of_component(&self, component: u32) -> Range<usize> {
        let first = self.list.partition_point(|patch| patch.component < component);
        first..self.list.partition_point(|patch| patch.component <= component)
    }
}
