//! Masks times weights, added up where the masks are, in integers.

use crate::gpu::layout::Weight;
use crate::gpu::targets::{NUMBER, whole};
use crate::gpu::{Gpu, readback, shaders};
use crate::shadow::{DrawnMask, ShadowError};
use crate::view::Bits;
use rayon::prelude::*;
use std::sync::Arc;
use wgpu::*;

/// The running sum of shaded time, in 1/255 s.
pub enum Sum {
    /// For masks in the processor's memory.
    Memory(Vec<u32>),
    /// For masks on the GPU.
    Texture(Box<GpuSum>),
}

/// A sum in a texture, and the pipeline that adds to it.
pub struct GpuSum {
    gpu: Arc<Gpu>,
    sum: Texture,
    weight: Buffer,
    pipeline: ComputePipeline,
}

impl Sum {
    /// All zero; on the GPU where masks are drawn there.
    pub fn new(gpu: Option<Arc<Gpu>>, width: u32, height: u32) -> Sum {
        let Some(gpu) = gpu else { return Sum::Memory(vec![0; width as usize * height as usize]) };
        // new textures are zero
        let usage = TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC;
        let sum = gpu.texture("accumulate.sum", (width, height), NUMBER, usage);
        let module = gpu.shader("accumulate", shaders::ACCUMULATE);
        let pipeline = gpu.device.create_compute_pipeline(&ComputePipelineDescriptor {
            label: Some("accumulate"),
            layout: None,
            module: &module,
            entry_point: Some("accumulate"),
            compilation_options: PipelineCompilationOptions::default(),
            cache: None,
        });
        let weight = gpu.uniform::<Weight>("accumulate.weight");
        Sum::Texture(Box::new(GpuSum { gpu, sum, weight, pipeline }))
    }

    /// Adds one mask for so many seconds. A mask that lies elsewhere than the sum is fetched or brought there.
    pub fn add(&mut self, mask: &DrawnMask<'_>, weight_secs: u32) -> Result<(), ShadowError> {
        match (self, mask) {
            (Sum::Texture(sum), DrawnMask::Texture(_, texture)) => sum.add(texture, weight_secs),
            (Sum::Memory(sum), DrawnMask::Memory(mask)) => add(sum, &mask.share, weight_secs),
            (Sum::Memory(sum), DrawnMask::Bits(bits)) => add_bits(sum, bits, weight_secs),
            (Sum::Memory(sum), mask) => add(sum, &mask.read()?.share, weight_secs),
            (Sum::Texture(sum), mask) => {
                let mask = mask.read()?;
                let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
                let texture =
                    sum.gpu.texture("accumulate.mask", (mask.width, mask.height), TextureFormat::R8Unorm, usage);
                sum.gpu.queue.write_texture(
                    texture.as_image_copy(),
                    &mask.share,
                    TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(mask.width), rows_per_image: None },
                    texture.size(),
                );
                sum.add(&texture, weight_secs);
            }
        }
        Ok(())
    }

    /// Per cell the shaded time in 1/255 s.
    pub fn finish(self) -> Result<Vec<u32>, ShadowError> {
        match self {
            Sum::Memory(sum) => Ok(sum),
            Sum::Texture(sum) => Ok(readback::texels(&sum.gpu, &sum.sum, TextureAspect::All)?),
        }
    }
}

fn add(sum: &mut [u32], share: &[u8], weight_secs: u32) {
    sum.par_iter_mut().zip(share).with_min_len(1 << 14).for_each(|(sum, &share)| {
        *sum += u32::from(255 - share) * weight_secs;
    });
}

fn add_bits(sum: &mut [u32], bits: &Bits, weight_secs: u32) {
    let rows = sum.par_chunks_mut(bits.width.max(1) as usize).zip(bits.words.par_chunks(bits.in_row().max(1)));
    rows.with_min_len(16).for_each(|(sums, words)| {
        for (sums, word) in sums.chunks_mut(64).zip(words).filter(|(_, word)| **word != 0) {
            for (sums, byte) in sums.chunks_mut(8).zip(word.to_le_bytes()) {
                let each = &EACH[usize::from(byte)];
                sums.iter_mut().zip(each).for_each(|(sum, each)| *sum += each & (255 * weight_secs));
            }
        }
    });
}

/// Per byte its bits, the lowest first, each as a word of ones or of zeros.
static EACH: [[u32; 8]; 256] = {
    let mut each = [[0; 8]; 256];
    let mut byte = 0;
    while byte < 256 {
        let mut bit = 0;
        while bit < 8 {
            each[byte][bit] = if byte >> bit & 1 == 1 { u32::MAX } else { 0 };
            bit += 1;
        }
        byte += 1;
    }
    each
};

impl GpuSum {
    fn add(&self, mask: &Texture, secs: u32) {
        let GpuSum { gpu, sum, weight, pipeline } = self;
        gpu.queue.write_buffer(weight, 0, bytemuck::bytes_of(&Weight { secs }));
        let group = gpu.bind(
            "accumulate",
            &pipeline.get_bind_group_layout(0),
            &[
                (0, BindingResource::TextureView(&whole(mask))),
                (1, BindingResource::TextureView(&whole(sum))),
                (2, weight.as_entire_binding()),
            ],
        );
        let mut encoder = gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
        let mut pass =
            encoder.begin_compute_pass(&ComputePassDescriptor { label: Some("accumulate"), timestamp_writes: None });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(mask.width().div_ceil(16), mask.height().div_ceil(16), 1);
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
    }
}
