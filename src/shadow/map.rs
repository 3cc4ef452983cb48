//! The shadow map: depth as the sun sees it, for [`super::shadow_map`], [`super::hybrid`] and [`super::smoothie`].
//!
//! L. Williams, *Casting Curved Shadows on Curved Surfaces*, 1978. The light is parallel, so depth is linear: metres
//! along the rays.
//!
//! A texel shades a cell only if it is nearer to the light than the cell, and nearer than the cell's own plane at the
//! texel's sample (the view provides the plane). So no plane shades itself, and no lit wall shades the ground at its
//! foot. The slope-scaled bias (Akenine-Möller, Haines and Hoffman, *Real-Time Rendering*, 3rd edition, 2008, section
//! 9.1) remains only for curved surfaces, and half a texel of it is enough for all filters.

use super::bindings::{UNIFORM, bind_group_layout, texture_binding};
use super::light_view::{Extents, Smoothies};
use super::{GpuSurface, Scene, ShadowError};
use crate::gpu::targets::{DEPTH, Stages, whole};
use crate::gpu::{Gpu, layout, shaders};
use crate::mesh::Mesh;
use glam::DVec4;
use std::sync::Arc;
use wgpu::*;

/// The slope-scaled bias, in texels. Measured: among 0 to 4, the value with the fewest wrong cells
/// (docs/benchmarks/techniques.md).
pub(super) const SLOPE_BIAS_TEXELS: f32 = 0.5;

/// Four depths per texel.
const PACKED: TextureFormat = TextureFormat::Rgba32Float;

/// The value of `shift` in `shaders/map.wgsl` for no shift.
const UNSHIFTED: u32 = 4;

/// The shadow map of one scene's casters, which is aimed at each sun in turn.
pub(super) struct DepthMap {
    gpu: Arc<Gpu>,
    size: u32,
    slope_bias: f32,
    extents: Extents,
    uniform: Buffer,
    /// The bind group with the uniform alone, group 2.
    pub(super) bound: BindGroup,
    pub(super) layout: BindGroupLayout,
    pub(super) depth: Texture,
    casters: Triangles,
    pipeline: RenderPipeline,
}

impl DepthMap {
    /// Uploads the casters and makes an empty map with `size` texels per side and a slope-scaled bias in texels.
    pub(super) fn new(
        scene: &Scene,
        surface: &GpuSurface,
        size: u32,
        slope_bias: f32,
    ) -> Result<DepthMap, ShadowError> {
        let gpu = Arc::clone(&surface.gpu);
        let largest = gpu.limits.max_texture_dimension_2d;
        if size > largest {
            return Err(ShadowError::MapTooLarge { size, largest, adapter: gpu.name().to_owned() });
        }
        let uniform = gpu.uniform::<layout::MapUniforms>("map");
        let layout = bind_group_layout(&gpu, "map", &[UNIFORM]);
        let bound = gpu.bind("map", &layout, &[(0, uniform.as_entire_binding())]);
        let module = gpu.shader("map", shaders::MAP);
        let pipeline_layout = surface.seeing_layout(&[&layout]);
        let stages = Stages {
            module: &module,
            vertex: "seen_from_light",
            fragment: "",
            buffers: &[Some(Triangles::LAYOUT)],
            target: None,
            layout: Some(&pipeline_layout),
        };
        let pipeline = gpu.pipeline("map.casters", stages, Some(nearest(slope_bias)));
        Ok(DepthMap {
            extents: Extents::new(scene, surface)?,
            uniform,
            bound,
            layout,
            depth: depth(&gpu, "map.depth", size),
            casters: Triangles::uploaded(&gpu, &scene.casters, |_| true)?,
            pipeline,
            size,
            slope_bias,
            gpu,
        })
    }

    /// The texels per side.
    pub(super) fn size(&self) -> (u32, u32) {
        (self.size, self.size)
    }

    /// The size of a texel across the sun's rays, metres along the map's axes.
    #[cfg(feature = "test-hooks")]
    pub(super) fn texel_m(&self, to_sun: glam::DVec3) -> [f32; 2] {
        self.extents.along_sun(to_sun).uniform(&self.extents, self.size, 0.0, Smoothies::default()).texel
    }

    /// Adapts to what another view sees.
    pub(super) fn turn_to(&mut self, surface: &GpuSurface) -> Result<(), ShadowError> {
        self.extents.turn_to(surface)
    }

    /// Aims at a light relative to the scene's origin (sun: w = 0, lamp: w = 1).
    pub(super) fn aim(&self, local_light: DVec4, smoothies: Smoothies) {
        let view = match local_light.w > 0.0 {
            false => self.extents.along_sun(local_light.truncate()),
            true => self.extents.before_lamp(local_light.truncate()),
        };
        let uniform = view.uniform(&self.extents, self.size, self.slope_bias, smoothies);
        self.gpu.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&uniform));
    }

    /// Draws the casters' depth.
    pub(super) fn draw(&self, surface: &GpuSurface, encoder: &mut CommandEncoder) {
        self.draw_triangles(surface, encoder, &self.depth, &self.casters);
    }

    /// Draws the depth of other triangles into a map of the same view.
    pub(super) fn draw_triangles(
        &self,
        surface: &GpuSurface,
        encoder: &mut CommandEncoder,
        depth: &Texture,
        triangles: &Triangles,
    ) {
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("map"),
            depth_stencil_attachment: Some(cleared(&whole(depth))),
            timestamp_writes: self.gpu.timed("map"),
            ..RenderPassDescriptor::default()
        });
        pass.set_pipeline(&self.pipeline);
        self.bind(surface, &mut pass);
        triangles.draw(&mut pass, UNSHIFTED);
    }

    /// Binds the view, what is seen, and the map's uniform.
    pub(super) fn bind(&self, surface: &GpuSurface, pass: &mut RenderPass<'_>) {
        pass.set_bind_group(0, &surface.frame, &[]);
        pass.set_bind_group(1, &surface.seen, &[]);
        pass.set_bind_group(2, &self.bound, &[]);
    }
}

/// Four maps, each shifted by a quarter of a texel, in the channels of one (Brabec and Seidel, section 3).
pub(super) struct PackedMap {
    pub(super) packed: Texture,
    /// A pipeline for each channel.
    pipelines: [RenderPipeline; 4],
}

impl PackedMap {
    pub(super) fn new(map: &DepthMap, surface: &GpuSurface) -> PackedMap {
        let gpu = &map.gpu;
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
        let module = gpu.shader("map", shaders::MAP);
        let layout = surface.seeing_layout(&[&map.layout]);
        let channels = [ColorWrites::RED, ColorWrites::GREEN, ColorWrites::BLUE, ColorWrites::ALPHA];
        let pipeline = |channel: ColorWrites| {
            let stages = Stages {
                module: &module,
                vertex: "seen_from_light",
                fragment: "depth_as_colour",
                buffers: &[Some(Triangles::LAYOUT)],
                target: Some((PACKED, channel)),
                layout: Some(&layout),
            };
            gpu.pipeline("map.packed", stages, Some(nearest(0.0)))
        };
        PackedMap { packed: gpu.texture("map.packed", map.size(), PACKED, usage), pipelines: channels.map(pipeline) }
    }

    /// Draws the casters four times.
    pub(super) fn draw(&self, map: &DepthMap, surface: &GpuSurface, encoder: &mut CommandEncoder) {
        for (shift, pipeline) in self.pipelines.iter().enumerate() {
            let load = if shift == 0 { LoadOp::Clear(Color::WHITE) } else { LoadOp::Load };
            let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
                label: Some("map.packed"),
                color_attachments: &[Some(RenderPassColorAttachment {
                    view: &whole(&self.packed),
                    depth_slice: None,
                    resolve_target: None,
                    ops: Operations { load, store: StoreOp::Store },
                })],
                depth_stencil_attachment: Some(cleared(&whole(&map.depth))),
                timestamp_writes: map.gpu.timed("map.packed"),
                ..RenderPassDescriptor::default()
            });
            pass.set_pipeline(pipeline);
            map.bind(surface, &mut pass);
            map.casters.draw(&mut pass, shift as u32);
        }
    }
}

/// The depth texture of an empty map.
pub(super) fn depth(gpu: &Gpu, label: &str, size: u32) -> Texture {
    gpu.texture(label, (size, size), DEPTH, TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING)
}

/// The binding of a map's depth for shaders that compare with it: group 3, binding 0.
pub(super) const COMPARED: BindingType = BindingType::Texture {
    sample_type: TextureSampleType::Depth,
    view_dimension: TextureViewDimension::D2,
    multisampled: false,
};

/// The layout of a group of textures for shaders that compare with the map.
pub(super) fn compared_layout(gpu: &Gpu, further: &[TextureSampleType]) -> BindGroupLayout {
    let further = further.iter().map(|&sample_type| texture_binding(sample_type));
    bind_group_layout(gpu, "compared", &[COMPARED].into_iter().chain(further).collect::<Vec<_>>())
}

fn nearest(slope_scale: f32) -> DepthStencilState {
    DepthStencilState {
        format: DEPTH,
        depth_write_enabled: Some(true),
        depth_compare: Some(CompareFunction::Less),
        stencil: StencilState::default(),
        bias: DepthBiasState { constant: 0, slope_scale, clamp: 0.0 },
    }
}

fn cleared(depth: &TextureView) -> RenderPassDepthStencilAttachment<'_> {
    RenderPassDepthStencilAttachment {
        view: depth,
        depth_ops: Some(Operations { load: LoadOp::Clear(1.0), store: StoreOp::Store }),
        stencil_ops: None,
    }
}

/// Some faces of a mesh on the GPU.
pub(super) struct Triangles {
    vertices: Buffer,
    indices: Buffer,
    count: u32,
}

impl Triangles {
    const LAYOUT: VertexBufferLayout<'static> = VertexBufferLayout {
        array_stride: 12,
        step_mode: VertexStepMode::Vertex,
        attributes: &vertex_attr_array![0 => Float32x3],
    };

    /// Uploads the selected faces of a mesh.
    pub(super) fn uploaded(gpu: &Gpu, mesh: &Mesh, keep: impl Fn(&[u32; 3]) -> bool) -> Result<Triangles, ShadowError> {
        let faces: Vec<[u32; 3]> = mesh.faces.iter().copied().filter(keep).collect();
        let vertices = gpu.uploaded("map.vertices", BufferUsages::VERTEX, &mesh.vertices[..])?;
        let indices = gpu.uploaded("map.indices", BufferUsages::INDEX, &faces)?;
        Ok(Triangles { vertices, indices, count: faces.len() as u32 * 3 })
    }

    pub(super) fn is_empty(&self) -> bool {
        self.count == 0
    }

    fn draw(&self, pass: &mut RenderPass<'_>, shift: u32) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), IndexFormat::Uint32);
        pass.draw_indexed(0..self.count, 0, shift..shift + 1);
    }
}
