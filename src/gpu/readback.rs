//! Copies buffers and textures from the GPU into the processor's memory.

use super::{Gpu, GpuError};
use wgpu::{
    Buffer, BufferDescriptor, BufferUsages, COPY_BYTES_PER_ROW_ALIGNMENT, Extent3d, MapMode, Origin3d, PollType, Queue,
    TexelCopyBufferInfo, TexelCopyBufferLayout, TexelCopyTextureInfo, Texture, TextureAspect,
};

/// The most bytes copied at once: a large raster is read in strips, so that no second copy of it is needed.
const STRIP: u64 = 64 << 20;

/// The values of a buffer (with `COPY_SRC`).
///
/// # Errors
/// [`GpuError::Lost`]
pub fn values<T: bytemuck::Pod>(gpu: &Gpu, buffer: &Buffer) -> Result<Vec<T>, GpuError> {
    let copy = gpu.buffer("gpu.readback", buffer.size(), BufferUsages::COPY_DST | BufferUsages::MAP_READ)?;
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_buffer_to_buffer(buffer, 0, &copy, 0, buffer.size());
    gpu.queue.submit([encoder.finish()]);
    copy.map_async(MapMode::Read, .., |_| ());
    gpu.device.poll(PollType::wait_indefinitely()).map_err(|error| gpu.lost(error))?;
    gpu.check()?;
    let mapped = copy.get_mapped_range(..).map_err(|error| gpu.lost(error))?;
    Ok(bytemuck::pod_collect_to_vec(&mapped[..]))
}

/// All texels of a texture as plain values, row 0 first. `T` has the size of one texel.
///
/// # Errors
/// [`GpuError::Lost`]
pub fn texels<T: bytemuck::Pod>(gpu: &Gpu, texture: &Texture, aspect: TextureAspect) -> Result<Vec<T>, GpuError> {
    let width = texture.width() as usize;
    let mut values = vec![T::zeroed(); width * texture.height() as usize];
    let mut rows = values.chunks_exact_mut(width);
    strips(gpu, texture, aspect, (width * size_of::<T>()) as u32, &mut |_, padded, bytes| {
        for (line, row) in bytes.chunks_exact(padded as usize).zip(rows.by_ref()) {
            let row = bytemuck::cast_slice_mut::<T, u8>(row);
            row.copy_from_slice(&line[..row.len()]);
        }
    })?;
    Ok(values)
}

/// Copies a texture of four bytes per texel to one of the same size on another device. The copy is submitted to that
/// device's queue, so later work on it sees the result.
///
/// # Errors
/// [`GpuError::Lost`] if the first device fails; faults of the other one are recorded there.
pub fn hand_over(gpu: &Gpu, texture: &Texture, queue: &Queue, to: &Texture) -> Result<(), GpuError> {
    let width = texture.width();
    strips(gpu, texture, TextureAspect::All, 4 * width, &mut |first, padded, bytes| {
        let part = TexelCopyTextureInfo { origin: Origin3d { x: 0, y: first, z: 0 }, ..to.as_image_copy() };
        let layout = TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded), rows_per_image: None };
        let size = Extent3d { width, height: bytes.len() as u32 / padded, depth_or_array_layers: 1 };
        queue.write_texture(part, bytes, layout, size);
    })
}

/// The strips of a texture's rows, each with its first row, and the bytes per row.
fn strips(
    gpu: &Gpu,
    texture: &Texture,
    aspect: TextureAspect,
    row_bytes: u32,
    tell: &mut dyn FnMut(u32, u32, &[u8]),
) -> Result<(), GpuError> {
    let (width, height) = (texture.width(), texture.height());
    let padded = row_bytes.next_multiple_of(COPY_BYTES_PER_ROW_ALIGNMENT);
    let strip = ((STRIP / u64::from(padded)).max(1) as u32).min(height);
    let buffer = gpu.device.create_buffer(&BufferDescriptor {
        label: Some("gpu.readback"),
        size: u64::from(padded) * u64::from(strip),
        usage: BufferUsages::COPY_DST | BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    for first in (0..height).step_by(strip as usize) {
        let count = strip.min(height - first);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encoder.copy_texture_to_buffer(
            TexelCopyTextureInfo { texture, mip_level: 0, origin: Origin3d { x: 0, y: first, z: 0 }, aspect },
            TexelCopyBufferInfo {
                buffer: &buffer,
                layout: TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded), rows_per_image: None },
            },
            Extent3d { width, height: count, depth_or_array_layers: 1 },
        );
        gpu.queue.submit([encoder.finish()]);
        buffer.map_async(MapMode::Read, .., |_| ());
        gpu.device.poll(PollType::wait_indefinitely()).map_err(|error| gpu.lost(error))?;
        gpu.check()?;
        let mapped = buffer.get_mapped_range(..).map_err(|error| gpu.lost(error))?;
        tell(first, padded, &mapped[..padded as usize * count as usize]);
        drop(mapped);
        buffer.unmap();
    }
    Ok(())
}
