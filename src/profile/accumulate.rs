//! Sums masks times weights as integers, on the machine where the masks are.

use super::Shaded;
use crate::gpu::layout::WeightUniforms;
use crate::gpu::targets::{NUMBER, whole};
use crate::gpu::{Gpu, readback, shaders};
use crate::shadow::{DrawnMask, ShadowError};
use crate::view::{Bits, Mask};
use rayon::prelude::*;
use std::sync::Arc;
use wgpu::*;

/// The running sum of shaded time, in 1/255 s.
///
/// It accumulates in words of 32 bits, and is transferred to 64 bits before one of them could overflow. Masks of bits
/// are first counted, several with one weight together, and then added.
pub struct Sum {
    running: RunningSum,
    counted: BitCounts,
    /// The greatest number of seconds in the 32-bit words so far.
    secs: u32,
    /// The sums in 64 bits, once there are some.
    poured: Option<Vec<u64>>,
}

enum RunningSum {
    /// For masks in the processor's memory.
    Memory(Vec<u32>),
    /// For masks on the GPU.
    Texture(Box<GpuSum>),
}

/// The number of times that cells were in shadow, over several instants with one weight. The 64 cells of each word are
/// counted in parallel: the first plane holds the lowest digits of their counts.
#[derive(Default)]
struct BitCounts {
    planes: Vec<[u64; BitCounts::PLANES]>,
    width: u32,
    /// The number of instants, and the seconds for which each stands.
    instants: u32,
    secs: u32,
}

impl BitCounts {
    const PLANES: usize = 4;
    /// The greatest number of instants.
    const MOST: u32 = (1 << Self::PLANES) - 1;

    fn count(&mut self, bits: &Bits) {
        self.width = bits.width;
        self.planes.resize(bits.words.len(), [0; Self::PLANES]);
        self.planes.par_iter_mut().zip(&bits.words).with_min_len(1 << 12).for_each(|(planes, word)| {
            planes.iter_mut().fold(*word, |carry, plane| {
                let both = *plane & carry;
                *plane ^= carry;
                both
            });
        });
        self.instants += 1;
    }

    /// Adds the counts to the sum, and resets them.
    fn add_to(&mut self, sum: &mut [u32]) {
        if self.instants == 0 {
            return;
        }
        let width = self.width.max(1) as usize;
        let weights: [u32; Self::PLANES] = std::array::from_fn(|plane| (255 * self.secs) << plane);
        let rows = sum.par_chunks_mut(width).zip(self.planes.par_chunks_mut(width.div_ceil(64)));
        rows.with_min_len(16).for_each(|(sums, of_row)| {
            for (sums, planes) in sums.chunks_mut(64).zip(of_row) {
                let planes = std::mem::take(planes);
                if planes != [0; Self::PLANES] {
                    add_planes(sums, planes.map(u64::to_le_bytes), weights);
                }
            }
        });
        self.instants = 0;
    }
}

/// Adds counts in planes to the sums of a word's cells; each plane has a weight.
fn add_planes<const N: usize>(sums: &mut [u32], planes: [[u8; 8]; N], weights: [u32; N]) {
    // eight cells at once
    let shaded = |byte: usize| {
        let mut shaded = [0; 8];
        for (plane, weight) in planes.iter().zip(weights) {
            let each = &EACH[usize::from(plane[byte])];
            shaded.iter_mut().zip(each).for_each(|(shaded, each)| *shaded += each & weight);
        }
        shaded
    };
    let add = |sums: &mut [u32], shaded: [u32; 8]| sums.iter_mut().zip(shaded).for_each(|(sum, shaded)| *sum += shaded);
    let (eights, rest) = sums.as_chunks_mut::<8>();
    eights.iter_mut().enumerate().for_each(|(byte, sums)| add(sums, shaded(byte)));
    if !rest.is_empty() {
        add(rest, shaded(eights.len()));
    }
}

/// The longest time that 32 bits hold in 1/255 s, seconds: 194 days.
pub(crate) const MOST_SECS: u32 = u32::MAX / 255;

/// A sum in a texture, and the pipeline that adds to it.
struct GpuSum {
    gpu: Arc<Gpu>,
    sum: Texture,
    weight: Buffer,
    pipeline: ComputePipeline,
}

impl Sum {
    /// A sum of zero, on the GPU if masks are drawn there.
    pub fn new(gpu: Option<Arc<Gpu>>, width: u32, height: u32) -> Sum {
        let running = match gpu {
            None => RunningSum::Memory(vec![0; width as usize * height as usize]),
            Some(gpu) => RunningSum::Texture(Box::new(GpuSum::new(gpu, width, height))),
        };
        Sum { running, counted: BitCounts::default(), secs: 0, poured: None }
    }

    /// Continues from a sum over that many seconds.
    pub fn begin_with(&mut self, shaded: &Shaded, secs: u32) {
        match (&mut self.running, shaded.in_one_word()) {
            (RunningSum::Memory(running), Some(cells)) if secs <= MOST_SECS => {
                running.copy_from_slice(cells);
                self.secs = secs;
            }
            _ => self.poured = Some(shaded.iter().collect()),
        }
    }

    /// Adds one mask for that many seconds. If mask and sum are on different machines, the mask is copied.
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

    /// Adds a gap's seconds to cells that are in shadow at both of its ends. The parts for other cells follow by
    /// [`Sum::add_in_gap`]; the words have room for all of them.
    ///
    /// # Errors
    /// [`ShadowError`] if the sum is on an adapter.
    pub fn add_gap(&mut self, [before, after]: [&Bits; 2], secs: u32) -> Result<(), ShadowError> {
        if secs > MOST_SECS - self.secs {
            self.pour()?;
        }
        self.add(&DrawnMask::Bits(&before.with(after, |before, after| before & after)), secs)
    }

    /// Adds parts of the last gap's seconds to single cells, counted along the rows: to each its own.
    ///
    /// # Errors
    /// As [`Sum::add_gap`].
    pub fn add_in_gap(&mut self, cells: &[(usize, u32)]) -> Result<(), ShadowError> {
        if let RunningSum::Memory(sum) = &mut self.running {
            cells.iter().for_each(|&(cell, secs)| sum[cell] += 255 * secs);
            return Ok(());
        }
        // only the processor searches single cells
        self.pour()?;
        let poured = self.poured.get_or_insert_default();
        cells.iter().for_each(|&(cell, secs)| poured[cell] += 255 * u64::from(secs));
        Ok(())
    }

    fn add_to_running(&mut self, mask: &DrawnMask<'_>, secs: u32) -> Result<(), ShadowError> {
        match (&mut self.running, mask) {
            (RunningSum::Texture(sum), DrawnMask::Texture(_, texture)) => sum.add(texture, secs),
            (RunningSum::Memory(sum), DrawnMask::Memory(mask)) => add(sum, &mask.share, secs),
            (RunningSum::Memory(sum), DrawnMask::Bits(bits)) => {
                let counted = &mut self.counted;
                if counted.secs != secs || counted.instants == BitCounts::MOST {
                    counted.add_to(sum);
                    counted.secs = secs;
                }
                counted.count(bits);
            }
            (RunningSum::Memory(sum), mask) => add(sum, &mask.read()?.share, secs),
            (RunningSum::Texture(sum), mask) => sum.add(&sum.bring(&mask.read()?), secs),
        }
        Ok(())
    }

    /// Adds what is only counted so far.
    fn settle(&mut self) {
        if let RunningSum::Memory(sum) = &mut self.running {
            self.counted.add_to(sum);
        }
    }

    /// Transfers the 32-bit words to the larger ones.
    fn pour(&mut self) -> Result<(), ShadowError> {
        self.settle();
        self.poured = Some(self.larger()?);
        self.secs = 0;
        match &mut self.running {
            RunningSum::Memory(sum) => sum.fill(0),
            RunningSum::Texture(sum) => sum.clear(),
        }
        Ok(())
    }

    /// The whole sum in larger words.
    fn larger(&self) -> Result<Vec<u64>, ShadowError> {
        let read;
        let running = match &self.running {
            RunningSum::Memory(sum) => sum,
            RunningSum::Texture(sum) => {
                read = sum.read()?;
                &read
            }
        };
        Ok(match &self.poured {
            None => running.iter().map(|&running| running.into()).collect(),
            Some(poured) => running.iter().zip(poured).map(|(&running, poured)| u64::from(running) + poured).collect(),
        })
    }

    /// The sum so far. On the GPU this is slow, as the sum is read back.
    pub fn so_far(&mut self) -> Result<Shaded, ShadowError> {
        self.settle();
        match (&self.running, &self.poured) {
            (RunningSum::Memory(sum), None) => Ok(sum.clone().into()),
            (RunningSum::Texture(sum), None) => Ok(sum.read()?.into()),
            _ => Ok(self.larger()?.into()),
        }
    }

    /// The final sum.
    pub fn finish(mut self) -> Result<Shaded, ShadowError> {
        self.settle();
        match self {
            Sum { running: RunningSum::Memory(sum), poured: None, .. } => Ok(sum.into()),
            mut sum => sum.so_far(),
        }
    }
}

fn add(sum: &mut [u32], share: &[u8], weight_secs: u32) {
    sum.par_iter_mut().zip(share).with_min_len(1 << 14).for_each(|(sum, &share)| {
        *sum += u32::from(255 - share) * weight_secs;
    });
}

/// For each byte, its bits, lowest first, each as a word of ones or of zeros.
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
        let weight = gpu.uniform::<WeightUniforms>("accumulate.weight");
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

    /// Copies a mask to a texture.
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
        gpu.queue.write_buffer(weight, 0, bytemuck::bytes_of(&WeightUniforms { secs }));
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
