//! The colours of flat patches as textures for the picture: the place of each face's patch in the atlas, and the atlas.

use super::texels::{COLOURS, write};
use crate::gpu::{Gpu, GpuError};
use crate::mesh::patches::Patches;
use crate::shadow::ShadowError;
use crate::shadow::bindings::PLANES_WIDTH;
use glam::DVec3;
use wgpu::*;

/// Marks a face without a patch (`NO_PATCH` of `shaders/picture.wgsl`).
const NO_PATCH: u32 = u32::MAX;

/// Colours of flat patches, to show on the scene.
#[derive(Clone, Copy, Debug)]
pub struct PatchColours<'a> {
    /// The patches.
    pub patches: &'a Patches,
    /// The patch of each face of the receivers.
    pub patch_of: &'a [Option<u32>],
    /// The colours of each page's texels, row by row.
    pub pages: &'a [Vec<[u8; 3]>],
}

/// The textures for each face's patch, the patches' frames, and the pages.
pub(super) fn textures(gpu: &Gpu, colours: &PatchColours<'_>, origin: DVec3) -> Result<[Texture; 3], ShadowError> {
    let patches = colours.patches;
    let (layers, most) = (patches.pages.max(1), gpu.limits.max_texture_array_layers);
    if layers > most {
        let why = format!("the surfaces fill {layers} textures of at most {most}; use larger texels");
        return Err(GpuError::Failed { adapter: gpu.name().to_owned(), reason: why }.into());
    }
    let numbers = colours.patch_of.iter().map(|patch| patch.unwrap_or(NO_PATCH)).collect();
    let numbers = rows(gpu, "picture.patch_of", TextureFormat::R32Uint, numbers, NO_PATCH)?;
    // differences of origins in f64, so that nothing is lost far away
    let apart = patches.origin - origin;
    let frame = |patch: &crate::mesh::patches::Patch| {
        let row = |along: DVec3, last: f64| along.extend(last).as_vec4().to_array();
        let per_texel = 1.0 / patches.cell;
        let [x, y, page] = [patch.x, patch.y, patch.page].map(f64::from);
        let sides = if patch.two_sided { 2.0 } else { 1.0 };
        [
            row(patch.corner + apart, x),
            row(patch.right * per_texel, y),
            row(patch.down * per_texel, page),
            [patch.width as f32, patch.height as f32, sides, 0.0],
        ]
    };
    let frames = patches.list.iter().flat_map(frame).collect();
    let frames = rows(gpu, "picture.patches", TextureFormat::Rgba32Float, frames, [0.0_f32; 4])?;

    let side = patches.page_size.max(1);
    let size = Extent3d { width: side, height: side, depth_or_array_layers: layers };
    let atlas = gpu.device.create_texture(&TextureDescriptor {
        label: Some("picture.atlas"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format: COLOURS,
        usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (page, texels) in colours.pages.iter().enumerate() {
        let texels: Vec<[u8; 4]> = texels.iter().map(|&[r, g, b]| [r, g, b, 255]).collect();
        let origin = Origin3d { x: 0, y: 0, z: page as u32 };
        let to = TexelCopyTextureInfo { texture: &atlas, mip_level: 0, origin, aspect: TextureAspect::All };
        let layout = TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(side * 4), rows_per_image: None };
        let one = Extent3d { depth_or_array_layers: 1, ..size };
        gpu.queue.write_texture(to, bytemuck::cast_slice(&texels), layout, one);
    }
    gpu.check()?;
    Ok([numbers, frames, atlas])
}

/// A texture of texels in order, in rows as for planes.
fn rows<T: bytemuck::Pod>(
    gpu: &Gpu,
    label: &str,
    format: TextureFormat,
    mut texels: Vec<T>,
    empty: T,
) -> Result<Texture, ShadowError> {
    let rows = texels.len().div_ceil(PLANES_WIDTH).max(1);
    let most = gpu.limits.max_texture_dimension_2d as usize;
    if rows > most {
        let why = format!("the surfaces need {rows} rows of a texture, which has at most {most}; use larger texels");
        return Err(GpuError::Failed { adapter: gpu.name().to_owned(), reason: why }.into());
    }
    texels.resize(rows * PLANES_WIDTH, empty);
    let size = (PLANES_WIDTH as u32, rows as u32);
    let texture = gpu.texture(label, size, format, TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST);
    write(gpu, &texture, bytemuck::cast_slice(&texels));
    Ok(texture)
}
