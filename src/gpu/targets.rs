//! Render targets, vertex and index buffers, and the pipeline states that repeat.

use super::{Gpu, GpuError};
use wgpu::*;

/// The depth format for counting volumes, with the stencil.
pub(crate) const COUNTED: TextureFormat = TextureFormat::Depth32FloatStencil8;
/// The depth format of the G-buffer.
pub(crate) const DEPTH: TextureFormat = TextureFormat::Depth32Float;
/// The format of face indices and sums.
pub(crate) const NUMBER: TextureFormat = TextureFormat::R32Uint;
/// The format of summed fragments.
pub(crate) const SUMMED: TextureFormat = TextureFormat::R32Float;
/// The format of masks.
pub(crate) const SHARE: TextureFormat = TextureFormat::R8Unorm;

impl Gpu {
    /// A texture with one texel per cell.
    #[doc(hidden)]
    pub fn texture(
        &self,
        label: &str,
        (width, height): (u32, u32),
        format: TextureFormat,
        usage: TextureUsages,
    ) -> Texture {
        self.device.create_texture(&TextureDescriptor {
            label: Some(label),
            size: Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        })
    }

    /// A buffer of this size, or an error if the adapter's limit is lower.
    pub(crate) fn buffer(&self, label: &str, size: u64, usage: BufferUsages) -> Result<Buffer, GpuError> {
        if size > self.limits.max_buffer_size {
            return Err(self.failed(format!(
                "{label} takes {} MiB, more than the {} MiB of its largest buffer",
                size >> 20,
                self.limits.max_buffer_size >> 20
            )));
        }
        Ok(self.device.create_buffer(&BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false }))
    }

    /// A buffer with these values; never empty.
    pub(crate) fn uploaded<T: bytemuck::Pod>(
        &self,
        label: &str,
        usage: BufferUsages,
        values: &[T],
    ) -> Result<Buffer, GpuError> {
        let size = values.len().max(1) * size_of::<T>();
        let buffer = self.buffer(label, size as u64, usage | BufferUsages::COPY_DST)?;
        self.queue.write_buffer(&buffer, 0, bytemuck::cast_slice(values));
        Ok(buffer)
    }

    /// A buffer for one struct of [`super::layout`].
    pub(crate) fn uniform<T: bytemuck::Pod>(&self, label: &str) -> Buffer {
        self.device.create_buffer(&BufferDescriptor {
            label: Some(label),
            size: size_of::<T>() as u64,
            usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    }

    /// A bind group for a pipeline whose layout was derived from its shader.
    pub(crate) fn bind(
        &self,
        label: &str,
        layout: &BindGroupLayout,
        entries: &[(u32, BindingResource<'_>)],
    ) -> BindGroup {
        let entries: Vec<BindGroupEntry<'_>> = entries
            .iter()
            .map(|(binding, resource)| BindGroupEntry { binding: *binding, resource: resource.clone() })
            .collect();
        self.device.create_bind_group(&BindGroupDescriptor { label: Some(label), layout, entries: &entries })
    }

    /// A render pipeline of triangles, both sides drawn, its layout derived from the shader.
    pub(crate) fn pipeline(
        &self,
        label: &str,
        stages: Stages<'_>,
        depth_stencil: Option<DepthStencilState>,
    ) -> RenderPipeline {
        self.blending_pipeline(label, stages, depth_stencil, None)
    }

    /// The same with a blend state.
    pub(crate) fn blending_pipeline(
        &self,
        label: &str,
        stages: Stages<'_>,
        depth_stencil: Option<DepthStencilState>,
        blend: Option<BlendState>,
    ) -> RenderPipeline {
        let target = stages.target.map(|(format, write_mask)| ColorTargetState { format, blend, write_mask });
        self.device.create_render_pipeline(&RenderPipelineDescriptor {
            label: Some(label),
            layout: stages.layout,
            vertex: VertexState {
                module: stages.module,
                entry_point: Some(stages.vertex),
                compilation_options: PipelineCompilationOptions::default(),
                buffers: stages.buffers,
            },
            primitive: PrimitiveState::default(),
            depth_stencil,
            multisample: MultisampleState::default(),
            fragment: (!stages.fragment.is_empty()).then(|| FragmentState {
                module: stages.module,
                entry_point: Some(stages.fragment),
                compilation_options: PipelineCompilationOptions::default(),
                targets: if target.is_some() { std::slice::from_ref(&target) } else { &[] },
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// The varying parts of render pipelines.
#[derive(Clone, Copy)]
pub(crate) struct Stages<'a> {
    /// The compiled shader.
    pub(crate) module: &'a ShaderModule,
    /// Its vertex entry point.
    pub(crate) vertex: &'a str,
    /// Its fragment entry point; empty to draw only depth.
    pub(crate) fragment: &'a str,
    /// Vertex buffers.
    pub(crate) buffers: &'a [Option<VertexBufferLayout<'a>>],
    /// The colour target, and the channels that are written.
    pub(crate) target: Option<(TextureFormat, ColorWrites)>,
    /// A layout that several pipelines share; `None` to derive it from the shader.
    pub(crate) layout: Option<&'a PipelineLayout>,
}

/// The view of a whole texture.
pub(crate) fn whole(texture: &Texture) -> TextureView {
    texture.create_view(&TextureViewDescriptor::default())
}
