//! What shaders of several techniques have bound alike: the layouts of groups, receivers' planes, and receivers' corners.

use crate::gpu::{Gpu, GpuError};
use crate::mesh::Mesh;
use wgpu::*;

/// Receivers' planes lie in rows of this many texels (`PLANES_WIDTH` of `shaders/common/seen.wgsl`).
pub(crate) const PLANES_WIDTH: usize = 4096;

/// A receiver's corner, as `receiver` of `shaders/common/receiver.wgsl` takes it: position and face.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct Corner([f32; 3], u32);

impl Corner {
    /// How a buffer of corners is read.
    pub(super) const LAYOUT: VertexBufferLayout<'static> = VertexBufferLayout {
        array_stride: size_of::<Corner>() as u64,
        step_mode: VertexStepMode::Vertex,
        attributes: &vertex_attr_array![0 => Float32x3, 1 => Uint32],
    };

    /// The corners of a face.
    pub(super) fn of(mesh: &Mesh, face: u32) -> [Corner; 3] {
        mesh.corners(face as usize).map(|corner| Corner(corner.to_array(), face))
    }
}

pub(super) fn pipeline_layout(gpu: &Gpu, groups: &[&BindGroupLayout]) -> PipelineLayout {
    let groups: Vec<_> = groups.iter().map(|group| Some(*group)).collect();
    gpu.device.create_pipeline_layout(&PipelineLayoutDescriptor {
        label: Some("shadow"),
        bind_group_layouts: &groups,
        immediate_size: 0,
    })
}

/// The planes of faces as a texture, which no adapter limits to the size of a binding.
pub(crate) fn planes(gpu: &Gpu, mesh: &Mesh) -> Result<Texture, GpuError> {
    let rows = mesh.planes().len().div_ceil(PLANES_WIDTH).max(1);
    let most = gpu.limits.max_texture_dimension_2d as usize;
    if rows > most {
        let (faces, most) = (mesh.planes().len(), most * PLANES_WIDTH);
        return Err(gpu.failed(format!("{faces} triangles are more than the {most} that its largest texture holds")));
    }
    let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
    let texture = gpu.texture("surface.planes", (PLANES_WIDTH as u32, rows as u32), TextureFormat::Rgba32Float, usage);
    let mut texels: Vec<[f32; 4]> = mesh.planes().iter().map(|plane| plane.as_vec4().to_array()).collect();
    texels.resize(rows * PLANES_WIDTH, [0.0; 4]);
    gpu.queue.write_texture(
        texture.as_image_copy(),
        bytemuck::cast_slice(&texels),
        TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(PLANES_WIDTH as u32 * 16), rows_per_image: None },
        texture.size(),
    );
    Ok(texture)
}

pub(crate) const UNIFORM: BindingType =
    BindingType::Buffer { ty: BufferBindingType::Uniform, has_dynamic_offset: false, min_binding_size: None };

pub(crate) fn texture_binding(sample_type: TextureSampleType) -> BindingType {
    BindingType::Texture { sample_type, view_dimension: TextureViewDimension::D2, multisampled: false }
}

pub(crate) fn bind_group_layout(gpu: &Gpu, label: &str, types: &[BindingType]) -> BindGroupLayout {
    let entry = |(binding, ty): (usize, &BindingType)| BindGroupLayoutEntry {
        binding: binding as u32,
        visibility: ShaderStages::VERTEX_FRAGMENT,
        ty: *ty,
        count: None,
    };
    let entries: Vec<_> = types.iter().enumerate().map(entry).collect();
    gpu.device.create_bind_group_layout(&BindGroupLayoutDescriptor { label: Some(label), entries: &entries })
}
