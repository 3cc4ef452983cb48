//! Silhouettes computed in the vertex shader: every edge is a quadrilateral, which collapses if it is not part of the
//! silhouette.
//!
//! Akenine-Möller, Haines and Hoffman, *Real-Time Rendering*, 3rd edition, 2008, section 9.1, figure 9.14; kept for
//! comparison. Every edge costs its twelve vertices, silhouette or not. The book and the shader only support edges with
//! two faces: an edge with more is drawn several times, each time with two of its faces, and these walls add up.

use super::faces::{self, Faces, GROUP};
use super::query::{NO_FACE, WallQuery, Walls, packed};
use crate::gpu::{Gpu, GpuError, layout, shaders};
use crate::mesh::Mesh;
use crate::shadow::bindings::bind_group_layout;
use std::sync::Arc;
use wgpu::{
    BindGroup, BindGroupLayout, BindingType, BufferBindingType, BufferUsages, CommandEncoder, RenderPass, ShaderModule,
};

/// The pipelines' shared parts.
pub(in crate::shadow) struct QuadrilateralProgram {
    faces: Arc<faces::FacingProgram>,
    /// The stencil's shader with these vertex entry points.
    pub(in crate::shadow) module: ShaderModule,
    pub(super) layout: BindGroupLayout,
}

impl QuadrilateralProgram {
    pub(super) fn new(gpu: &Arc<Gpu>) -> QuadrilateralProgram {
        let buffer = |ty| BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
        let read = buffer(BufferBindingType::Storage { read_only: true });
        QuadrilateralProgram {
            faces: Arc::new(faces::FacingProgram::new(gpu)),
            module: gpu.shader("quadrilaterals", shaders::QUADRILATERALS),
            layout: bind_group_layout(gpu, "quadrilaterals", &[buffer(BufferBindingType::Uniform), read, read]),
        }
    }
}

/// The edges of one mesh on the GPU.
pub(super) struct Quadrilaterals {
    faces: Faces,
    /// Parts that fit the adapter's bindings, with their numbers of edges.
    runs: Vec<(BindGroup, u32)>,
    /// The greatest multiplicity of a wall with two faces.
    instances: u32,
}

impl Quadrilaterals {
    pub(super) fn new(program: &QuadrilateralProgram, mesh: &Mesh) -> Result<Quadrilaterals, GpuError> {
        let gpu = &program.faces.gpu;
        let most = gpu.most_storage();
        let faces = Faces::new(&program.faces, mesh, most)?;
        let pairs: Vec<layout::Quadrilateral> = (0..mesh.edges.len()).flat_map(|edge| pairs(mesh, edge)).collect();
        let mut runs = Vec::new();
        // at most 256 MiB, so that six vertices per edge fit in 32 bits
        let at_once = most.min(1 << 28) as usize / size_of::<layout::Quadrilateral>();
        for pairs in pairs.chunks(at_once) {
            let buffer = gpu.storage("quadrilaterals", size_of_val(pairs) as u64, most, BufferUsages::COPY_DST)?;
            gpu.queue.write_buffer(&buffer, 0, bytemuck::cast_slice(pairs));
            let bound = gpu.bind(
                "quadrilaterals",
                &program.layout,
                &[
                    (0, faces.search.as_entire_binding()),
                    (1, faces.facing.as_entire_binding()),
                    (2, buffer.as_entire_binding()),
                ],
            );
            runs.push((bound, pairs.len() as u32));
        }
        gpu.check()?;
        Ok(Quadrilaterals { faces, runs, instances: 0 })
    }
}

/// An edge as pairs of its faces.
fn pairs(mesh: &Mesh, edge: usize) -> impl Iterator<Item = layout::Quadrilateral> {
    let [first, second] = mesh.edges[edge].map(|vertex| mesh.vertices[vertex as usize].to_array());
    mesh.faces_at(edge).chunks(2).map(move |pair| layout::Quadrilateral {
        first,
        a: packed(pair[0]),
        second,
        b: pair.get(1).map_or(NO_FACE, |&face| packed(face)),
    })
}

impl Walls for Quadrilaterals {
    fn find(&mut self, mesh: &Mesh, sought: &WallQuery, encoder: &mut CommandEncoder) -> Result<bool, GpuError> {
        self.instances = if sought.halved { 1 } else { 2 };
        self.faces.find(mesh, sought, encoder)?;
        Ok(true)
    }

    fn draw_walls(&self, pass: &mut RenderPass<'_>) {
        for (bound, count) in &self.runs {
            pass.set_bind_group(GROUP, bound, &[]);
            pass.draw(0..count * 6, 0..self.instances);
        }
    }

    fn draw_cap(&self, pass: &mut RenderPass<'_>) {
        self.faces.draw_cap(pass);
    }
}
