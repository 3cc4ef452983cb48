//! The request for walls, and what all methods share.

use super::borders::Borders;
use crate::gpu::{GpuError, layout};
use crate::mesh::{Incidence, Mesh};
use glam::{DVec4, Vec2, Vec3, Vec3Swizzles, Vec4, Vec4Swizzles};
use wgpu::{CommandEncoder, RenderPass};

/// The requested volume.
#[derive(Clone, Copy, Debug)]
pub struct WallQuery {
    /// The light relative to the mesh's origin (sun: w = 0, lamp: w = 1).
    pub local_light: DVec4,
    /// Whether walls end in one point at infinity, so that each is one triangle instead of two.
    pub to_infinity: bool,
    /// Whether the light cap is drawn, too.
    pub with_cap: bool,
    /// Whether walls are drawn half as often, because every multiplicity is even.
    pub halved: bool,
    /// The borders of the view. Walls beyond them may be left out if that costs less than uploading them.
    pub borders: Option<Borders>,
}

impl WallQuery {
    pub(super) fn indices_per_wall(&self) -> u32 {
        if self.to_infinity { 3 } else { 6 }
    }

    pub(super) fn uniform(&self) -> layout::SearchUniforms {
        layout::SearchUniforms {
            light: self.local_light.as_vec4().to_array(),
            indices_per_wall: self.indices_per_wall(),
            halved: u32::from(self.halved),
            unused: [0; 2],
        }
    }
}

/// The walls and caps of one mesh. Indices refer to a list with two entries per vertex: its place, and the far end of
/// its walls.
pub trait Walls {
    /// Finds the volume that is drawn next; the GPU's commands for that go into `encoder`. Returns whether there may be
    /// something to draw.
    fn find(&mut self, mesh: &Mesh, sought: &WallQuery, encoder: &mut CommandEncoder) -> Result<bool, GpuError>;

    /// Draws its walls.
    fn draw_walls(&self, pass: &mut RenderPass<'_>);

    /// Draws its light cap, if it was requested.
    fn draw_cap(&self, pass: &mut RenderPass<'_>);
}

/// The vertex of an edge from which its wall's triangles begin: the one nearer to the sun, from which the plan's shader
/// takes the depth of slivers. If both are equally near, it is the one with the lower index, so that a wall and its
/// opposite are the same triangles and cancel. The shaders compute the same sum in `f32`.
pub(super) fn sunward(vertices: &[Vec3], [one, other]: [u32; 2], light: Vec4) -> u32 {
    let (first, second) = (one.min(other), one.max(other));
    if along(vertices, [first, second]).dot(light.xy()) > 0.0 { second } else { first }
}

/// Metres east and north along an edge.
pub(super) fn along(vertices: &[Vec3], [first, second]: [u32; 2]) -> Vec2 {
    (vertices[second as usize] - vertices[first as usize]).xy()
}

/// Used instead of a second face if an edge has only one (`NO_FACE` of `shaders/common/edge.wgsl`).
pub(super) const NO_FACE: u32 = u32::MAX;

/// A face with its direction along an edge, as encoded for `shaders/common/edge.wgsl`.
pub(super) fn packed(incidence: Incidence) -> u32 {
    incidence.face() << 1 | u32::from(incidence.direction() < 0)
}
