//! Draws the receivers that are flush with the ground in front of it, on the graphics adapter, by the rule of
//! `flush.rs`.

use super::bindings::{Corner, PLANES_WIDTH, bind_group_layout, texture_binding};
use super::flush::flush_faces;
use crate::gpu::targets::{NUMBER, Stages, whole};
use crate::gpu::{Gpu, GpuError, shaders};
use crate::mesh::Mesh;
use wgpu::*;

/// The number of corners in one buffer.
const CORNERS_AT_ONCE: usize = 3 << 18;

/// The flush faces, the last one first: the first face is drawn last, and stays.
pub(super) struct FlushCorners {
    corners: Vec<Corner>,
    /// For each face of the receivers, 1 if it is flush, padded to whole rows of planes.
    is_flush: Vec<u8>,
}

impl FlushCorners {
    pub(super) fn of(receivers: &Mesh, ground: f64) -> FlushCorners {
        let faces = flush_faces(receivers, ground);
        let rows = if faces.is_empty() { 0 } else { receivers.faces.len().div_ceil(PLANES_WIDTH) };
        let mut is_flush = vec![0; rows * PLANES_WIDTH];
        faces.iter().for_each(|face| is_flush[*face as usize] = 1);
        let corners = faces.iter().rev().flat_map(|face| Corner::of(receivers, *face)).collect();
        FlushCorners { corners, is_flush }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.corners.is_empty()
    }
}

/// The layer on an adapter.
pub(super) struct FlushLayer {
    /// Buffers of corners, with their numbers of corners.
    runs: Vec<(Buffer, u32)>,
    is_flush: BindGroup,
    pipeline: RenderPipeline,
}

impl FlushLayer {
    /// The layout of the bind group that says which faces are flush.
    pub(super) fn group(gpu: &Gpu) -> BindGroupLayout {
        bind_group_layout(gpu, "flush", &[texture_binding(TextureSampleType::Uint)])
    }

    /// Uploads the faces. `layout` has the bind groups of the view, of what is seen, and this `group`.
    pub(super) fn new(
        gpu: &Gpu,
        flush: &FlushCorners,
        group: &BindGroupLayout,
        layout: &PipelineLayout,
    ) -> Result<FlushLayer, GpuError> {
        let runs = flush.corners.chunks(CORNERS_AT_ONCE);
        let runs = runs.map(|run| Ok((gpu.uploaded("flush.receivers", BufferUsages::VERTEX, run)?, run.len() as u32)));
        let size = (PLANES_WIDTH as u32, (flush.is_flush.len() / PLANES_WIDTH) as u32);
        let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
        let texture = gpu.texture("flush", size, TextureFormat::R8Uint, usage);
        let rows = TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(size.0), rows_per_image: None };
        gpu.queue.write_texture(texture.as_image_copy(), &flush.is_flush, rows, texture.size());
        let stages = Stages {
            module: &gpu.shader("flush", shaders::FLUSH),
            vertex: "receiver",
            fragment: "flush_face",
            buffers: &[Some(Corner::LAYOUT)],
            target: Some((NUMBER, ColorWrites::ALL)),
            layout: Some(layout),
        };
        Ok(FlushLayer {
            runs: runs.collect::<Result<_, GpuError>>()?,
            is_flush: gpu.bind("flush", group, &[(0, BindingResource::TextureView(&whole(&texture)))]),
            pipeline: gpu.pipeline("flush", stages, None),
        })
    }

    /// Draws into the texture of faces that are shown, which starts as a copy of those that are judged.
    pub(super) fn draw(&self, encoder: &mut CommandEncoder, shown: &Texture, [frame, seen]: [&BindGroup; 2]) {
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("flush"),
            color_attachments: &[Some(RenderPassColorAttachment {
                view: &whole(shown),
                depth_slice: None,
                resolve_target: None,
                ops: Operations { load: LoadOp::Load, store: StoreOp::Store },
            })],
            ..RenderPassDescriptor::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, frame, &[]);
        pass.set_bind_group(1, seen, &[]);
        pass.set_bind_group(2, &self.is_flush, &[]);
        for (corners, count) in &self.runs {
            pass.set_vertex_buffer(0, corners.slice(..));
            pass.draw(0..*count, 0..1);
        }
    }
}
