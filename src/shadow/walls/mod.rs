//! The walls of shadow volumes: found on the processor and uploaded, extracted on the GPU, or computed in the vertex
//! shader. All three give the same walls.

pub mod borders;
pub mod extraction;
mod faces;
#[cfg(feature = "test-hooks")]
mod quadrilaterals;
mod query;
mod uploaded;

pub use query::{WallQuery, Walls};

use crate::gpu::{Gpu, GpuError};
use crate::mesh::Mesh;
use crate::silhouette::ProcessorFinder;
use extraction::Extraction;
#[cfg(feature = "test-hooks")]
use quadrilaterals::Quadrilaterals;
use std::sync::Arc;
use uploaded::UploadedWalls;
use wgpu::{BindGroupLayout, ShaderModule};

/// The ways to find silhouettes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Silhouettes {
    /// A finder on the processor; its walls are uploaded.
    OnProcessor(ProcessorFinder),
    /// A compute pass over all edges.
    OnGpu,
    /// The vertex shader, for each edge of the mesh: the older method (*Real-Time Rendering*, 3rd edition, section
    /// 9.1), for comparison.
    #[cfg(feature = "test-hooks")]
    InVertexShader,
}

impl From<ProcessorFinder> for Silhouettes {
    fn from(kind: ProcessorFinder) -> Silhouettes {
        Silhouettes::OnProcessor(kind)
    }
}

/// Makes walls for meshes by the chosen method.
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

    /// If the vertex shader finds the edges: its module, and the layout of its edge data.
    pub(super) fn in_vertex_shader(&self) -> Option<(&ShaderModule, &BindGroupLayout)> {
        match self {
            #[cfg(feature = "test-hooks")]
            WallMaker::InVertexShader(program) => Some((&program.module, &program.layout)),
            _ => None,
        }
    }
}
