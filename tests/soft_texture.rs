//! Registered soft shadow textures on flat patches: all ways of filling them against rays and against each other, cell
//! by cell; against closed forms; and the hours on patches of a study.

mod closed_forms;
mod hours;
mod picture;
mod rectangles;
mod scenes;
mod sites;

use glam::DVec3;
use gnomon::gpu::Gpu;
use gnomon::mesh::patches::{MOST_TEXELS, Patch, Patches, Texel};
use gnomon::mesh::{Mesh, Part};
use gnomon::shadow::soft_texture::{Choice, Fill, Painter, Sample, SoftTexture};
use std::sync::{Arc, OnceLock};

/// On the adapter an edge may lie so far aside, texels: rasterisers snap to 1/256, and single precision adds to that.
const ADAPTERS_EDGE: f64 = 1.0 / 100.0;

/// What casts, and its patches.
struct Scene {
    casters: Mesh,
    patches: Arc<Patches>,
}

impl Scene {
    /// Everything casts and receives.
    fn of(parts: Vec<Part>, cell: f64) -> Scene {
        let casters = Mesh::build(parts).expect("a mesh");
        let receives = vec![true; casters.components.len()];
        let patches = Arc::new(Patches::of(&casters, &receives, cell, MOST_TEXELS));
        Scene { casters, patches }
    }

    fn sums(&self, painter: Painter, choice: Choice, samples: &[Sample]) -> Vec<u32> {
        let texture = SoftTexture::new(self.casters.clone(), Arc::clone(&self.patches), painter, choice);
        let mut texture = texture.expect("a technique");
        texture.add(samples).expect("sums");
        texture.finish().expect("sums")
    }

    fn filled(&self, fill: Fill, samples: &[Sample]) -> Vec<u32> {
        self.sums(Painter::OnProcessor(fill), Choice::Texture, samples)
    }

    fn rays(&self, samples: &[Sample]) -> Vec<u32> {
        self.sums(Painter::OnProcessor(Fill::Faces), Choice::Rays, samples)
    }

    /// The processor's ways agree with rays in every texel, whoever chooses. Returns what all found.
    fn check(&self, samples: &[Sample], choices: &[Choice]) -> Vec<u32> {
        let truth = self.rays(samples);
        assert!(truth.iter().any(|sum| *sum != truth[0]), "no shadow falls anywhere");
        for choice in choices {
            for fill in [Fill::Faces, Fill::Silhouettes] {
                let found = self.sums(Painter::OnProcessor(fill), *choice, samples);
                assert_eq!(differing(&truth, &found), Vec::<usize>::new(), "{fill:?}, {choice:?}");
            }
        }
        truth
    }

    /// Holds what the adapter draws.
    fn check_adapter(&self, samples: &[Sample], choice: Choice) -> usize {
        self.check_at_edges(samples, choice, &self.sums(Painter::OnGpu(gpu()), choice, samples))
    }

    /// What was drawn differs from the processor's only where that differs within [`ADAPTERS_EDGE`] of the centre, sample
    /// by sample: weights are powers of two. Returns how many texels do.
    fn check_at_edges(&self, samples: &[Sample], choice: Choice, drawn: &[u32]) -> usize {
        let truth = self.sums(Painter::OnProcessor(Fill::Faces), choice, samples);
        let differing = differing(&truth, drawn);
        // their patches alone
        let is_there = |patch: &Patch| differing.iter().any(|&at| patch.texels.contains(&(at as u32)));
        let (scene, texels) = self.of_patches(is_there);
        let (mut ever, mut always) = (vec![0; texels.len()], vec![u32::MAX; texels.len()]);
        let straight = [[0.0, 0.0], [-1.0, 0.0], [1.0, 0.0], [0.0, -1.0], [0.0, 1.0]];
        let aslant = [[-0.7, -0.7], [0.7, -0.7], [-0.7, 0.7], [0.7, 0.7]];
        for aside in straight.into_iter().chain(aslant) {
            let aside = scene.moved(aside.map(|by| by * ADAPTERS_EDGE));
            let near = aside.sums(Painter::OnProcessor(Fill::Faces), choice, samples);
            for ((ever, always), near) in ever.iter_mut().zip(&mut always).zip(near) {
                *ever |= near;
                *always &= near;
            }
        }
        for ((&at, ever), always) in texels.iter().zip(ever).zip(always) {
            assert_eq!((drawn[at] & !ever, !drawn[at] & always), (0, 0), "texel {at} is far from any edge");
        }
        differing.len()
    }

    /// Some of the patches, and which texels they have.
    fn of_patches(&self, keep: impl Fn(&Patch) -> bool) -> (Scene, Vec<usize>) {
        let mut patches = (*self.patches).clone();
        patches.list.retain(keep);
        let mut texels = Vec::new();
        for patch in &mut patches.list {
            let first = texels.len() as u32;
            texels.extend(patch.texels.start as usize..patch.texels.end as usize);
            patch.texels = first..texels.len() as u32;
        }
        patches.texels = texels.iter().map(|&at| self.patches.texels[at]).collect();
        (Scene { casters: self.casters.clone(), patches: Arc::new(patches) }, texels)
    }

    /// Where a patch's texels are judged in the world, and their sums.
    fn of_patch<'a>(&'a self, patch: &'a Patch, sums: &'a [u32]) -> impl Iterator<Item = (DVec3, u32)> {
        let texels = patch.texels.start as usize..patch.texels.end as usize;
        let point = |texel: &Texel| self.patches.point(patch, *texel) + self.patches.origin;
        self.patches.texels[texels.clone()].iter().map(point).zip(sums[texels].iter().copied())
    }

    /// The same, judged at an offset in texels.
    fn moved(&self, [right, down]: [f64; 2]) -> Scene {
        let mut patches = (*self.patches).clone();
        let cell = patches.cell;
        for patch in &mut patches.list {
            patch.corner += (patch.right * right + patch.down * down) * cell;
        }
        Scene { casters: self.casters.clone(), patches: Arc::new(patches) }
    }
}

fn gpu() -> Arc<Gpu> {
    static GPU: OnceLock<Arc<Gpu>> = OnceLock::new();
    Arc::clone(GPU.get_or_init(|| Arc::new(Gpu::open().expect("a graphics adapter"))))
}

/// The texels whose sums differ.
fn differing(one: &[u32], other: &[u32]) -> Vec<usize> {
    assert_eq!(one.len(), other.len());
    (0..one.len()).filter(|&at| one[at] != other[at]).collect()
}

/// Samples whose sum tells which of them were seen.
fn weighed(lights: impl IntoIterator<Item = glam::DVec4>) -> Vec<Sample> {
    (0..).zip(lights).map(|(at, light)| Sample { light, weight: 1 << at }).collect()
}
