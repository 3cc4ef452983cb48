//! Faces on the GPU: one bit per face says whether it is turned to the light; these bits orient the faces of the light
//! cap.

use super::WallQuery;
use crate::gpu::targets::whole;
use crate::gpu::{Gpu, GpuError, layout, shaders};
use crate::mesh::Mesh;
use crate::shadow::bindings;
use std::sync::Arc;
use wgpu::{
    BindGroup, BindingResource, Buffer, BufferUsages, CommandEncoder, ComputePassDescriptor, ComputePipeline,
    IndexFormat, RenderPass,
};

/// The group of all bindings besides those of the view.
pub(super) const GROUP: u32 = 2;

/// The pipelines, shared by all meshes.
pub(super) struct FacingProgram {
    pub(in crate::shadow) gpu: Arc<Gpu>,
    decide: ComputePipeline,
    cap: ComputePipeline,
}

impl FacingProgram {
    pub(super) fn new(gpu: &Arc<Gpu>) -> FacingProgram {
        let module = gpu.shader("faces", shaders::FACES);
        FacingProgram {
            gpu: Arc::clone(gpu),
            decide: gpu.compute("faces.decide", &module, "decide"),
            cap: gpu.compute("faces.cap", &module, "cap"),
        }
    }
}

/// The faces of one mesh on the GPU.
pub(super) struct Faces {
    program: Arc<FacingProgram>,
    /// The most bytes of a buffer.
    most: u64,
    count: u32,
    /// The request, as [`layout::SearchUniforms`].
    pub(super) search: Buffer,
    /// One bit a face.
    pub(super) facing: Buffer,
    decide: BindGroup,
    /// Made when first needed.
    cap: Vec<CapRun>,
    cap_is_sought: bool,
}

/// A part of the cap whose buffers are small enough.
struct CapRun {
    count: u32,
    indices: Buffer,
    bound: BindGroup,
}

impl Faces {
    pub(super) fn new(program: &Arc<FacingProgram>, mesh: &Mesh, most: u64) -> Result<Faces, GpuError> {
        let gpu = &program.gpu;
        let search = gpu.uniform::<layout::SearchUniforms>("faces.search");
        let bits = mesh.faces.len().div_ceil(32) as u64 * 4;
        let facing = gpu.storage("faces.facing", bits, most, BufferUsages::COPY_SRC)?;
        let planes = bindings::planes(gpu, mesh)?;
        let decide = gpu.bind(
            "faces.decide",
            &program.decide.get_bind_group_layout(GROUP),
            &[
                (0, search.as_entire_binding()),
                (1, facing.as_entire_binding()),
                (2, BindingResource::TextureView(&whole(&planes))),
            ],
        );
        Ok(Faces {
            program: Arc::clone(program),
            most,
            count: mesh.faces.len() as u32,
            search,
            facing,
            decide,
            cap: Vec::new(),
            cap_is_sought: false,
        })
    }

    /// Computes facing, and orients the cap if it is needed.
    pub(super) fn find(
        &mut self,
        mesh: &Mesh,
        sought: &WallQuery,
        encoder: &mut CommandEncoder,
    ) -> Result<(), GpuError> {
        self.cap_is_sought = sought.with_cap;
        if sought.with_cap && self.cap.is_empty() {
            self.make_cap(mesh)?;
        }
        let gpu = &self.program.gpu;
        gpu.queue.write_buffer(&self.search, 0, bytemuck::bytes_of(&sought.uniform()));
        let timestamp_writes = gpu.timed_compute("faces");
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor { label: Some("faces"), timestamp_writes });
        pass.set_pipeline(&self.program.decide);
        pass.set_bind_group(GROUP, &self.decide, &[]);
        gpu.dispatch(&mut pass, self.count);
        if sought.with_cap {
            pass.set_pipeline(&self.program.cap);
            for run in &self.cap {
                pass.set_bind_group(GROUP, &run.bound, &[]);
                gpu.dispatch(&mut pass, run.count);
            }
        }
        Ok(())
    }

    fn make_cap(&mut self, mesh: &Mesh) -> Result<(), GpuError> {
        let gpu = &self.program.gpu;
        let at_once = (self.most / size_of::<layout::FaceRecord>() as u64).max(1) as usize;
        for (run, faces) in mesh.faces.chunks(at_once).enumerate() {
            let number = |at: usize| (run * at_once + at) as u32;
            let faces: Vec<_> = faces
                .iter()
                .enumerate()
                .map(|(at, &corners)| layout::FaceRecord { corners, number: number(at) })
                .collect();
            let input =
                gpu.storage("faces.faces", size_of_val(&faces[..]) as u64, self.most, BufferUsages::COPY_DST)?;
            gpu.queue.write_buffer(&input, 0, bytemuck::cast_slice(&faces));
            let size = faces.len() as u64 * 12;
            let usage = BufferUsages::INDEX | BufferUsages::COPY_SRC;
            let indices = gpu.storage("faces.cap", size, self.most, usage)?;
            let bound = gpu.bind(
                "faces.cap",
                &self.program.cap.get_bind_group_layout(GROUP),
                &[
                    (1, self.facing.as_entire_binding()),
                    (3, input.as_entire_binding()),
                    (4, indices.as_entire_binding()),
                ],
            );
            self.cap.push(CapRun { count: faces.len() as u32, indices, bound });
        }
        Ok(())
    }

    pub(super) fn draw_cap(&self, pass: &mut RenderPass<'_>) {
        if !self.cap_is_sought {
            return;
        }
        for run in &self.cap {
            pass.set_index_buffer(run.indices.slice(..), IndexFormat::Uint32);
            pass.draw_indexed(0..run.count * 3, 0, 0..1);
        }
    }

    /// The cap's runs: their buffers, with the number of indices in each.
    #[cfg(feature = "test-hooks")]
    pub(super) fn cap(&self) -> impl Iterator<Item = (&Buffer, u32)> {
        self.cap.iter().map(|run| (&run.indices, run.count * 3))
    }
}
