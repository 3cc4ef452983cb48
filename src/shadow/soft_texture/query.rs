//! The request for one patch: its samples, how it is judged, and what is in front of it.

use super::occluders::Occluders;
use crate::mesh::patches::{Patch, Patches};
use crate::shadow::JUDGED_ABOVE_M;
use crate::shadow::registered::{Raster, RasterProjection};
use glam::DVec4;

/// One point of a light, or one instant of the sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// The light as a homogeneous point in the world frame: a unit vector to the sun (w = 0), or a lamp's position (w =
    /// 1).
    pub light: DVec4,
    /// The weight that a texel gets if it sees the sample.
    pub weight: u32,
}

/// How a patch is judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// By its texture; only a patch without a centre is judged by a ray.
    Texture,
    /// By one ray per texel and sample.
    Rays,
    /// By the cheapest way, for the sun by rays from rectangles of texels.
    Auto,
}

/// How patches were judged, over all samples in front of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PatchJudgements {
    /// The number of filled textures: patches times samples.
    pub textures: u64,
    /// The number of texels in them.
    pub texture_texels: u64,
    /// The number of faces between patches and samples that culling kept.
    pub faces: u64,
    /// The number of rays.
    pub rays: u64,
    /// The number of texels that were decided as part of a rectangle, without a ray of their own.
    pub rectangle_texels: u64,
}

/// With [`Choice::Auto`] a texture is filled if at most this many faces per texel lie between patch and sample;
/// otherwise rays cost less. Only for lamps and on an adapter: towards the sun the processor casts rays from rectangles
/// of texels. Measured in `docs/benchmarks/receivers.md`.
pub const MOST_FACES_A_TEXEL: usize = 2;

/// With [`Choice::Auto`], patches with fewer texels are always judged by rays, since searching for occluders costs
/// more. Measured there, too.
const FEWEST_FILLED: usize = 32;

/// With [`Choice::Auto`], patches with fewer texels are not worth a draw call of the adapter.
pub const FEWEST_DRAWN: usize = 256;

/// Whether the adapter draws a patch, unless there are too many occluders.
pub(super) fn is_drawn(patch: &Patch, choice: Choice) -> bool {
    let worth_it = match choice {
        Choice::Texture => true,
        Choice::Rays => false,
        Choice::Auto => patch.texels.len() >= FEWEST_DRAWN,
    };
    worth_it && patch.alone.is_none()
}

/// The request for occluders.
pub(super) struct OccluderQuery<'a> {
    pub(super) patches: &'a Patches,
    /// `None` if no texture is filled.
    pub(super) occluders: Option<&'a Occluders>,
    pub(super) culling: bool,
    pub(super) choice: Choice,
}

impl<'a> OccluderQuery<'a> {
    /// Finds the occluders between a patch and a light; `None` if rays should be cast instead.
    pub(super) fn find(
        &self,
        patch: &Patch,
        onto: &RasterProjection,
        waiting: &mut Vec<u32>,
        found: &mut Vec<u32>,
    ) -> Option<&'a Occluders> {
        let most = match self.choice {
            _ if patch.alone.is_some() => return None,
            Choice::Rays => return None,
            Choice::Texture => usize::MAX,
            Choice::Auto if patch.texels.len() < FEWEST_FILLED => return None,
            Choice::Auto => patch.texels.len() * MOST_FACES_A_TEXEL,
        };
        let size = (patch.width, patch.height);
        self.occluders.filter(|occluders| occluders.before(onto, size, self.culling, most, waiting, found))
    }
}

/// The raster of a patch, a millimetre above the side that faces the light; `None` if the light is edge-on or behind
/// it.
pub(super) fn raster(patch: &Patch, cell: f64, light: DVec4) -> Option<Raster> {
    let mut plane = patch.plane;
    if patch.two_sided && plane.dot(light) < 0.0 {
        plane = -plane;
    }
    plane.w -= JUDGED_ABOVE_M;
    (plane.dot(light) > 0.0).then_some(Raster {
        corner: patch.corner,
        right: patch.right,
        down: patch.down,
        cell,
        plane,
    })
}
