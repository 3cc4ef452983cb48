//! Where the walls of shadow volumes come from: found on the processor and uploaded, extracted on the GPU, or decided
//! vertex by vertex. All give the same walls.

pub mod borders;
pub mod extraction;
mod faces;
#[cfg(feature = "test-hooks")]
mod quadrilaterals;
mod uploaded;

use crate::gpu::{Gpu, GpuError, layout};
use crate::mesh::{Incidence, Mesh};
use crate::silhouette::ProcessorFinder;
use borders::Borders;
use extraction::Extraction;
use glam::{DVec4, Vec2, Vec3, Vec3Swizzles, Vec4, Vec4Swizzles};
#[cfg(feature = "test-hooks")]
use quadrilaterals::Quadrilaterals;
use std::sync::Arc;
use uploaded::UploadedWalls;
use wgpu::{BindGroupLayout, CommandEncoder, RenderPass, ShaderModule};

/// Who finds the silhouettes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Silhouettes {
    /// A finder on the processor; its walls are uploaded.
    OnProcessor(ProcessorFinder),
    /// A compute pass over all edges.
    OnGpu,
    /// The vertex shader, for each edge of the mesh. To compare with: it is the older way (seed 003).
    #[cfg(feature = "test-hooks")]
    InVertexShader,
}

impl From<ProcessorFinder> for Silhouettes {
    fn from(kind: ProcessorFinder) -> Silhouettes {
        Silhouettes::OnProcessor(kind)
    }
}

/// Which volume is sought.
#[derive(Clone, Copy, Debug)]
pub struct WallQuery {
    /// The light around the mesh's origin (sun: w = 0, lamp: w = 1).
    pub local_light: DVec4,
    /// Walls end in one point at infinity, so that each is one triangle; else two.
    pub to_infinity: bool,
    /// The light cap is drawn too.
    pub with_cap: bool,
    /// Walls stand half as often; every multiplicity is even.
    pub halved: bool,
    /// Walls beyond these may be left out, where leaving them out costs less than handing them to the adapter.
    pub borders: Option<Borders>,
}

impl WallQuery {
    fn indices_per_wall(&self) -> u32 {
        if self.to_infinity { 3 } else { 6 }
    }

    fn uniform(&self) -> layout::SearchUniforms {
        layout::SearchUniforms {
            light: self.local_light.as_vec4().to_array(),
            indices_per_wall: self.indices_per_wall(),
            halved: u32::from(self.halved),
            unused: [0; 2],
        }
    }
}

/// The walls and caps of one mesh. Where indices are drawn, they count vertices that come twice: where they are, and
/// where their walls end.
pub trait Walls {
    /// Finds the volume that is drawn next; what the GPU has to do for it goes into `encoder`. Says whether there may be
    /// something to draw.
    fn find(&mut self, mesh: &Mesh, sought: &WallQuery, encoder: &mut CommandEncoder) -> Result<bool, GpuError>;

    /// Draws its walls.
    fn draw_walls(&self, pass: &mut RenderPass<'_>);

    /// Draws its light cap, where that was sought.
    fn draw_cap(&self, pass: &mut RenderPass<'_>);
}

/// Makes walls for meshes, in the way that was chosen.
pub(super) enum WallMaker {
    OnProcessor(Arc<Gpu>, ProcessorFinder),
    OnGpu(extraction::ExtractionProgram),
    #[cfg(feature = "test-hooks")]
    InVertexShader(quadrilaterals::QuadrilateralProgram),
}

impl WallMaker {
    pub(super) fn new(gpu: &Arc<Gpu>, silhouettes: Silhouettes) -> WallMaker {
        match silhouettes {
            Silhouettes::OnProcessor(kind) => WallMaker::OnProcessor(Arc::clone(gpu), kind),
            Silhouettes::OnGpu => WallMaker::OnGpu(extraction::ExtractionProgram::new(gpu)),
            #[cfg(feature = "test-hooks")]
            Silhouettes::InVertexShader => WallMaker::InVertexShader(quadrilaterals::QuadrilateralProgram::new(gpu)),
        }
    }

    pub(super) fn walls(&self, mesh: &Mesh) -> Result<Box<dyn Walls>, GpuError> {
        Ok(match self {
            WallMaker::OnProcessor(gpu, kind) => Box::new(UploadedWalls::new(Arc::clone(gpu), *kind, mesh)?),
            WallMaker::OnGpu(program) => Box::new(Extraction::new(program, mesh, program.faces.gpu.most_storage())?),
            #[cfg(feature = "test-hooks")]
            WallMaker::InVertexShader(program) => Box::new(Quadrilaterals::new(program, mesh)?),
        })
    }

    /// Where the vertex shader decides the edges: its module, and the layout of what it reads of them.
    pub(super) fn in_vertex_shader(&self) -> Option<(&ShaderModule, &BindGroupLayout)> {
        match self {
            #[cfg(feature = "test-hooks")]
            WallMaker::InVertexShader(program) => Some((&program.module, &program.layout)),
            _ => None,
        }
    }
}

/// The vertex of an edge from which its wall's triangles begin: the one nearer to the sun, from which the plan's shader
/// takes the depth of slivers; the lower number among equals, so that a wall and its opposite are the same triangles and
/// cancel. The shaders decide by the same sum in `f32`.
fn sunward(vertices: &[Vec3], [one, other]: [u32; 2], light: Vec4) -> u32 {
    let (first, second) = (one.min(other), one.max(other));
    if along(vertices, [first, second]).dot(light.xy()) > 0.0 { second } else { first }
}

/// Metres east and north along an edge.
fn along(vertices: &[Vec3], [first, second]: [u32; 2]) -> Vec2 {
    (vertices[second as usize] - vertices[first as usize]).xy()
}

/// Instead of a second face, where an edge has one (`NO_FACE` of `shaders/common/edge.wgsl`).
const NO_FACE: u32 = u32::MAX;

/// A face and which way it runs along an edge, as `shaders/common/edge.wgsl` reads it.
fn packed(incidence: Incidence) -> u32 {
    incidence.face() << 1 | u32::from(incidence.direction() < 0)
}
