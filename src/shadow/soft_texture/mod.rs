//! Registered soft shadow textures: which of a light's samples every texel of a flat patch sees.
//!
//! M. Herf, *Efficient Generation of Soft Shadow Textures*, CMU-CS-97-138, 1997. For each patch and each sample the
//! faces between them are projected onto the patch's own texels ([`crate::shadow::registered`]) and filled. All
//! samples' hard shadows register, so they are simply added. Samples are points of the sun's disc, which give a soft
//! shadow at an instant; or the instants of a study, which give hours of sun on a façade; or points of a lamp. The code
//! is the same.
//!
//! What we changed: sums are integers with a weight for each sample; a tree of boxes culls faces for each patch; a
//! patch is judged a millimetre above itself, so that it never shades itself and gets no light through a wall that
//! stands on it; the paper's factor of an unoccluded light (`unoccluded`, a hook for tests) is computed separately, as
//! hours do not need it.
//!
//! Where it fails: a texel has the value of its centre; and rays cost less with many tiny patches, and towards the sun
//! ([`Choice::Auto`], `rectangles`).

mod between;
#[cfg(feature = "test-hooks")]
mod factor;
mod fill;
mod fine;
mod occluders;
mod on_gpu;
mod order;
mod query;
mod rectangles;

pub use between::TextureGap;
#[cfg(feature = "test-hooks")]
pub use factor::unoccluded;
pub use fill::Fill;
pub use query::{Choice, FEWEST_DRAWN, MOST_FACES_A_TEXEL, PatchJudgements, Sample};

use super::ray_cast::{RayCaster, Shear, TIE};
use super::registered::RasterProjection;
use super::{JUDGED_ABOVE_M, ShadowError};
use crate::gpu::Gpu;
use crate::mesh::Mesh;
use crate::mesh::patches::{Patch, Patches, Texel};
use arrayvec::ArrayVec;
use fill::{CasterFaces, Scratch};
use glam::{DVec3, DVec4};
use occluders::Occluders;
use on_gpu::AdapterDrawer;
use query::{OccluderQuery, is_drawn, raster};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

/// The machine that fills hard shadows.
#[derive(Clone)]
pub enum Painter {
    /// The processor.
    OnProcessor(Fill),
    /// The graphics adapter, which fills every face.
    OnGpu(Arc<Gpu>),
}

/// The technique, made for the casters of one scene and its patches.
pub struct SoftTexture {
    casters: Mesh,
    patches: Arc<Patches>,
    /// The patches' indices, those that lie close together after each other.
    order: Vec<u32>,
    /// Found when textures are filled for the first time.
    occluders: OnceLock<Occluders>,
    rays: RayCaster,
    choice: Choice,
    fill: Fill,
    /// Whether to cull; otherwise, every face is filled for every patch, as in the paper.
    culling: bool,
    /// For each texel the weights of the samples it sees, as far as the processor added them.
    sums: Vec<u32>,
    drawer: Option<AdapterDrawer>,
    counts: [AtomicU64; 5],
}

impl SoftTexture {
    /// Prepares the technique for the casting faces of a mesh, whose origin must be that of the patches.
    ///
    /// # Errors
    /// [`ShadowError::Gpu`]
    pub fn new(
        casters: Mesh,
        patches: Arc<Patches>,
        painter: Painter,
        choice: Choice,
    ) -> Result<SoftTexture, ShadowError> {
        let farthest = |patch: &Patch| {
            let far = patches.cell * f64::from(patch.width.max(patch.height));
            patch.corner.abs().max_element() + 2.0 * far
        };
        let reach = patches.list.iter().map(farthest).fold(0.0, f64::max);
        let (fill, gpu) = match painter {
            Painter::OnProcessor(fill) => (fill, None),
            Painter::OnGpu(gpu) => (Fill::Faces, Some(gpu)),
        };
        Ok(SoftTexture {
            occluders: OnceLock::new(),
            rays: RayCaster::new(&casters, reach),
            drawer: gpu.map(|gpu| AdapterDrawer::new(gpu, &casters, &patches, choice)).transpose()?,
            casters,
            sums: vec![0; patches.texels.len()],
            order: order::along_a_curve(&patches),
            patches,
            choice,
            fill,
            culling: true,
            counts: Default::default(),
        })
    }

    /// Fills every face for every patch, as the paper does, for measurements.
    #[cfg(feature = "test-hooks")]
    pub fn without_culling(mut self) -> SoftTexture {
        self.culling = false;
        self
    }

    /// Adds the weight of each sample to the texels that see it.
    ///
    /// # Errors
    /// [`ShadowError::Gpu`]
    pub fn add(&mut self, samples: &[Sample]) -> Result<(), ShadowError> {
        let origin = DVec4::from((self.patches.origin, 0.0));
        let samples: Vec<Sample> =
            samples.iter().map(|sample| Sample { light: sample.light - origin * sample.light.w, ..*sample }).collect();
        let mut sums = std::mem::take(&mut self.sums);
        let added = self.add_to(&samples, &mut sums);
        self.sums = sums;
        added
    }

    /// The same, for the processor's sums.
    fn add_to(&self, samples: &[Sample], sums: &mut [u32]) -> Result<(), ShadowError> {
        let judge = self.judge(samples);
        let drawer = self.drawer.as_ref();
        // what the adapter leaves to rays
        let mut left = vec![Vec::new(); if drawer.is_some() { samples.len() } else { 0 }];
        if let Some(drawer) = drawer {
            for (sample, left) in samples.iter().zip(&mut left) {
                let (judged, rest) = drawer.add(&judge.sought, &self.casters, sample)?;
                count(&self.counts, judged);
                *left = rest;
            }
        }
        self.work_on(sums).into_par_iter().for_each_init(Scratch::default, |scratch, (at, patch, sums)| {
            let on_adapter = drawer.is_some() && is_drawn(patch, judge.sought.choice);
            for (number, sample) in samples.iter().enumerate() {
                if !on_adapter {
                    judge.add(patch, sample, sums, scratch);
                } else if left[number].binary_search(&at).is_ok() {
                    judge.cast(patch, sample, sums, scratch);
                }
            }
        });
        Ok(())
    }

    /// The patches, each with its index and its texels' sums, neighbours after each other.
    fn work_on<'a>(&'a self, sums: &'a mut [u32]) -> Vec<(u32, &'a Patch, &'a mut [u32])> {
        let mut rest = sums;
        let mut work = Vec::with_capacity(self.patches.list.len());
        for (at, patch) in (0..).zip(&self.patches.list) {
            let (sums, after) = rest.split_at_mut(patch.texels.len());
            rest = after;
            work.push(Some((at, patch, sums)));
        }
        self.order.iter().filter_map(|&at| work[at as usize].take()).collect()
    }

    /// The judge of patches for some samples.
    fn judge(&self, samples: &[Sample]) -> PatchJudge<'_> {
        let SoftTexture { casters, patches, rays, choice, fill, culling, counts, .. } = self;
        let fills = match choice {
            Choice::Texture => true,
            Choice::Rays => false,
            Choice::Auto => self.is_on_adapter() || samples.iter().any(|sample| sample.light.w != 0.0),
        };
        let occluders = (fills && !samples.is_empty()).then(|| self.occluders.get_or_init(|| Occluders::new(casters)));
        let sought = OccluderQuery { patches, occluders, culling: *culling, choice: *choice };
        PatchJudge { sought, rays, casters, fill: *fill, counts }
    }

    /// Whether the graphics adapter fills textures.
    pub fn is_on_adapter(&self) -> bool {
        self.drawer.is_some()
    }

    /// Continues from earlier sums: one for each texel, as [`SoftTexture::so_far`] returns them.
    pub fn begin_with(&mut self, sums: &[u32]) {
        self.sums.copy_from_slice(sums);
    }

    /// How patches were judged so far.
    pub fn judged(&self) -> PatchJudgements {
        let [textures, texture_texels, faces, rays, rectangle_texels] =
            self.counts.each_ref().map(|count| count.load(Ordering::Relaxed));
        PatchJudgements { textures, texture_texels, faces, rays, rectangle_texels }
    }

    /// The graphics adapter's memory that is used, bytes; 0 without an adapter.
    pub fn gpu_bytes(&self) -> u64 {
        self.drawer.as_ref().map_or(0, AdapterDrawer::bytes)
    }

    /// For each texel of [`Patches::texels`], the sum of the weights of the samples so far that it sees.
    ///
    /// # Errors
    /// [`ShadowError::Gpu`]
    pub fn so_far(&self) -> Result<Vec<u32>, ShadowError> {
        self.added_to(self.sums.clone())
    }

    /// For each texel of [`Patches::texels`], the sum of the weights of the samples that it sees.
    ///
    /// # Errors
    /// [`ShadowError::Gpu`]
    pub fn finish(mut self) -> Result<Vec<u32>, ShadowError> {
        let sums = std::mem::take(&mut self.sums);
        self.added_to(sums)
    }

    /// The processor's sums plus those of the adapter.
    fn added_to(&self, mut sums: Vec<u32>) -> Result<Vec<u32>, ShadowError> {
        if let Some(drawer) = &self.drawer {
            for (sum, drawn) in sums.iter_mut().zip(drawer.sums()?) {
                *sum += drawn;
            }
        }
        Ok(sums)
    }
}

fn count(counts: &[AtomicU64; 5], judged: PatchJudgements) {
    let PatchJudgements { textures, texture_texels, faces, rays, rectangle_texels } = judged;
    let more = [textures, texture_texels, faces, rays, rectangle_texels];
    for (count, more) in counts.iter().zip(more).filter(|(_, more)| *more > 0) {
        count.fetch_add(more, Ordering::Relaxed);
    }
}

/// The texels of a patch for one beam. They are in a row, so more would make a long and wide beam.
const STRIP: usize = 16;

/// Judges patches on the processor.
struct PatchJudge<'a> {
    sought: OccluderQuery<'a>,
    rays: &'a RayCaster,
    casters: &'a Mesh,
    fill: Fill,
    counts: &'a [AtomicU64; 5],
}

impl PatchJudge<'_> {
    /// Adds a sample's weight to the texels of a patch that see it.
    fn add(&self, patch: &Patch, sample: &Sample, sums: &mut [u32], scratch: &mut Scratch) {
        if self.sought.occluders.is_none() {
            self.cast(patch, sample, sums, scratch);
            return;
        }
        let Some(raster) = raster(patch, self.sought.patches.cell, sample.light) else { return };
        let Some(onto) = RasterProjection::new(&raster, sample.light) else { return };
        let Some(occluders) = self.sought.find(patch, &onto, &mut scratch.waiting, &mut scratch.found) else {
            self.cast(patch, sample, sums, scratch);
            return;
        };
        let judged = PatchJudgements {
            textures: 1,
            texture_texels: sums.len() as u64,
            faces: scratch.found.len() as u64,
            ..PatchJudgements::default()
        };
        count(self.counts, judged);
        if scratch.found.is_empty() {
            sums.iter_mut().for_each(|sum| *sum += sample.weight);
            return;
        }
        let casting = CasterFaces { mesh: self.casters, occluders };
        let covered = casting.covered(self.fill, &onto, (patch.width, patch.height), scratch);
        for (sum, texel) in sums.iter_mut().zip(self.texels(patch)) {
            if !covered.at(texel.column.into(), texel.row.into()) {
                *sum += sample.weight;
            }
        }
    }

    fn texels(&self, patch: &Patch) -> &[Texel] {
        &self.sought.patches.texels[patch.texels.start as usize..patch.texels.end as usize]
    }

    /// The offset from a texel's centre to where it is judged, along the patch, as in filled textures; none for a patch
    /// with a single point.
    fn tie(&self, patch: &Patch) -> DVec3 {
        let tie = (patch.right * TIE.x - patch.down * TIE.y) * self.sought.patches.cell;
        if patch.alone.is_some() { DVec3::ZERO } else { tie }
    }

    /// The same by rays.
    fn cast(&self, patch: &Patch, sample: &Sample, sums: &mut [u32], scratch: &mut Scratch) {
        let Some(raster) = raster(patch, self.sought.patches.cell, sample.light) else { return };
        if self.sought.choice == Choice::Auto && sample.light.w == 0.0 {
            self.divide(patch, &raster, sample, sums, scratch);
            return;
        }
        count(self.counts, PatchJudgements { rays: sums.len() as u64, ..PatchJudgements::default() });
        let tie = self.tie(patch);
        let lift = raster.plane.truncate() * JUDGED_ABOVE_M;
        let sun = (sample.light.w == 0.0).then(|| Shear::along(sample.light.truncate()));
        let judged = |texel: &Texel| self.sought.patches.point(patch, *texel) + tie + lift;
        for (sums, texels) in sums.chunks_mut(STRIP).zip(self.texels(patch).chunks(STRIP)) {
            let points: ArrayVec<DVec3, STRIP> = texels.iter().map(judged).collect();
            let blocked = match &sun {
                Some(shear) => self.rays.blocked_beam(&points, shear),
                None => (0..).zip(&points).fold(0, |blocked, (at, point)| {
                    let to_lamp = sample.light.truncate() - *point;
                    let hit = self.rays.first_hit(*point, to_lamp).is_some_and(|(_, distance)| distance < 1.0);
                    blocked | u64::from(hit) << at
                }),
            };
            for (at, sum) in sums.iter_mut().enumerate() {
                if blocked >> at & 1 == 0 {
                    *sum += sample.weight;
                }
            }
        }
    }
}
