//! Compares the techniques that draw façades and roofs with ray casting, texel by texel.

use super::StudyError;
use super::patches::way_of;
use crate::choice::{Engine, Method, Promise, Settings, Subject, TABLE, Truth};
use crate::gpu::Gpu;
use crate::mesh::patches::{MOST_TEXELS, Patch, Patches, Texel};
use crate::profile::Provenance;
use crate::shadow::ShadowError;
use crate::shadow::soft_texture::{Choice, Fill, Painter, Sample, SoftTexture};
use crate::site::Site;
use crate::sun::Instant;
use crate::verification::{ComparedSurfaces, Difference, Edges, HoursDifference, Row};
use crate::view::Mask;
use glam::DVec3;
use rayon::prelude::*;
use std::sync::Arc;
use std::time;

/// Which part of an exact technique's edge texels may differ.
const EDGE_SHARE: f64 = 0.01;

/// Draws, under a sun, per texel 1 where it sees the sun's centre, else 0.
type DrawTexels = Box<dyn FnMut(DVec3) -> Result<Vec<u8>, ShadowError>>;

/// A technique that is compared on façades and roofs.
pub struct SurfaceTrial {
    /// What draws.
    pub drawn: Provenance,
    /// What it promises.
    pub promise: Promise,
    /// Draws a sun.
    pub draw: DrawTexels,
}

/// The façades and roofs of a site, the truth, and what is compared with it.
pub struct SurfaceTrials {
    patches: Arc<Patches>,
    truth: SoftTexture,
    trials: Vec<(SurfaceTrial, TexelTally)>,
}

/// What one technique came to so far.
struct TexelTally {
    difference: Difference,
    thin: u64,
    furthest: Option<f64>,
    /// Per texel, the seconds by which it had more sun than in the truth.
    secs_off: Vec<i64>,
    /// How long each instant took, seconds.
    secs: Vec<f64>,
}

impl SurfaceTrials {
    /// All techniques that draw façades and roofs, on the processor and on an adapter; `None` where a site has no flat
    /// surfaces.
    ///
    /// # Errors
    /// [`StudyError::Shadow`] where the adapter does not hold them.
    pub fn new(site: &Site, gpu: &Arc<Gpu>) -> Result<Option<SurfaceTrials>, StudyError> {
        let Some(mut compared) = Self::without_trials(site)? else { return Ok(None) };
        for row in TABLE.iter().filter(|row| row.method != Method::Auto) {
            let Some(promise) = row.on_patches.filter(|promise| *promise != Promise::Same) else { continue };
            for engine in [Engine::Cpu, Engine::Gpu].into_iter().filter(|on| row.draws(*on, Subject::Patches)) {
                let on_gpu = (engine == Engine::Gpu).then_some(gpu);
                let painter = on_gpu.map_or(Painter::OnProcessor(Fill::Silhouettes), |gpu| Painter::OnGpu(gpu.clone()));
                let casters = site.mesh.of_components(&site.casts);
                let texture = SoftTexture::new(casters, Arc::clone(&compared.patches), painter, way_of(row.method)?)?;
                let drawn = Provenance {
                    technique: row.method,
                    finder: None,
                    engine,
                    adapter: on_gpu.map(|gpu| gpu.name().to_owned()),
                    settings: Settings::NONE,
                    resolution_secs: 0,
                };
                compared.add(SurfaceTrial { drawn, promise, draw: Box::new(sampled(texture)) });
            }
        }
        Ok(Some(compared))
    }

    /// The truth alone.
    ///
    /// # Errors
    /// As [`SurfaceTrials::new`].
    pub fn without_trials(site: &Site) -> Result<Option<SurfaceTrials>, StudyError> {
        let patches = Arc::new(Patches::of(&site.mesh, &site.receives, texel(site), MOST_TEXELS));
        if patches.list.is_empty() {
            return Ok(None);
        }
        let (casters, painter) = (site.mesh.of_components(&site.casts), Painter::OnProcessor(Fill::Faces));
        let truth = SoftTexture::new(casters, Arc::clone(&patches), painter, Choice::Rays)?;
        Ok(Some(SurfaceTrials { patches, truth, trials: Vec::new() }))
    }

    /// The façades and roofs.
    #[cfg(feature = "test-hooks")]
    pub fn patches(&self) -> &Arc<Patches> {
        &self.patches
    }

    /// Adds a technique.
    pub fn add(&mut self, trial: SurfaceTrial) {
        let tally = TexelTally {
            difference: Difference::default(),
            thin: 0,
            furthest: None,
            secs_off: vec![0; self.patches.texels.len()],
            secs: Vec::new(),
        };
        self.trials.push((trial, tally));
    }

    /// How large the texels are, and how many there are.
    pub(super) fn compared(&self) -> ComparedSurfaces {
        ComparedSurfaces { cell: self.patches.cell, texels: self.patches.texels.len(), edge_share: EDGE_SHARE }
    }

    /// Draws an instant by all techniques, and compares them with the truth.
    ///
    /// # Errors
    /// What drawing says.
    pub(super) fn compare(&mut self, instant: &Instant) -> Result<(), ShadowError> {
        let SurfaceTrials { patches, truth, trials } = self;
        let seen = truth.seen(instant.to_sun)?;
        let truth = &*truth;
        for (trial, tally) in trials {
            let started = time::Instant::now();
            let drawn = (trial.draw)(instant.to_sun)?;
            tally.secs.push(started.elapsed().as_secs_f64());
            let weight = i64::from(instant.weight_secs);
            for (off, (drawn, seen)) in tally.secs_off.iter_mut().zip(drawn.iter().zip(&seen)) {
                *off += weight * (i64::from(*drawn) - i64::from(*seen));
            }
            let of_patch = |(number, patch): (usize, &Patch)| {
                let texels = patch.texels.start as usize..patch.texels.end as usize;
                let compared =
                    PatchTexels { patch, texels: &patches.texels[texels.clone()], seen: &seen[texels.clone()] };
                compared.compare(&drawn[texels], |texel| truth.is_uniform_around(number, texel, instant.to_sun))
            };
            let found: Vec<PatchDifference> = patches.list.par_iter().enumerate().map(of_patch).collect();
            for PatchDifference { difference, thin, furthest } in found {
                tally.difference.add(difference);
                tally.thin += thin;
                tally.furthest = furthest.into_iter().chain(tally.furthest).max_by(f64::total_cmp);
            }
        }
        Ok(())
    }

    /// A row for each technique; hours only where instants have a weight.
    pub(super) fn rows(self, has_weight: bool) -> impl Iterator<Item = Row> {
        self.trials.into_iter().map(move |(trial, tally)| tally.row(trial, has_weight))
    }
}

/// The side of a texel, metres: as large as the plan's cells, or larger where there would be more of them. Each patch has one
/// at least, however small it is.
fn texel(site: &Site) -> f64 {
    let receiving = site.mesh.components.iter().zip(&site.receives).filter(|(_, receives)| **receives);
    let faces = receiving.flat_map(|(component, _)| component.faces.clone());
    let area = |face: u32| {
        let [a, b, c] = site.mesh.corners(face as usize).map(|corner| corner.as_dvec3());
        (b - a).cross(c - a).length() / 2.0
    };
    site.grid.cell.max((faces.map(area).sum::<f64>() / site.grid.cells() as f64).sqrt())
}

/// Draws a sun by itself, from sums: an adapter tells nothing else.
fn sampled(mut texture: SoftTexture) -> impl FnMut(DVec3) -> Result<Vec<u8>, ShadowError> {
    let mut before = None;
    move |to_sun| {
        texture.add(&[Sample { light: to_sun.extend(0.0), weight: 1 }])?;
        let sums = texture.so_far()?;
        let seen = match &before {
            None => sums.iter().map(|sum| *sum as u8).collect(),
            Some(before) => sums.iter().zip(before).map(|(sum, before): (&u32, &u32)| (sum - before) as u8).collect(),
        };
        before = Some(sums);
        Ok(seen)
    }
}

impl TexelTally {
    fn row(self, trial: SurfaceTrial, has_weight: bool) -> Row {
        let instants = self.secs.len().max(1) as f64;
        let texels = self.secs_off.len().max(1) as f64;
        let off = || self.secs_off.iter().map(|secs| secs.unsigned_abs() as f64 / 3600.0);
        let hours = HoursDifference { largest: off().fold(0.0, f64::max), mean: off().sum::<f64>() / texels };
        let differing = (self.difference.differ() + self.thin) as f64;
        let typical = if self.secs.len() > 1 { &self.secs[1..] } else { &self.secs };
        Row {
            drawn: trial.drawn,
            against: Truth::Centre,
            promise: trial.promise,
            on_surfaces: true,
            thin: self.thin,
            missed: None,
            furthest: self.furthest,
            share_off: differing / (texels * instants),
            hours_off: has_weight.then_some(hours),
            secs: typical.iter().sum::<f64>() / typical.len().max(1) as f64,
            difference: self.difference,
        }
    }
}

/// The texels of a patch, and which of them see the sun in the truth: 1.
struct PatchTexels<'a> {
    patch: &'a Patch,
    texels: &'a [Texel],
    seen: &'a [u8],
}

/// How a patch differs from the truth at one instant.
struct PatchDifference {
    difference: Difference,
    thin: u64,
    furthest: Option<f64>,
}

impl PatchTexels<'_> {
    /// Compares what was drawn; `is_uniform` says of a texel away from edges whether no shadow or light thinner than a texel
    /// lies there.
    fn compare(&self, drawn: &[u8], is_uniform: impl Fn(Texel) -> bool) -> PatchDifference {
        let differing: Vec<usize> = (0..drawn.len()).filter(|at| drawn[*at] != self.seen[*at]).collect();
        let is_even = self.seen.iter().all(|seen| *seen == self.seen[0]);
        let [lit, dark] = if is_even { [None, None] } else { [Some(self.mask(1)), Some(self.mask(0))] };
        let is_edge = |at: usize| {
            let Texel { column, row } = self.texels[at];
            let mask = if self.seen[at] == 1 { &lit } else { &dark };
            mask.as_ref().is_some_and(|mask| crate::verification::is_edge_cell(mask, column.into(), row.into()))
        };
        let mut found = PatchDifference { difference: Difference::default(), thin: 0, furthest: None };
        let edge_cells = (0..drawn.len()).filter(|at| is_edge(*at)).count() as u64;
        found.difference.edge_cells = edge_cells;
        found.difference.other_cells = drawn.len() as u64 - edge_cells;
        let edges = [&dark, &lit].map(|mask| mask.as_ref().filter(|_| !differing.is_empty()).map(Edges::of));
        for at in differing {
            if is_edge(at) {
                found.difference.edge_differ += 1;
            } else if is_uniform(self.texels[at]) {
                found.difference.other_differ += 1;
            } else {
                found.thin += 1;
                continue;
            }
            let Texel { column, row } = self.texels[at];
            let away = edges[usize::from(self.seen[at])].as_ref();
            let away = away.and_then(|edges| edges.distance(column.into(), row.into()));
            found.furthest = away.into_iter().chain(found.furthest).max_by(f64::total_cmp);
        }
        found
    }

    /// The truth as a mask of the patch's raster, in which the rest of the raster is all lit (1) or all dark (0): no edge of
    /// the texels that are so.
    fn mask(&self, rest: u8) -> Mask {
        let (width, height) = (self.patch.width, self.patch.height);
        let mut mask = Mask { width, height, share: vec![255 * rest; width as usize * height as usize] };
        for (Texel { column, row }, seen) in self.texels.iter().zip(self.seen) {
            mask.share[usize::from(*row) * width as usize + usize::from(*column)] = 255 * seen;
        }
        mask
    }
}
