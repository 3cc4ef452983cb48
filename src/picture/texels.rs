//! The texels of a picture's textures.

use crate::gpu::Gpu;
use wgpu::{TexelCopyBufferLayout, Texture, TextureFormat};

/// The picture's colours: display values.
pub const COLOURS: TextureFormat = TextureFormat::Rgba8Unorm;

/// Fills a texture with its texels, row 0 first.
pub(super) fn write(gpu: &Gpu, texture: &Texture, bytes: &[u8]) {
    let bytes_per_row = Some((bytes.len() / texture.height() as usize) as u32);
    let layout = TexelCopyBufferLayout { offset: 0, bytes_per_row, rows_per_image: None };
    gpu.queue.write_texture(texture.as_image_copy(), bytes, layout, texture.size());
}
