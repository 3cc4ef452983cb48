//! Masks times weights, added up where the masks are, in integers.

use super::Shaded;
use crate::gpu::layout::Weight;
use crate::gpu::targets::{NUMBER, whole};
use crate::gpu::{Gpu, readback, shaders};
use crate::shadow::{DrawnMask, ShadowError};
use crate::view::{Bits, Mask};
use rayon::prelude::*;
use std::sync::Arc;
use wgpu::*;

/// The running sum of shaded time, in 1/255 s.
///
/// It runs in words of 32 bits, and is poured over into 64 before one of them could overflow.
pub struct Sum {
    running: Running,
    /// How many seconds may be in the running words.
    secs: u32,
    /// What was poured over.
    poured: Option<Vec<u64>>,
}

enum Running {
    /// For masks in the processor's memory.
    Memory(Vec<u32>),
    /// For masks on the GPU.
    Texture(Box<GpuSum>),
}

/// The longest time that 32 bits hold in 1/255 s, seconds: 194 days.
pub const MOST_SECS: u32 = u32::MAX / 255;

/// A sum in a texture, and the pipeline that adds to it.
struct GpuSum {
    gpu: Arc<Gpu>,
    sum: Texture,
    weight: Buffer,
    pipeline: ComputePipeline,
}

impl Sum {
    /// All zero; on the GPU where masks are drawn there.
    pub fn new(gpu: Option<Arc<Gpu>>, width: u32, height: u32) -> Sum {
        let running = match gpu {
            None => Running::Memory(vec![0; width as usize * height as usize]),
            Some(gpu) => Running::Texture(Box::new(GpuSum::new(gpu, width, height))),
        };
        Sum { running, secs: 0, poured: None }
    }

    /// Goes on from a sum over so many seconds.
    pub fn begin_with(&mut self, shaded: &Shaded, secs: u32) {
        match (&mut self.running, shaded.in_one_word()) {
            (Running::Memory(running), Some(cells)) if secs <= MOST_SECS => {
                running.copy_from_slice(cells);
                self.secs = secs;
            }
            _ => self.poured = Some(shaded.iter().collect()),
        }
    }

    /// Adds one mask for so many seconds. A mask that lies elsewhere than the sum is fetched or brought there.
    pub fn add(&mut self, mask: &DrawnMask<'_>, weight_secs: u32) -> Result<(), ShadowError> {
        let mut left = weight_secs;
        loop {
            let now = left.min(MOST_SECS - self.secs);
            if now > 0 || left == 0 {
                self.add_to_running(mask, now)?;
                self.secs += now;
                left -= now;
            }
            if left == 0 {
                return Ok(());
            }
            self.pour()?;
        }
    }

    fn add_to_running(&mut self, mask: &DrawnMask<'_>, secs: u32) -> Result<(), ShadowError> {
        match (&mut self.running, mask) {
            (Running::Texture(sum), DrawnMask::Texture(_, texture)) => sum.add(texture, secs),
            (Running::Memory(sum), DrawnMask::Memory(mask)) => add(sum, &mask.share, secs),
            (Running::Memory(sum), DrawnMask::Bits(bits)) => add_bits(sum, bits, secs),
            (Running::Memory(sum), mask) => add(sum, &mask.read()?.share, secs),
            (Running::Texture(sum), mask) => sum.add(&sum.bring(&mask.read()?), secs),
        }
        Ok(())
    }

    /// Pours the running words over into the larger ones.
    fn pour(&mut self) -> Result<(), ShadowError> {
        self.poured = Some(self.larger()?);
        self.secs = 0;
        match &mut self.running {
            Running::Memory(sum) => sum.fill(0),
            Running::Texture(sum) => sum.clear(),
        }
        Ok(())
    }

    /// All of it in larger words.
    fn larger(&self) -> Result<Vec<u64>, ShadowError> {
        let read;
        let running = match &self.running {
            Running::Memory(sum) => sum,
            Running::Texture(sum) => {
                read = sum.read()?;
                &read
            }
        };
        Ok(match &self.poured {
            None => running.iter().map(|&running| running.into()).collect(),
            Some(poured) => running.iter().zip(poured).map(|(&running, poured)| u64::from(running) + poured).collect(),
        })
    }

    /// The sum so far. Slow where it is on the GPU: it is read back.
    pub fn so_far(&self) -> Result<Shaded, ShadowError> {
        match (&self.running, &self.poured) {
            (Running::Memory(sum), None) => Ok(sum.clone().into()),
            (Running::Texture(sum), None) => Ok(sum.read()?.into()),
            _ => Ok(self.larger()?.into()),
        }
    }

    /// The sum.
    pub fn finish(self) -> Result<Shaded, ShadowError> {
        match self {
            Sum { running: Running::Memory(sum), poured: None, .. } => Ok(sum.into()),
            sum => sum.so_far(),
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
    fn new(gpu: Arc<Gpu>, width: u32, height: u32) -> GpuSum {
        let sum = Self::zero(&gpu, width, height);
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
        GpuSum { gpu, sum, weight, pipeline }
    }

    /// New textures are zero.
    fn zero(gpu: &Gpu, width: u32, height: u32) -> Texture {
        let usage = TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC;
        gpu.texture("accumulate.sum", (width, height), NUMBER, usage)
    }

    fn clear(&mut self) {
        self.sum = Self::zero(&self.gpu, self.sum.width(), self.sum.height());
    }

    fn read(&self) -> Result<Vec<u32>, ShadowError> {
        Ok(readback::texels(&self.gpu, &self.sum, TextureAspect::All)?)
    }

    /// A mask in a texture.
    fn bring(&self, mask: &Mask) -> Texture {
        let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
        let texture = self.gpu.texture("accumulate.mask", (mask.width, mask.height), TextureFormat::R8Unorm, usage);
        self.gpu.queue.write_texture(
            texture.as_image_copy(),
            &mask.share,
            TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(mask.width), rows_per_image: None },
            texture.size(),
        );
        texture
    }

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
